"""Inkscape's *Extensions → Okoshi → Suggest Strings*."""

from okoshi_changing import Suggest

if __name__ == "__main__":
    Suggest().run()
