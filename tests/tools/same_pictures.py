"""Compares pictures that were made again with the committed ones: python3 tests/tools/same_pictures.py MADE COMMITTED [PATTERN…]

MADE has the same paths as COMMITTED. Pictures may differ as fonts and processors make them differ, but not in what they show: both are divided
into about a thousand squares, and no square may have another colour. Of moving pictures, every eighth is compared. All committed pictures must
have been made, so that none is left over, but for those whose paths match a PATTERN. Exit status 1 if a picture is older than the program.
Requires Pillow.
"""

import sys
from fnmatch import fnmatch
from pathlib import Path

from PIL import Image, ImageChops, ImageSequence, ImageStat

# How far the colours of a picture may be from each other, on average: over the whole picture, and in one of the squares of its grid; of 255.
WHOLE = 2.0
SQUARE = 24.0
SQUARES = 32
ENDINGS = {".png", ".webp", ".gif", ".jpg"}
# Pages with Japanese texts, for which machines have different fonts, or none.
FONTS = {Path("gallery/robot-ja-drawing.png"), Path("gallery/motion-robot-ja-drawing.png")}
# A recording, which begins at any moment of what the camera films, and takes as many pictures as the machine can.
RECORDED = {Path("preview-camera.png")}
# Every so many of a moving picture.
STRIDE = 8


def frames(path):
    with Image.open(path) as picture:
        return [frame.convert("RGB") for frame in list(ImageSequence.Iterator(picture))[::STRIDE]]


def distance(one, other):
    """The mean difference of two pictures, and that of their most different square."""
    apart = ImageChops.difference(one, other).convert("L")
    squares = apart.resize((SQUARES, SQUARES), Image.Resampling.BOX)
    return ImageStat.Stat(apart).mean[0], squares.getextrema()[1]


def complaint(made, committed):
    """Why two files do not show the same; None if they do."""
    if not committed.exists():
        return "was never committed"
    new, old = frames(made), frames(committed)
    if len(new) != len(old):
        return "has another number of pictures"
    # A caption in another font may be a line of pixels higher.
    if any(abs(a - b) > 0.02 * b for one, other in zip(new, old) for a, b in zip(one.size, other.size)):
        return f"is {old[0].size[0]} × {old[0].size[1]} pixels large, and now would be {new[0].size[0]} × {new[0].size[1]}"
    whole, square = map(max, zip(*(distance(one.resize(other.size), other) for one, other in zip(new, old))))
    if whole > WHOLE or square > SQUARE:
        return f"shows something else: {whole:.1f} of 255 on average, {square} in one place"
    return None


def pictures(folder):
    return {path.relative_to(folder) for path in folder.rglob("*") if path.suffix in ENDINGS}


def main():
    made, committed, elsewhere = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:]
    new = pictures(made)
    if not new:
        sys.exit(f"error: there are no pictures in {made}")
    if new & FONTS:
        print("skipped: pages with Japanese texts are not compared, which look different with every font")
    wrong = {name: why for name in sorted(new - FONTS - RECORDED) if (why := complaint(made / name, committed / name))}
    left = {name for name in pictures(committed) - new if not any(fnmatch(name, pattern) for pattern in elsewhere)}
    wrong |= {name: "is made by no script" for name in sorted(left)}
    for name, why in wrong.items():
        print(f"{committed / name} {why}")
    print(f"{len(new)} pictures made again, {len(wrong)} of them not as committed")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
