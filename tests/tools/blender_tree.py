"""Imports glTF files into Blender and prints the result: one JSON object per file.

    blender -b --factory-startup --python-exit-code 1 --python blender_tree.py -- [-o OUT.json] FILE.glb...

[{"file": ..., "nodes": [{"name", "parent", "bone_of", "mesh", "triangles"}]}]; a node without parent has null there, and one that is no
bone inside a part has null as the part that it is a bone of.
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



def extras(thing):
    """What okoshi says of a node."""
    return thing["okoshi"].to_dict() if "okoshi" in thing else {}


def bones(thing):
    """The nodes that the importer has made bones of an armature."""
    for bone in thing.pose.bones if thing.type == "ARMATURE" else []:
        parent = (bone.parent or thing).name
        bone_of = extras(bone).get("bone_of")
        yield {"name": bone.name, "parent": parent, "bone_of": bone_of, "mesh": False, "triangles": 0}


def nodes(things):
    """The nodes of a model by name; triangles are counted after triangulation."""
    found = {bone["name"]: bone for thing in things for bone in bones(thing)}
    for thing in things:
        solid = thing.type == "MESH"
        if solid:
            thing.data.calc_loop_triangles()
        # The mesh of a part that bends is beside its nodes.
        name = extras(thing).get("mesh_of", thing.name)
        if name in found:
            # A bone has no mesh of its own.
            if not solid or found[name]["mesh"]:
                raise ValueError(f"there are two nodes named {name}")
            node = found[name]
        else:
            above = thing.parent and (thing.parent_bone or thing.parent.name)
            node = found[name] = {"name": name, "parent": above, "bone_of": None}
        node["mesh"] = solid
        node["triangles"] = len(thing.data.loop_triangles) if solid else 0
    return [found[name] for name in sorted(found)]


def tree(file):
    """Imports `file`; returns the objects by name."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    things = [thing for thing in bpy.data.objects if thing.type != "CAMERA"]
    return {"file": file, "nodes": nodes(things)}


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
