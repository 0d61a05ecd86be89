"""Inkscape's *Extensions → Okoshi → Preview in 3D*."""

from okoshi_effects import Preview

if __name__ == "__main__":
    Preview().run()
