"""Inkscape's *Extensions → Okoshi → Take In Changes*."""

from okoshi_changing import TakeIn

if __name__ == "__main__":
    TakeIn().run()
