"""Exports the drawing as a model, for Inkscape's *Save As* and `--export-filename`."""

import os
import sys

from okoshi_drawing import Drawing
from okoshi_findings import format_findings, read_findings
from okoshi_program import Missing, run
from okoshi_messages import show_message

import inkex


class Export(inkex.OutputExtension):
    """Writes the complete model to stdout, or nothing: then Inkscape writes no file."""

    def __init__(self, ending):
        """`ending`: `glb` or `gltf`."""
        super().__init__()
        self.ending = ending

    def load_raw(self):
        """Reads nothing: okoshi reads the drawing."""

    def save(self, stream):
        """Writes the model's bytes to `stream`."""
        drawing = Drawing(self.options.input_file)
        try:
            with drawing.in_folder() as (folder, reading):
                model = "model." + self.ending
                status, _, errors = run(["build", "-o", model] + reading, folder)
                if status != 0:
                    found = read_findings(run(["check", "--format", "json"] + reading, folder)[1], drawing.data)
                    advice = drawing.advice(errors)
                    show_message((errors if found is None else format_findings(found) + "\n\nnothing was written\n") + advice, errors + advice)
                    sys.exit(1)
                with open(os.path.join(folder, model), "rb") as file:
                    content = file.read()
        except Missing as missing:
            show_message(str(missing))
            sys.exit(1)
        stream.write(content)
        stream.flush()
        # Hints are left to the check: a window after every save would be annoying.
        if "warning[" in errors:
            show_message("".join(line for line in errors.splitlines(True) if not line.startswith("wrote ")))
