"""Puts a page and pictures of its model side by side: page_and_model.py PAGE.png MODEL.png … OUT.png

The page has a thin frame and the height of the whole; models are cropped to what they show, all at one scale. A picture of a model can
be a film strip, whose moments move together.
"""

import sys

from palette import reduced
from PIL import Image, ImageChops, ImageOps

HEIGHT = 320
# No wider than a page of text.
WIDTH = 840
GAP = 14
FRAME = "#c4ccd6"
COLOURS = 80


def white(path):
    picture = Image.open(path).convert("RGBA")
    return Image.alpha_composite(Image.new("RGBA", picture.size, "white"), picture).convert("RGB")


def shown(picture):
    """What differs from white by more than the rim of a shadow, as a mask."""
    difference = ImageChops.difference(picture, Image.new("RGB", picture.size, "white")).convert("L")
    return difference.point(lambda value: 255 if value > 10 else 0)


def things(picture):
    """The picture cut at its empty columns, and cropped to what all pieces show above and below."""
    mask = shown(picture)
    _, top, _, bottom = mask.getbbox()
    is_empty = [low == high == 0 for low, high in (mask.crop((x, 0, x + 1, mask.height)).getextrema() for x in range(mask.width))]
    pieces, first = [], None
    for x, empty in enumerate([*is_empty, True]):
        if not empty and first is None:
            first = x
        if empty and first is not None:
            pieces.append(picture.crop((first, top, x, bottom)))
            first = None
    return pieces


def scaled(picture, factor):
    return picture.resize([max(1, round(side * factor)) for side in picture.size], Image.LANCZOS)


*paths, out = sys.argv[1:]
page, *models = [white(path) for path in paths]
# Outside of the frame is a rim of the background, of which the palette keeps the colour.
page = ImageOps.expand(ImageOps.expand(scaled(page, (HEIGHT - 4) / page.height), 1, FRAME), 1, "white")
models = [piece for model in models for piece in things(model)]
room = WIDTH - page.width - GAP * len(models)
factor = min((HEIGHT - 2 * GAP) / max(model.height for model in models), room / sum(model.width for model in models))
models = [scaled(model, factor) for model in models]
width = page.width + sum(GAP + model.width for model in models)
both = Image.new("RGB", (width, HEIGHT), "white")
both.paste(page, (0, 0))
left = page.width + GAP
for model in models:
    # All stand on one line, in the middle if they are low.
    both.paste(model, (left, (HEIGHT + max(model.height for model in models)) // 2 - model.height))
    left += model.width + GAP
few = reduced(both, COLOURS)
# Dots look good on what is round, and dirty on the page's even colours.
few.paste(few.getpixel((0, 0)), (0, 0, *page.size))
few.paste(page.quantize(palette=few, dither=Image.Dither.NONE), (0, 0), shown(page))
few.save(out, optimize=True)
