"""Combines a drawing and a picture of its model side by side: side_by_side.py DRAWING.png MODEL.png OUT.png"""

import sys

from palette import reduced
from PIL import Image, ImageChops

HEIGHT = 420
GAP = 30


def trimmed(path):
    """The picture on white, cropped to its content and scaled to HEIGHT."""
    picture = Image.open(path).convert("RGBA")
    ground = Image.new("RGBA", picture.size, "white")
    picture = Image.alpha_composite(ground, picture).convert("RGB")
    box = ImageChops.difference(picture, Image.new("RGB", picture.size, "white")).getbbox()
    picture = picture.crop(box)
    width = round(picture.width * HEIGHT / picture.height)
    return picture.resize((width, HEIGHT), Image.LANCZOS)


drawing, model = trimmed(sys.argv[1]), trimmed(sys.argv[2])
both = Image.new("RGB", (drawing.width + GAP + model.width, HEIGHT + 2 * GAP), "white")
both.paste(drawing, (0, GAP))
both.paste(model, (drawing.width + GAP, GAP))
reduced(both).save(sys.argv[3], optimize=True)
