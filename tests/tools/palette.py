"""Pictures with few colours, which are small as PNG."""

from PIL import Image


def reduced(picture, colours=256):
    """The picture with so many colours, mixed by dots where there were more: rounded surfaces have no bands."""
    palette = picture.quantize(colours, kmeans=2)
    few = picture.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG)
    # The background keeps its colour exactly; Pillow takes one that is near.
    found = few.getpalette()
    background = 3 * few.getpixel((0, 0))
    found[background : background + 3] = picture.getpixel((0, 0))
    few.putpalette(found)
    return few
