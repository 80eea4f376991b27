"""EXR files as patchlight writes them, to arrays. Blender's own reader keeps the pixels of files with layers to itself."""
import struct
import zlib

import numpy


def read_exr(path):
    """R, G, B of an EXR file as the program writes it: scan lines of float32, ZIP."""
    data = open(path, "rb").read()
    at, attributes = 8, {}

    def word():
        nonlocal at
        end = data.index(0, at)
        text, at = data[at:end].decode(), end + 1
        return text

    while data[at] != 0:
        name = word()
        word()
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    at += 1
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    names, list_at = [], 0
    channels = attributes["channels"]
    while channels[list_at] != 0:
        end = channels.index(0, list_at)
        names.append(channels[list_at:end].decode())
        list_at = end + 17
    picture = numpy.zeros((height, len(names), width), numpy.float32)
    for offset in struct.unpack_from("<%dQ" % ((height + 15) // 16), data, at):
        row, size = struct.unpack_from("<ii", data, offset)
        rows = min(16, height - (row - top))
        block = data[offset + 8:offset + 8 + size]
        if size < rows * width * len(names) * 4:
            # A running sum, and the bytes of odd places behind those of even ones.
            deltas = numpy.frombuffer(zlib.decompress(block), numpy.uint8).astype(numpy.int64)
            deltas[1:] -= 128
            summed = (numpy.cumsum(deltas) & 255).astype(numpy.uint8)
            half = (len(summed) + 1) // 2
            mixed = numpy.empty_like(summed)
            mixed[0::2], mixed[1::2] = summed[:half], summed[half:]
            block = mixed.tobytes()
        picture[row - top:row - top + rows] = numpy.frombuffer(block, numpy.float32).reshape(rows, len(names), width)
    return picture[:, [names.index(k) for k in "RGB"], :].transpose(0, 2, 1).astype(float)
