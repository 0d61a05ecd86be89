"""Renders a glTF file to a PNG: three-quarter view, soft light, transparent background, framed by itself.

    blender -b --factory-startup --python-exit-code 1 --python picture.py -- MODEL.glb OUT.png
        [--size 800x800] [--view YAW,PITCH] [--samples 64]

YAW turns the camera to the model's left, PITCH lifts it, both in degrees (30,15). Cycles on the processor: the other
engines of Blender need a display.
"""

import argparse
import math
import sys

import bpy
import numpy
from mathutils import Euler, Vector

# Blender 3.4 reads glTF by a name that NumPy has given up since.
if "bool" not in vars(numpy):
    numpy.bool = bool


def options():
    """The command line behind `--`."""
    parser = argparse.ArgumentParser(prog="picture.py")
    parser.add_argument("model")
    parser.add_argument("out")
    parser.add_argument("--size", default="800x800")
    parser.add_argument("--view", default="30,15")
    parser.add_argument("--samples", type=int, default=64)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])


def corners():
    """Every corner of every solid, in the world."""
    return [
        thing.matrix_world @ corner.co
        for thing in bpy.data.objects
        if thing.type == "MESH"
        for corner in thing.data.vertices
    ]


def light(direction, strength, softness):
    """A sun that shines along `direction`; its apparent size in degrees makes soft shadows."""
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy = strength
    sun.angle = math.radians(softness)
    thing = bpy.data.objects.new("sun", sun)
    thing.rotation_euler = Vector(direction).to_track_quat("-Z", "Y").to_euler()
    bpy.context.collection.objects.link(thing)


def ambient(strength):
    """Light from everywhere."""
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = strength
    bpy.context.scene.world = world


def frame(points, yaw, pitch):
    """A camera that sees all points, with a little room around them."""
    camera = bpy.data.cameras.new("camera")
    camera.lens = 85
    thing = bpy.data.objects.new("camera", camera)
    # The importer turns glTF's +Y up into Blender's +Z up: the front then looks along -Y.
    thing.rotation_euler = Euler((math.radians(90 - pitch), 0, math.radians(yaw)))
    bpy.context.collection.objects.link(thing)
    bpy.context.scene.camera = thing
    bpy.context.view_layer.update()

    low = Vector(map(min, zip(*points)))
    high = Vector(map(max, zip(*points)))
    middle = (low + high) / 2
    roomy = [value for point in points for value in middle + (point - middle) * 1.08]
    thing.location, _ = thing.camera_fit_coords(bpy.context.evaluated_depsgraph_get(), roomy)
    radius = (high - low).length / 2
    far = (thing.location - middle).length
    camera.clip_start = max(far - 2 * radius, far / 1000)
    camera.clip_end = far + 2 * radius


def main():
    """Imports, lights, frames, renders."""
    given = options()
    width, height = map(int, given.size.split("x"))
    yaw, pitch = map(float, given.view.split(","))

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=given.model)
    bpy.context.view_layer.update()
    points = corners()
    if not points:
        sys.exit(f"{given.model} has nothing to show")

    turn = Euler((0, 0, math.radians(yaw))).to_matrix()
    light(turn @ Vector((0.6, 1.0, -1.2)), 2.6, 12)
    light(turn @ Vector((-1.0, 0.8, -0.3)), 0.7, 40)
    ambient(0.55)
    frame(points, yaw, pitch)

    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = given.samples
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 4
    # Colours as they are in the drawing, not as a film would show them.
    scene.view_settings.view_transform = "Standard"
    scene.render.film_transparent = True
    scene.render.resolution_x = width
    scene.render.resolution_y = height
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGBA"
    scene.render.filepath = given.out
    bpy.ops.render.render(write_still=True)


main()
