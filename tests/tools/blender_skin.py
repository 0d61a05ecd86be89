"""Checks in Blender that skinned models have the same shape and movement as those without a skin.

    blender -b --factory-startup --python-exit-code 1 --python blender_skin.py -- PLAIN.glb SKINNED.glb [PLAIN.glb SKINNED.glb...]

Imports each pair, compares all corners at rest and after the part with the largest mesh of those with a parent was turned by 40 degrees
about its joint, and with it the last bone inside a part that bends, if there is one. Ends with 1 if a corner is off by more than a
thousandth of the model's size.
"""

import math
import re
import sys

import bpy
import numpy
from mathutils import Matrix, Vector
from mathutils.kdtree import KDTree

# Blender 3.4's glTF importer uses a name that newer versions of NumPy have removed.
if "bool" not in vars(numpy):
    numpy.bool = bool


# A bone inside a part is named like the part, with its number.
INNER = re.compile(r".+\.\d+")


def corners():
    """All vertices in world space, with modifiers and poses applied."""
    graph = bpy.context.evaluated_depsgraph_get()
    solids = [thing.evaluated_get(graph) for thing in bpy.data.objects if thing.type == "MESH"]
    # The importer adds a small sphere as the display shape of bones; it is in no scene.
    shown = {thing.name for thing in bpy.context.scene.objects}
    solids = [thing for thing in solids if thing.name in shown]
    return [thing.matrix_world @ corner.co for thing in solids for corner in thing.data.vertices]


def turned(name):
    """Rotates a node (object or bone) around its origin and an oblique axis."""
    spin = Matrix.Rotation(math.radians(40), 4, Vector((1, 2, 3)).normalized())

    def about(matrix):
        origin = matrix.to_translation()
        return Matrix.Translation(origin) @ spin @ Matrix.Translation(-origin) @ matrix

    for rig in (thing for thing in bpy.data.objects if thing.type == "ARMATURE"):
        if name in rig.pose.bones:
            bone = rig.pose.bones[name]
            bone.matrix = rig.matrix_world.inverted() @ about(rig.matrix_world @ bone.matrix)
            break
    else:
        thing = bpy.data.objects[name]
        thing.matrix_world = about(thing.matrix_world)
    bpy.context.view_layer.update()


def load(file):
    """Imports a file into an empty scene."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    bpy.context.view_layer.update()


def distance(some, others):
    """The one-sided Hausdorff distance from `some` to `others`."""
    tree = KDTree(len(others))
    for index, corner in enumerate(others):
        tree.insert(corner, index)
    tree.balance()
    return max(tree.find(corner)[2] for corner in some)


def is_same(plain, skinned):
    """Compares two files."""
    load(plain)
    jointed = [thing for thing in bpy.data.objects if thing.type == "MESH" and thing.parent]
    # The mesh of a part that bends is beside its nodes.
    name = max(jointed, key=lambda thing: (thing.dimensions.length, thing.name)).name.removesuffix(".mesh")
    bones = [bone.name for thing in bpy.data.objects if thing.type == "ARMATURE" for bone in thing.pose.bones]
    inside = sorted(bone for bone in bones if INNER.fullmatch(bone))
    names = [name, *inside[-1:]]
    states = {}
    for file in (plain, skinned):
        load(file)
        rest = corners()
        for name in names:
            turned(name)
        states[file] = (rest, corners())
    size = max((corner.length for corner in states[plain][0]), default=0)
    bad = False
    for state, one, other in zip(("at rest", f"with {' and '.join(names)} turned"), states[plain], states[skinned]):
        off = max(distance(one, other), distance(other, one)) / size
        bad |= off > 1e-3
        print(f"{state}: {len(one)} and {len(other)} corners, off by {off:.1e} of the size")
    moved = distance(*states[plain]) / size
    print(f"the turn moves corners by up to {moved:.2f} of the size")
    return not bad and moved >= 0.01


def main(files):
    """Compares all pairs; the exit status is 1 if any differs."""
    differ = 0
    for plain, skinned in zip(files[::2], files[1::2]):
        print(f"skin of {plain}")
        differ += not is_same(plain, skinned)
    print(f"{len(files) // 2} models, {differ} differ from their skinned ones")
    sys.exit(1 if differ or not files or len(files) % 2 else 0)


main(sys.argv[sys.argv.index("--") + 1 :])
