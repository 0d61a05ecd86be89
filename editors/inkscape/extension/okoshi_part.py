"""Inkscape's *Extensions → Okoshi → Part…*."""

from okoshi_parts import Part

if __name__ == "__main__":
    Part().run()
