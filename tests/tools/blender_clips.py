"""Imports glTF files into Blender and compares the imported clips with those in the files.

    blender -b --factory-startup --python-exit-code 1 --python blender_clips.py -- FILE.glb...

Every channel of every clip must be there: a curve for each component with the same keys, CONSTANT for step interpolation and LINEAR
otherwise. The weights of morph targets are a curve for each shape key. A file without clips must have none in Blender.
"""

import json
import re
import struct
import sys

import bpy
import numpy

# Blender 3.4's glTF importer uses a name that newer versions of NumPy have removed.
if "bool" not in vars(numpy):
    numpy.bool = bool

CURVES = {"rotation": ("rotation_quaternion", 4), "translation": ("location", 3)}
# The weights of morph targets, by the name of the shape key.
WEIGHT = re.compile(r'key_blocks\["(.*)"\]\.value')
# The nodes of a skinned model become bones of one armature.
BONE = re.compile(r'pose\.bones\["(.*)"\]\.(\w+)')
INTERPOLATION = {"STEP": "CONSTANT", "LINEAR": "LINEAR"}


def clips_of_file(file):
    """The clips of a GLB: (clip, node, curve, index) to (keys, interpolation)."""
    with open(file, "rb") as stream:
        _, _, _, length, _ = struct.unpack("<5I", stream.read(20))
        model = json.loads(stream.read(length))
    found = {}
    for clip in model.get("animations", []):
        for channel in clip["channels"]:
            sampler = clip["samplers"][channel["sampler"]]
            target = channel["target"]
            node = model["nodes"][target["node"]]
            keys = model["accessors"][sampler["input"]]["count"]
            way = INTERPOLATION[sampler.get("interpolation", "LINEAR")]
            if target["path"] == "weights":
                for name in model["meshes"][node["mesh"]]["extras"]["targetNames"]:
                    found[clip["name"], node["name"], name, 0] = (keys, way)
                continue
            curve, numbers = CURVES[target["path"]]
            for index in range(numbers):
                found[clip["name"], node["name"], curve, index] = (keys, way)
    return found


def strips(data):
    """Each clip that moves some of Blender's data, with its curves."""
    for track in data.animation_data.nla_tracks if data.animation_data else []:
        for strip in track.strips:
            for curve in strip.action.fcurves:
                ways = sorted({point.interpolation for point in curve.keyframe_points})
                yield track.name, curve, (len(curve.keyframe_points), " ".join(ways))


def clips_of_blender(file):
    """The same after an import into Blender; if the keys of a curve differ in interpolation, all kinds are listed."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    found = {}
    for thing in bpy.data.objects:
        for clip, curve, keys in strips(thing):
            bone = BONE.fullmatch(curve.data_path)
            node, path = bone.groups() if bone else (thing.name, curve.data_path)
            found[clip, node, path, curve.array_index] = keys
        shape_keys = thing.data.shape_keys if thing.type == "MESH" else None
        for clip, curve, keys in strips(shape_keys) if shape_keys else []:
            found[clip, thing.name, WEIGHT.fullmatch(curve.data_path)[1], 0] = keys
    return found


def main(files):
    """Compares all files; the exit status is 1 if any differs."""
    bad = 0
    for file in files:
        due, found = clips_of_file(file), clips_of_blender(file)
        differences = [
            f"{key}: {due.get(key)} in the file, {found.get(key)} in Blender"
            for key in sorted(due.keys() | found.keys())
            if due.get(key) != found.get(key)
        ]
        clips = {key[0]: (keys, way) for key, (keys, way) in sorted(due.items())}
        told = ", ".join(f"{name}: {keys} keys {way}" for name, (keys, way) in clips.items())
        print(f"{'BAD' if differences else 'ok '} {file}: {len(due)} curves; {told or 'no clips'}")
        for difference in differences[:20]:
            print(f"    {difference}")
        bad += bool(differences)
    print(f"{len(files)} models, {bad} differ in their clips")
    sys.exit(1 if bad or not files else 0)


main(sys.argv[sys.argv.index("--") + 1 :])
