"""Inkscape's *Extensions → Okoshi → Stop Previews*."""

from okoshi_effects import Stop

if __name__ == "__main__":
    Stop().run()
