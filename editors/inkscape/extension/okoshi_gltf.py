"""Inkscape's *Save As*: glTF."""

from okoshi_export import Export

if __name__ == "__main__":
    Export("gltf").run()
