"""Crops a picture to its content and fits it into a white square: thumbnail.py PICTURE.png OUT.png"""

import sys

from PIL import Image, ImageChops

SIZE = 320
BORDER = 8

picture = Image.open(sys.argv[1]).convert("RGBA")
ground = Image.new("RGBA", picture.size, "white")
picture = Image.alpha_composite(ground, picture).convert("RGB")
box = ImageChops.difference(picture, Image.new("RGB", picture.size, "white")).getbbox()
picture = picture.crop(box)
scale = (SIZE - 2 * BORDER) / max(picture.size)
picture = picture.resize([max(1, round(side * scale)) for side in picture.size], Image.LANCZOS)
square = Image.new("RGB", (SIZE, SIZE), "white")
square.paste(picture, ((SIZE - picture.width) // 2, (SIZE - picture.height) // 2))
square.quantize(128).save(sys.argv[2], optimize=True)
