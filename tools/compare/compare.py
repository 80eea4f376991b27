"""patchlight beside Blender's path tracer on the same scenes: error and time. Run by tools/compare/compare.

Error: mean absolute error over mean, of 2 x 2 pixel means, lamps and a ring of one around them left out; the reference's
own noise, measured from two halves of it, is taken out in quadrature. With --rows the reference is a few rows of such means
alone, of as many more samples: errors of a hundredth need them where light is hard to find.
"""
import argparse
import hashlib
import json
import os
import subprocess
import sys
import time

import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import path_tracer  # noqa: E402
from exr import read_exr  # noqa: E402

# After the first pass light has been scattered once, at the surface that is seen; Cycles counts that as no bounce.
PASSES = {"1": 0, "2": 1, "end": 64}


def read_arguments():
    root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    parser = argparse.ArgumentParser(prog="compare", description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="+", metavar="SCENE")
    parser.add_argument("--build", required=True, help="folder of the built programs")
    parser.add_argument("--size", type=int, default=256, help="pixels each way (256)")
    parser.add_argument("--samples", type=int, default=2048, help="of a reference, a pixel and seed (2048)")
    parser.add_argument("--rows", type=int, default=0, help="rows of a reference; 0: the whole picture (0)")
    parser.add_argument("--beside", type=int, default=16, help="samples of the path tracer to time (16)")
    parser.add_argument("--runs", type=int, default=5, help="timed runs; the median counts (5)")
    parser.add_argument("--passes", default="1,2,end", help="which to compare (1,2,end)")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--pictures", action="store_true", help="also write pictures and differences")
    parser.add_argument("--flags", default="", help="further flags for patchlight, in one word")
    parser.add_argument("-o", default=os.path.join(root, "out", "compare"), help="folder of all files")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


def say(line):
    os.write(3, (line + "\n").encode())


def halve(picture):
    height, width, channels = picture.shape
    return picture.reshape(height // 2, 2, width // 2, 2, channels).mean((1, 3))


def grow(mask):
    """The mask and the ring of one around it."""
    wide = numpy.pad(mask, 1)
    out = numpy.zeros_like(mask)
    for dy in range(3):
        for dx in range(3):
            out |= wide[dy:dy + mask.shape[0], dx:dx + mask.shape[1]]
    return out


class References:
    """Path-traced pictures, kept on disk under the scene's own hash: they take minutes."""

    def __init__(self, export, options):
        self.export, self.options, self.scene = export, options, None
        self.key = hashlib.sha256(json.dumps(export, sort_keys=True).encode()).hexdigest()[:16]

    def blender_scene(self):
        if self.scene is None:
            self.scene = path_tracer.make_scene(self.export, self.options.size, self.options.threads)
        return self.scene

    def cached(self, name, make):
        path = os.path.join(self.options.o, "references", f"{self.key}-{self.options.size}-{name}.npy")
        if os.path.exists(path):
            return numpy.load(path)
        picture = make()
        os.makedirs(os.path.dirname(path), exist_ok=True)
        numpy.save(path, picture)
        return picture

    def lamps(self):
        """Where the picture shows a lamp: nothing else shines where nothing reflects."""
        def make():
            scene = path_tracer.make_scene(self.export, self.options.size, self.options.threads, emits_only=True)
            self.scene = None
            return path_tracer.render(scene, 64, 1, 0)[0]
        return self.cached("lamps", make).max(2) > 0

    def rows(self):
        """Which rows of 2 x 2 means a reference shows: all, or a few, evenly."""
        half, count = self.options.size // 2, self.options.rows
        return [(2 * k + 1) * half // (2 * count) for k in range(count)] if count else list(range(half))

    def pair(self, bounces):
        """Two halves of a reference: 2 x 2 means at rows()."""
        samples = self.options.samples
        if self.options.rows:
            return list(self.cached(f"{bounces}-{samples}-rows-{self.options.rows}", lambda: self.trace_rows(bounces)))
        return [halve(picture) for picture in self.pictures(bounces)]

    def trace_rows(self, bounces):
        scene = path_tracer.make_scene(self.export, self.options.size // 2, self.options.threads)
        self.scene = None  # Blender holds one at a time
        # Sequences of samples are good for some thousands.
        parts = max(self.options.samples // 4096, 1)
        halves = [[[path_tracer.render_row(scene, row, self.options.samples // parts, parts * half + part + 1, bounces)
                    for row in self.rows()] for part in range(parts)] for half in range(2)]
        return numpy.mean(halves, 1)

    def pictures(self, bounces):
        samples = self.options.samples
        return [self.cached(f"{bounces}-{samples}-{seed}",
                            lambda: path_tracer.render(self.blender_scene(), samples, seed, bounces)[0])
                for seed in (1, 2)]

    def timed(self):
        """Seconds of short renders, and the last one's picture."""
        runs = [path_tracer.render(self.blender_scene(), self.options.beside, 3, PASSES["end"])
                for _ in range(self.options.runs)]
        return float(numpy.median([seconds for _, seconds in runs])), runs[-1][0]


def measure(picture, references, lit):
    """(error, noise of the references' mean): shares of the mean over the cells of `lit`; all of 2 x 2 means."""
    a, b = (reference[lit] for reference in references)
    mean = (a + b) / 2
    scale = mean.mean()
    noise = numpy.abs(a - b).mean() / 2 / scale
    raw = numpy.abs(picture[lit] - mean).mean() / scale
    return numpy.sqrt(max(raw * raw - noise * noise, 0)), noise


def run_patchlight(scene, options, flags):
    command = [os.path.join(options.build, "patchlight"), "render", scene, "--quiet", "-o", options.o, "--size",
               f"{options.size}x{options.size}", "--threads", str(options.threads), *flags, *options.flags.split()]
    start = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.perf_counter() - start


def patchlight_pictures(scene, options):
    """The pictures after passes 1, 2 and 16, the program's default, and the report."""
    run_patchlight(scene, options, ["--format", "exr", "--snapshots", "1,2,16"])
    name = os.path.join(options.o, os.path.splitext(os.path.basename(scene))[0])
    pictures = {key: read_exr(f"{name}-pass-{number}.exr")
                for key, number in (("1", "01"), ("2", "02"), ("end", "16"))}
    with open(f"{name}-report.json") as report:
        return pictures, json.load(report)


def encode(linear):
    linear = numpy.clip(linear, 0, 1)
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def save_triptych(path, picture, reference):
    """Ours, the reference, and their difference, ten times enlarged around grey."""
    scale = 0.7 / max(numpy.percentile(reference.max(2), 90), 1e-30)
    mean = reference.mean()
    difference = 0.5 + 5 * (picture - reference) * 0.1 / max(mean, 1e-30)
    path_tracer.save_png(path, numpy.hstack([encode(picture * scale), encode(reference * scale),
                                        numpy.clip(difference, 0, 1)]))


def compare(scene, options):
    """One line of the table."""
    name = os.path.splitext(os.path.basename(scene))[0]
    export = json.loads(subprocess.run([os.path.join(options.build, "export_faces"), scene], check=True,
                                       capture_output=True).stdout)
    references = References(export, options)
    lamps = references.lamps()
    rows = references.rows()
    lit = ~grow(lamps.reshape(lamps.shape[0] // 2, 2, -1, 2).any((1, 3)))[rows]
    pictures, report = patchlight_pictures(scene, options)
    line = f"{name:14}"
    for key in options.passes.split(","):
        pair = references.pair(PASSES[key])
        error, noise = measure(halve(pictures[key])[rows], pair, lit)
        line += f" {100 * error:6.2f} ±{100 * noise:4.2f}"
        if options.pictures and not options.rows:
            save_triptych(os.path.join(options.o, f"{name}-{key}.png"), pictures[key],
                          sum(references.pictures(PASSES[key])) / 2)
    if options.runs > 0:
        seconds, picture = references.timed()
        error, _ = measure(halve(picture)[rows], references.pair(PASSES["end"]), lit)
        # The whole program, from the scene file to one PNG file.
        ours = float(numpy.median([run_patchlight(scene, options, ["--format", "png", "--snapshots", "16"])
                                   for _ in range(options.runs)]))
        line += f" {ours:8.2f} {seconds:8.2f} {100 * error:7.1f} {ours / seconds:6.2f}"
    say(line + f" {report['patches']:8d} {100 * report['error']['estimate']:6.2f}")


def main():
    options = read_arguments()
    os.makedirs(options.o, exist_ok=True)
    keys = options.passes.split(",")
    header = f"{'error in % of':14}" + "".join(f" {'pass ' + key:>12}" for key in keys)
    if options.runs > 0:
        header += f" {'ours s':>8} {f'Cycles s':>8} {'its err':>7} {'ratio':>6}"
    say(header + f" {'leaves':>8} {'told':>6}")
    for scene in options.scenes:
        compare(scene, options)


main()
