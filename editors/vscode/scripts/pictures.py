"""Makes the extension's icon and the walkthrough's pictures: python3 scripts/pictures.py OKOSHI

Takes a built okoshi, Inkscape and Pillow. The picture of problems comes from workbench/run.mjs.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image, ImageDraw

here = Path(__file__).resolve().parent.parent
okoshi = str(Path(sys.argv[1]).resolve())


def icon(model: Image.Image, side: int = 256) -> Image.Image:
    """The model without its shadow on a paper-coloured square with round corners; drawn larger, then shrunk."""
    large = side * 4
    paper = Image.new("RGBA", (large, large))
    ImageDraw.Draw(paper).rounded_rectangle((0, 0, large - 1, large - 1), large // 6, "#f4ead6")
    model.putalpha(model.getchannel("A").point(lambda alpha: 255 if alpha > 200 else 0))
    model = model.crop(model.getbbox())
    height = large * 88 // 100
    model = model.resize((model.width * height // model.height, height), Image.LANCZOS)
    paper.alpha_composite(model, ((large - model.width) // 2, (large - height) // 2 + large // 60))
    return paper.resize((side, side), Image.LANCZOS)


def small(picture: Image.Image, height: int = 560) -> Image.Image:
    """On white, of one height, with few colours: the walkthrough needs no more."""
    white = Image.new("RGBA", picture.size, "white")
    white.alpha_composite(picture)
    width = picture.width * height // picture.height
    return white.convert("RGB").resize((width, height), Image.LANCZOS).quantize(128)


with tempfile.TemporaryDirectory() as room_name:
    room = Path(room_name)
    subprocess.run([okoshi, "render", "-q", here / "../../examples/robot-ja.svg", "-o", room / "robot.png", "--size", "1200x1200"], check=True)
    icon(Image.open(room / "robot.png").convert("RGBA")).save(here / "icon.png", optimize=True)
    subprocess.run([okoshi, "new", "-q", "robot", "--template", "girl"], cwd=room, check=True)
    subprocess.run([okoshi, "render", "-q", "robot.svg", "-o", "model.png", "--size", "800x800"], cwd=room, check=True)
    subprocess.run(
        ["inkscape", "robot.svg", "--export-type=png", "--export-height=1000", "--export-background=white", "--export-filename=drawing.png"],
        cwd=room, check=True, stderr=subprocess.DEVNULL,
    )
    for name in ("model", "drawing"):
        small(Image.open(room / f"{name}.png").convert("RGBA")).save(here / "walkthrough" / f"{name}.png", optimize=True)
