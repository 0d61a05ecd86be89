"""Puts pictures with their names side by side, four in a row: contact_sheet.py OUT.png NAME PICTURE.png …"""

import sys

from palette import reduced
from PIL import Image, ImageChops, ImageDraw, ImageFont

CELL = 230
BORDER = 8
LINE = 24
COLUMNS = 4

font = ImageFont.load_default(15)
names = sys.argv[2::2]
rows = -(-len(names) // COLUMNS)
sheet = Image.new("RGB", (COLUMNS * CELL, rows * (CELL + LINE)), "white")
draw = ImageDraw.Draw(sheet)
for at, (name, path) in enumerate(zip(names, sys.argv[3::2])):
    picture = Image.open(path).convert("RGB")
    box = ImageChops.difference(picture, Image.new("RGB", picture.size, "white")).getbbox()
    picture = picture.crop(box)
    scale = (CELL - 2 * BORDER) / max(picture.size)
    picture = picture.resize([max(1, round(side * scale)) for side in picture.size], Image.LANCZOS)
    x, y = at % COLUMNS * CELL, at // COLUMNS * (CELL + LINE)
    # All stand on one line.
    sheet.paste(picture, (x + (CELL - picture.width) // 2, y + CELL - BORDER - picture.height))
    draw.text((x + CELL // 2, y + CELL + LINE // 2 - 2), name, fill="#404040", font=font, anchor="mm")
reduced(sheet).save(sys.argv[1], optimize=True)
