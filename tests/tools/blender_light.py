"""Light on landscapes in Cycles: no lit top is black or striped.

    blender -b --factory-startup --python-exit-code 1 --python tests/tools/blender_light.py -- MODEL.glb…

Each model is rendered from straight above with one slanted sun and no other light, at one ray a pixel. Where the geometry says that a
top faces up and that nothing is between it and the sun, its brightness is compared with that of a box of the same material: the mean of
each material must be within a tenth of the box, and hardly a pixel may be darker than half of it. Materials with textures are left out.
"""

import math
import sys
import tempfile
from pathlib import Path

import bpy
import numpy
from mathutils import Vector

# Blender 3.4's glTF importer uses a name that newer versions of NumPy have removed.
if "bool" not in vars(numpy):
    numpy.bool = bool

SIDE = 240
NEAR = 0.1
DARK = 0.5
MOST_DARK = 0.005
FEWEST = 60
# Towards the sun: from the right, the front and above.
SUN = Vector((0.35, -0.45, 1.0)).normalized()


def plain_materials():
    """The materials without textures, each with its name."""
    for material in bpy.data.materials:
        nodes = material.node_tree.nodes if material.use_nodes else []
        if not any(node.type == "TEX_IMAGE" for node in nodes):
            yield material


def bounds():
    corners = [
        thing.matrix_world @ Vector(corner)
        for thing in bpy.context.scene.objects
        if thing.type == "MESH"
        for corner in thing.bound_box
    ]
    axes = list(zip(*corners))
    return Vector(map(min, axes)), Vector(map(max, axes))


def add_boxes(low, high):
    """A row of boxes beside the model, one of each material."""
    size = max(high.x - low.x, high.y - low.y) / 12
    for index, material in enumerate(list(plain_materials())):
        at = (high.x + size * 2, low.y + size * (0.5 + 1.6 * index), low.z + size / 2)
        bpy.ops.mesh.primitive_cube_add(size=size, location=at)
        box = bpy.context.object
        box.name = f"box {index}"
        box.data.materials.append(material)


def render(camera):
    """Per row and column the brightness of each pixel, linear."""
    scene = bpy.context.scene
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = 4
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 0
    scene.render.resolution_x = scene.render.resolution_y = SIDE
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "light.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        pixels = list(image.pixels)
        bpy.data.images.remove(image)
    return [sum(pixels[at : at + 3]) / 3 for at in range(0, len(pixels), 4)]


def lit_tops(camera, width):
    """The pixels that show a top that the sun reaches: per pixel its material and whether it is of a box."""
    scene = bpy.context.scene
    graph = bpy.context.evaluated_depsgraph_get()
    found = {}
    step = width / SIDE
    for row in range(SIDE):
        for column in range(SIDE):
            x = camera.location.x + (column + 0.5 - SIDE / 2) * step
            y = camera.location.y + (row + 0.5 - SIDE / 2) * step
            # The whole pixel has to show the same top.
            hits = [
                scene.ray_cast(graph, Vector((x + a * step, y + b * step, camera.location.z)), Vector((0, 0, -1)))
                for a, b in ((-0.7, -0.7), (0.7, -0.7), (0, 0), (-0.7, 0.7), (0.7, 0.7))
            ]
            is_hit = all(hit[0] and hit[2].z > 0.999 for hit in hits)
            if not is_hit or max(h[1].z for h in hits) - min(h[1].z for h in hits) > 1e-4:
                continue
            shaded = any(scene.ray_cast(graph, hit[1] + SUN * width * 1e-4, SUN)[0] for hit in hits)
            faces = {(hit[4].name, hit[4].data.polygons[hit[3]].material_index) for hit in hits}
            if shaded or len(faces) != 1:
                continue
            (_, _, _, face, thing, _) = hits[2]
            slot = thing.material_slots[thing.data.polygons[face].material_index]
            found[row * SIDE + column] = (slot.material.name, thing.name.startswith("box "))
    return found


def check(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path)
    low, high = bounds()
    names = {material.name for material in plain_materials()}
    add_boxes(low, high)
    low, high = bounds()
    width = 1.05 * max(high.x - low.x, high.y - low.y)
    lens = bpy.data.cameras.new("above")
    lens.type, lens.ortho_scale, lens.clip_end = "ORTHO", width, 1e4
    camera = bpy.data.objects.new("above", lens)
    camera.location = ((low.x + high.x) / 2, (low.y + high.y) / 2, high.z + width)
    light = bpy.data.lights.new("sun", "SUN")
    light.energy, light.angle = 3.0, 0.0
    sun = bpy.data.objects.new("sun", light)
    sun.rotation_euler = SUN.to_track_quat("Z", "Y").to_euler()
    for thing in (camera, sun):
        bpy.context.scene.collection.objects.link(thing)
    bpy.context.view_layer.update()
    brightness = render(camera)
    of_boxes, of_tops = {}, {}
    for pixel, (name, is_box) in lit_tops(camera, width).items():
        (of_boxes if is_box else of_tops).setdefault(name, []).append(brightness[pixel])
    problems, counted = [], 0
    for name, tops in sorted(of_tops.items()):
        if name not in names or len(tops) < FEWEST or not of_boxes.get(name):
            continue
        box = sum(of_boxes[name]) / len(of_boxes[name])
        mean = sum(tops) / len(tops)
        dark = sum(value < DARK * box for value in tops) / len(tops)
        counted += len(tops)
        print(f"{Path(path).stem}: {name}: {len(tops)} pixels, {mean / box:.3f} of a box, {dark:.4f} dark")
        if not math.isclose(mean, box, rel_tol=NEAR) or dark > MOST_DARK or box <= 0:
            problems.append(f"{path}: lit tops of {name} have {mean / box:.2f} of a box's brightness, {dark:.1%} of them are dark")
    return problems, counted


problems, counted = [], 0
for path in sys.argv[sys.argv.index("--") + 1 :]:
    found, tops = check(path)
    problems += found
    counted += tops
if counted == 0:
    problems.append("no lit top without a texture was found")
if problems:
    sys.exit("\n".join(problems))
