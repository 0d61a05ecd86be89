"""Inkscape's *Extensions → Okoshi → Manual of Strings*."""

from okoshi_effects import Explain

if __name__ == "__main__":
    Explain().run()
