#!/usr/bin/env python3
"""Makes docs/girl.webp, the first picture of the README: a drawing stands up, turns and walks.

    python3 tests/tools/moving_picture.py [OUT]

The drawing's page, which fades into the model as seen from the front, which walks on the spot while the camera goes around it once.
Requires Inkscape for the page, and Pillow. OKOSHI is a binary to use instead of target/release/okoshi.
"""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parent.parent.parent
DRAWING = ROOT / "examples/girl.svg"
SIZE = (560, 520)
# Pictures a second, and how many the page stands still for, fades in, and the model walks for.
RATE = 20
PAGE, FADE, WALK = 24, 8, 96
# A cycle of the walk, frames at 24 a second.
CYCLE = 24


def run(*command):
    subprocess.run([str(part) for part in command], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def white(path):
    picture = Image.open(path).convert("RGBA")
    return Image.alpha_composite(Image.new("RGBA", picture.size, "white"), picture).convert("RGB")


def extent(path):
    """The top and the bottom of what is opaque in a picture, and its middle column."""
    left, top, right, bottom = Image.open(path).convert("RGBA").getchannel("A").point(lambda a: 255 if a > 200 else 0).getbbox()
    return top, bottom, (left + right) / 2


def main():
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs/girl.webp"
    okoshi = Path(os.environ.get("OKOSHI", ROOT / "target/release/okoshi")).resolve()
    with tempfile.TemporaryDirectory() as scratch:
        room = Path(scratch)
        text = DRAWING.read_text()
        walking = re.sub("Motion walk", "Motion -i walk", text)
        assert walking != text, "the drawing walks"
        (room / "girl.svg").write_text(walking)
        run(okoshi, "build", "-q", room / "girl.svg", "-o", room / "girl.glb")
        size = "x".join(map(str, SIZE))

        def view(name, yaw, seconds, *more):
            options = ["--view", f"{yaw:.2f},6", "--size", size, "--projection", "orthographic", *more]
            path = room / f"{name}.png"
            run(okoshi, "render", "-q", room / "girl.glb", "-o", path, "--clip", "1", f"--time={seconds:.4f}", *options)
            return path

        # The page as large, and where, as the model is seen from the front.
        run(okoshi, "render", "-q", DRAWING, "-o", room / "flat.png", "--as-drawn", "--scale", "4")
        top, bottom, middle = extent(room / "flat.png")
        model_top, model_bottom, model_middle = extent(view("front", 0, 0, "--shading", "unlit"))
        scale = (model_bottom - model_top) / (bottom - top)
        page_width = Image.open(room / "flat.png").width * scale
        run("inkscape", DRAWING, "--export-type=png", "--export-background=white", f"--export-width={round(page_width)}",
            f"--export-filename={room / 'page.png'}")
        page = Image.new("RGB", SIZE, "white")
        page.paste(white(room / "page.png"), (round(model_middle - middle * scale), round(model_top - top * scale)))

        frames = [page] * PAGE
        model = []
        for number in range(WALK):
            share = number / WALK
            # It starts and ends slowly.
            yaw = -360 * (3 * share**2 - 2 * share**3)
            seconds = (number / RATE) % (CYCLE / 24)
            model.append(white(view(f"walk-{number}", yaw, seconds)))
        still = model[0]
        for number in range(1, FADE + 1):
            frames.append(Image.blend(page, still, number / (FADE + 1)))
        frames += [still] * (FADE // 2) + model + [still] * (FADE // 2)
        for number in range(1, FADE + 1):
            frames.append(Image.blend(still, page, number / (FADE + 1)))
    step = round(1000 / RATE)
    frames[0].save(out, save_all=True, append_images=frames[1:], duration=step, loop=0, quality=78, method=4)
    print(f"{out}: {len(frames)} pictures, {out.stat().st_size // 1024} KiB")


if __name__ == "__main__":
    main()
