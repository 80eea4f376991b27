"""The door to Blender: a scene's faces as a Cycles scene, and linear pictures of it.

Pictures are float32 arrays (height, width, 3) of radiosity in W/m2, first row at the top: Cycles' radiance times pi.
"""
import math
import os
import tempfile
import time

import bpy
import mathutils
import numpy


def load_picture(path):
    """An EXR file as an array; first row at the top."""
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = numpy.empty(width * height * 4, numpy.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[::-1, :, :3].copy()


def save_png(path, picture):
    """An array of 0..1, already encoded, as a PNG file."""
    height, width, _ = picture.shape
    image = bpy.data.images.new("picture", width, height, float_buffer=False)
    image.colorspace_settings.name = "Non-Color"
    pixels = numpy.ones((height, width, 4), numpy.float32)
    pixels[..., :3] = numpy.clip(picture[::-1], 0, 1)
    image.pixels.foreach_set(pixels.ravel())
    image.filepath_raw = path
    image.file_format = "PNG"
    image.save()
    bpy.data.images.remove(image)


def make_material(emission, reflectance, two_sided, emits_only):
    """Diffuse and emission on the side from which corners run counter-clockwise. The back is black, and clear for the
    camera: patchlight shows no backs, and rooms are often seen from outside."""
    material = bpy.data.materials.new("material")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*((0, 0, 0) if emits_only else reflectance), 1)
    front = diffuse.outputs[0]
    strength = max(emission)
    if strength > 0:
        emit = nodes.new("ShaderNodeEmission")
        emit.inputs["Color"].default_value = (*(e / strength for e in emission), 1)
        emit.inputs["Strength"].default_value = strength / math.pi
        both = nodes.new("ShaderNodeAddShader")
        links.new(front, both.inputs[0])
        links.new(emit.outputs[0], both.inputs[1])
        front = both.outputs[0]
    if two_sided:
        links.new(front, output.inputs["Surface"])
        return material
    path = nodes.new("ShaderNodeLightPath")
    black = nodes.new("ShaderNodeBsdfDiffuse")
    black.inputs["Color"].default_value = (0, 0, 0, 1)
    clear = nodes.new("ShaderNodeBsdfTransparent")
    back = nodes.new("ShaderNodeMixShader")
    links.new(path.outputs["Is Camera Ray"], back.inputs[0])
    links.new(black.outputs[0], back.inputs[1])
    links.new(clear.outputs[0], back.inputs[2])
    side = nodes.new("ShaderNodeMixShader")
    geometry = nodes.new("ShaderNodeNewGeometry")
    links.new(geometry.outputs["Backfacing"], side.inputs[0])
    links.new(front, side.inputs[1])
    links.new(back.outputs[0], side.inputs[2])
    links.new(side.outputs[0], output.inputs["Surface"])
    return material


def make_scene(export, size, threads, emits_only=False):
    """Replaces what Blender holds by the exported faces and camera. emits_only: no surface reflects."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    rows = {}
    for face in export["faces"]:
        key = (tuple(face["emission"]), tuple(face["reflectance"]), face["two_sided"])
        rows.setdefault(key, []).append(face["corners"])
    for (emission, reflectance, two_sided), faces in rows.items():
        points, indices = [], []
        for corners in faces:
            indices.append(range(len(points), len(points) + len(corners)))
            points += corners
        mesh = bpy.data.meshes.new("faces")
        mesh.from_pydata(points, [], [list(face) for face in indices])
        mesh.materials.append(make_material(emission, reflectance, two_sided, emits_only))
        scene.collection.objects.link(bpy.data.objects.new("faces", mesh))
    add_camera(scene, export["camera"])
    world = bpy.data.worlds.new("black")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 0, 1)
    scene.world = world
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.threads_mode = "FIXED"
    scene.render.threads = threads
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.color_mode = "RGB"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    cycles.blur_glossy = 0
    # A box, one pixel wide: the mean over the pixel, as patchlight's.
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1
    return scene


def add_camera(scene, view):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = math.radians(view["fov"])
    camera.clip_start, camera.clip_end = 1e-4, 1e4
    eye, target, up = (mathutils.Vector(view[key]) for key in ("eye", "target", "up"))
    back = (eye - target).normalized()
    right = up.cross(back).normalized()
    pose = mathutils.Matrix((right, back.cross(right), back)).transposed().to_4x4()
    pose.translation = eye
    holder = bpy.data.objects.new("camera", camera)
    holder.matrix_world = pose
    scene.collection.objects.link(holder)
    scene.camera = holder


def render_row(scene, row, samples, seed, bounces):
    """One row of the picture, 0 at the top: an array (width, 3)."""
    size = scene.render.resolution_y
    scene.cycles.use_auto_tile = False
    scene.render.use_border = scene.render.use_crop_to_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0, 1
    scene.render.border_min_y, scene.render.border_max_y = (size - row - 1) / size, (size - row) / size
    return render(scene, samples, seed, bounces)[0][0]


def render(scene, samples, seed, bounces):
    """The picture, and the seconds of the render alone: Blender's own start does not count."""
    cycles = scene.cycles
    cycles.samples, cycles.seed = samples, seed
    cycles.max_bounces = cycles.diffuse_bounces = bounces
    cycles.glossy_bounces = cycles.transmission_bounces = cycles.volume_bounces = 0
    cycles.transparent_max_bounces = 1024
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = os.path.join(folder, "picture.exr")
        start = time.perf_counter()
        bpy.ops.render.render(write_still=True)
        seconds = time.perf_counter() - start
        return load_picture(scene.render.filepath) * math.pi, seconds
