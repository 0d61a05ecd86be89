"""Inkscape's *Extensions → Okoshi → Check Strings*."""

from okoshi_effects import Check

if __name__ == "__main__":
    Check().run()
