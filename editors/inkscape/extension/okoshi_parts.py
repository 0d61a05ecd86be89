"""*Extensions → Okoshi → Part…*: a form of the selected parts, in a window of its own (`okoshi_part_window`).

The window runs in a process of its own, so that GTK and the modules of Inkscape do not get into each other's way. Inkscape waits for it,
and then has what was changed in one step of its undo history.
"""

import json
import os
import subprocess
import sys

from okoshi_cache import Failed
from okoshi_canvas import remember
from okoshi_drawing import Drawing
from okoshi_entry import Entry
from okoshi_form import EDITED, NO_WINDOW, UNCHANGED
from okoshi_messages import show_message
from okoshi_program import CREATE_NO_WINDOW, find, run
from okoshi_strings import merge, parse

# More would not be read.
MAX_REASONS = 5


class Part(Entry):
    """Lets the person change the selected parts."""

    def do(self):
        program, drawing = find(), Drawing(self.options.input_file)
        if not self.options.ids:
            raise Failed("Nothing is selected. Select a shape, or the string of a part, and call Part… again.")
        with drawing.in_folder() as (folder, reading):
            forms = read_forms(self.options.ids, folder, reading)
            status, errors = show_window({"name": drawing.name, "forms": forms}, [folder] + reading, OKOSHI=program)
            if status == NO_WINDOW:
                raise Failed("The window of Part… needs a screen and GTK 3 for Python; on Debian: sudo apt-get install python3-gi gir1.2-gtk-3.0")
            if status == UNCHANGED:
                return
            if status != 0:
                raise Failed("The window of Part… has failed; nothing was changed.\n\n" + errors)
            with open(os.path.join(folder, EDITED), "rb") as file:
                new = file.read()
        remember(drawing)
        merge(parse(drawing.data), parse(new), self.document.getroot())

    def fail(self, message):
        """Inkscape shows no messages of entries with a window of their own."""
        drawing = Drawing(self.options.input_file)
        if show_window({"name": drawing.name, "message": message}, [])[0] != UNCHANGED:
            show_message(message)


def read_forms(ids, folder, reading):
    """The forms of the parts that objects belong to, each part once. Raises `Failed` if there are none."""
    wanted = ["--form=#" + identifier for identifier in ids]
    output, errors = run(["inspect"] + wanted + reading, folder)[1:]
    if "unexpected argument '--form'" in errors:
        raise Failed("This okoshi is too old for the form of a part: install a newer one.")
    if not output:
        why = [line[len("error: ") :] for line in errors.splitlines() if line.startswith("error: ")]
        raise Failed("\n".join(why[:MAX_REASONS] or [errors]) + "\n\nSelect a shape, or the string of a part.")
    return list({form["part"]: form for form in json.loads(output)["forms"]}.values())


def show_window(asked, arguments, **environ):
    """Shows the window, and waits for it. Returns its exit status, and what it has said on stderr."""
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return NO_WINDOW, ""
    window = os.path.join(os.path.dirname(os.path.abspath(__file__)), "okoshi_part_window.py")
    process = subprocess.Popen(
        [sys.executable, window] + arguments,
        env=dict(os.environ, **environ),
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        # Kept from Inkscape: GTK warns about things that are nobody's business.
        stderr=subprocess.PIPE,
        creationflags=CREATE_NO_WINDOW if sys.platform == "win32" else 0,
    )
    errors = process.communicate(json.dumps(asked).encode())[1]
    return process.returncode, errors.decode("utf-8", "replace")
