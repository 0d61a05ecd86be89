"""The entries of Inkscape's menu *Extensions → Okoshi*. None of them changes the drawing."""

import re

from okoshi_drawing import Drawing
from okoshi_findings import format_findings, plural
from okoshi_previews import Failed, show, stop_all
from okoshi_program import Missing, find, run
from okoshi_messages import show_message

import inkex


class Entry(inkex.EffectExtension):
    """An entry of the menu, implemented by `do`. Shows errors as messages."""

    def load_raw(self):
        """Reads nothing: okoshi reads the drawing, and some entries are called without one."""

    def effect(self):
        try:
            self.do()
        except (Missing, Failed) as error:
            show_message(str(error))

    def has_changed(self, ret):
        """Returns no document to Inkscape, so that there is nothing to undo."""
        return False

    def do(self):
        raise NotImplementedError


class Check(Entry):
    """Shows all diagnostics, or the number of parts and strings if there are no errors."""

    def do(self):
        drawing = Drawing(self.options.input_file)
        with drawing.in_folder() as (folder, reading):
            status, output, errors = run(["check"] + reading, folder)
            text = output + errors
            found = format_findings(run(["check", "--format", "json"] + reading, folder)[1], drawing.data)
            if status != 0:
                advice = drawing.advice(text)
                show_message((text if found is None else found + "\n") + advice, text + advice)
                return
            status, output, errors = run(["build", "--stats", "-q", "-o", "model.glb"] + reading, folder)
        counted = output + errors
        parts, strings = (re.search(r"^\s*%s\s+(\d+)\s*$" % what, counted, re.M) for what in ("parts", "strings"))
        if status != 0 or parts is None or strings is None:
            raise Failed("okoshi did not report the number of parts and strings:\n\n" + counted)
        verdict = "%s: %s, %s" % (
            "no errors" if re.search(r"^warning\[", text, re.M) else "no problems",
            plural(parts.group(1), "part"),
            plural(strings.group(1), "string"),
        )
        show_message("\n\n".join([found, verdict]) if found else verdict, text + verdict)


class Preview(Entry):
    """Shows the model in the browser; each drawing has a server."""

    def do(self):
        drawing = Drawing(self.options.input_file)
        address = show(find(), drawing)
        if address is not None:
            show_message("The preview is at %s, but no browser was found to open it." % address)


class Stop(Entry):
    """Stops the servers."""

    def do(self):
        number = stop_all()
        show_message("%s stopped" % plural(str(number), "preview") if number else "no preview is running")


class Explain(Entry):
    """Shows the manual."""

    def add_arguments(self, pars):
        pars.add_argument("--about", default="")

    def do(self):
        about = self.options.about.strip()
        # `--` because the topic may begin with a dash.
        status, output, errors = run(["explain"] + (["--", about] if about else []))
        show_message(output if status == 0 else errors)
