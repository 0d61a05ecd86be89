"""Inkscape's *Save As*: glTF binary."""

from okoshi_export import Export

if __name__ == "__main__":
    Export("glb").run()
