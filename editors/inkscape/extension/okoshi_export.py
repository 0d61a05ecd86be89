"""Writes the drawing as a model: what Inkscape's *Save As* and `--export-filename` call."""

import os
import sys

from okoshi_drawing import Drawing
from okoshi_findings import for_window
from okoshi_program import Missing, run
from okoshi_say import say

import inkex


class Export(inkex.OutputExtension):
    """Hands the model to Inkscape on stdout, whole, or nothing at all: then Inkscape writes no file."""

    def __init__(self, ending):
        """`ending`: `glb` or `gltf`."""
        super().__init__()
        self.ending = ending

    def load_raw(self):
        """Nothing is read: okoshi reads the drawing."""

    def save(self, stream):
        """Writes the model's bytes to `stream`."""
        drawing = Drawing(self.options.input_file)
        try:
            with drawing.in_folder() as (folder, reading):
                model = "model." + self.ending
                status, _, said = run(["build", "-o", model] + reading, folder)
                if status != 0:
                    found = for_window(run(["check", "--format", "json"] + reading, folder)[1], drawing.data)
                    advice = drawing.advice(said)
                    say((said if found is None else found + "\n\nnothing was written\n") + advice, said + advice)
                    sys.exit(1)
                with open(os.path.join(folder, model), "rb") as file:
                    content = file.read()
        except Missing as missing:
            say(str(missing))
            sys.exit(1)
        stream.write(content)
        stream.flush()
        # Hints are for the check: a window at every saving would be in the way.
        if "warning[" in said:
            say("".join(line for line in said.splitlines(True) if not line.startswith("wrote ")))
