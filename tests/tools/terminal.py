#!/usr/bin/env python3
"""Runs a program in a terminal, types keys, and saves the screen as a PNG, for editor_pictures.sh.

    pip install pyte pillow
    terminal.py -o out.png [--size COLUMNSxROWS] [--keys "1.5:ihello<Esc>"]… [--env NAME=VALUE]… -- PROGRAM ARGUMENTS…

Each --keys waits for that many seconds, then types; <Esc>, <CR>, <C-x> and <Space> are keys, everything else is typed literally.
After the last keys it waits for --settle seconds.
"""

import argparse
import fcntl
import os
import pty
import re
import select
import signal
import struct
import termios
import time
import unicodedata

import pyte
from PIL import Image, ImageDraw, ImageFont

PLAIN = "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf"
BOLD = "/usr/share/fonts/truetype/dejavu/DejaVuSansMono-Bold.ttf"
CJK = "/usr/share/fonts/opentype/noto/NotoSansCJK-Regular.ttc"
SIZE = 15
NAMED = {
    "black": "2e3436", "red": "cc0000", "green": "4e9a06", "brown": "c4a000", "blue": "3465a4", "magenta": "75507b",
    "cyan": "06989a", "white": "d3d7cf", "brightblack": "555753", "brightred": "ef2929", "brightgreen": "8ae234",
    "brightbrown": "fce94f", "brightyellow": "fce94f", "brightblue": "729fcf", "brightmagenta": "ad7fa8",
    "brightcyan": "34e2e2", "brightwhite": "eeeeec",
}


def keys(text):
    """The bytes that a terminal sends for keys."""
    named = {"Esc": "\x1b", "CR": "\r", "Space": " ", "Tab": "\t"}

    def byte(found):
        name = found.group(1)
        return chr(ord(name[2].lower()) & 31) if name.startswith("C-") else named[name]

    return re.sub(r"<(C-.|Esc|CR|Space|Tab)>", byte, text).encode()


def colour(name, fallback):
    """Converts a colour of pyte for Pillow."""
    if name == "default":
        return fallback
    return "#" + NAMED.get(name, name)


class Screen(pyte.Screen):
    """A screen that ignores unknown queries."""

    def report_device_status(self, mode, private=False):
        if not private:
            super().report_device_status(mode)


def run(arguments):
    """Types the keys and returns the screen."""
    columns, rows = (int(side) for side in arguments.size.split("x"))
    screen = Screen(columns, rows)
    stream = pyte.ByteStream(screen)
    process, terminal = pty.fork()
    if process == 0:
        os.environ.update(TERM="xterm-256color", COLORTERM="truecolor", LANG="C.UTF-8", LC_ALL="C.UTF-8")
        os.environ.update(pair.split("=", 1) for pair in arguments.env)
        os.execvp(arguments.program[0], arguments.program)
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
    screen.write_process_input = lambda answer: os.write(terminal, answer.encode())

    def look_on(seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if select.select([terminal], [], [], 0.05)[0]:
                try:
                    data = os.read(terminal, 65536)
                except OSError:
                    return
                # pyte does not support sub-parameters, such as those of curly underlines.
                data = re.sub(rb"\x1b\[4:[1-5]m", b"\x1b[4m", data)
                data = re.sub(rb"\x1b\[5[89](?:[:;][0-9:;]*)?m|\x1b\[[>?=][0-9;]*[mu]|\x1b\[\?[0-9;]*\$p", b"", data)
                stream.feed(data)

    for step in arguments.keys:
        wait, typed = step.split(":", 1)
        look_on(float(wait))
        os.write(terminal, keys(typed))
    look_on(arguments.settle)
    os.kill(process, signal.SIGTERM)
    time.sleep(0.2)
    try:
        os.kill(process, signal.SIGKILL)
    except ProcessLookupError:
        pass
    os.waitpid(process, 0)
    return screen


def draw(screen, ink, paper):
    """The screen as an image."""
    fonts = {False: ImageFont.truetype(PLAIN, SIZE), True: ImageFont.truetype(BOLD, SIZE)}
    width, height = round(fonts[False].getlength("M")), round(SIZE * 1.3)
    image = Image.new("RGB", (screen.columns * width, screen.lines * height), paper)
    pen = ImageDraw.Draw(image)
    for row in range(screen.lines):
        for column in range(screen.columns):
            cell = screen.buffer[row][column]
            front, back = colour(cell.fg, ink), colour(cell.bg, paper)
            if cell.reverse != (not screen.cursor.hidden and (screen.cursor.y, screen.cursor.x) == (row, column)):
                front, back = back, front
            x, y = column * width, row * height
            columns = 2 if cell.data and unicodedata.east_asian_width(cell.data[0]) in "WF" else 1
            if cell.data:
                pen.rectangle([x, y, x + columns * width - 1, y + height - 1], fill=back)
            if cell.data.strip():
                pen.text((x, y), cell.data, font=ImageFont.truetype(CJK, SIZE) if columns == 2 else fonts[cell.bold], fill=front)
            if cell.underscore:
                pen.line([x, y + height - 2, x + columns * width - 1, y + height - 2], fill=front)
    return image


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", required=True)
    parser.add_argument("--size", default="110x30")
    parser.add_argument("--keys", action="append", default=[])
    parser.add_argument("--env", action="append", default=[])
    parser.add_argument("--settle", type=float, default=1.5)
    parser.add_argument("--ink", default="#d8d8d8")
    parser.add_argument("--paper", default="#1c1c1c")
    parser.add_argument("program", nargs="+")
    arguments = parser.parse_args()
    image = draw(run(arguments), arguments.ink, arguments.paper)
    image.quantize(64).save(arguments.o, optimize=True)


if __name__ == "__main__":
    main()
