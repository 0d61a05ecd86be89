"""Imports glTF files into Blender and prints the result: one JSON object per file.

    blender -b --factory-startup --python-exit-code 1 --python blender_tree.py -- [-o OUT.json] FILE.glb...

[{"file": ..., "nodes": [{"name", "parent", "mesh", "triangles"}]}]; a node without parent has null there.
Cameras are left out.
Blender talks on stdout too, so -o is for programs.
"""

import json
import sys

import bpy
import numpy

# Blender 3.4's glTF importer uses a name that newer versions of NumPy have removed.
if "bool" not in vars(numpy):
    numpy.bool = bool


def node(thing):
    """One object of the tree; triangles are counted after triangulation."""
    solid = thing.type == "MESH"
    if solid:
        thing.data.calc_loop_triangles()
    return {
        "name": thing.name,
        "parent": thing.parent.name if thing.parent else None,
        "mesh": solid,
        "triangles": len(thing.data.loop_triangles) if solid else 0,
    }


def tree(file):
    """Imports `file`; returns the objects by name."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    things = [thing for thing in bpy.data.objects if thing.type != "CAMERA"]
    nodes = sorted(map(node, things), key=lambda one: one["name"])
    return {"file": file, "nodes": nodes}


def main(arguments):
    """Reads the command line after `--`."""
    out = None
    if arguments[:1] == ["-o"]:
        out, arguments = arguments[1], arguments[2:]
    text = json.dumps([tree(file) for file in arguments], ensure_ascii=False, indent=1)
    if out is None:
        print(text)
    else:
        with open(out, "w", encoding="utf-8") as stream:
            stream.write(text)


main(sys.argv[sys.argv.index("--") + 1 :])
