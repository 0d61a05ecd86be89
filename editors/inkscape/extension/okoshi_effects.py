"""Entries of Inkscape's menu *Extensions → Okoshi*. These do not change the drawing; `okoshi_changing` and
`okoshi_parts` have those that do."""

import re

from okoshi_cache import Failed
from okoshi_canvas import remember
from okoshi_drawing import Drawing
from okoshi_entry import Entry
from okoshi_findings import format_findings, plural, read_findings
from okoshi_previews import show, stop_all, waiting
from okoshi_program import find, run
from okoshi_messages import show_message
from okoshi_report import make_report, show_report


class Unchanging(Entry):
    """An entry that leaves the document alone."""

    def load_raw(self):
        """Reads nothing: okoshi reads the drawing, and some entries are called without one."""

    def has_changed(self, ret):
        """Returns no document to Inkscape, so that there is nothing to undo."""
        return False


class Check(Unchanging):
    """Shows all diagnostics, and the number of parts and strings if there are no errors."""

    def do(self):
        drawing = Drawing(self.options.input_file)
        with drawing.in_folder() as (folder, reading):
            status, output, errors = run(["check"] + reading, folder)
            text = output + errors
            found = read_findings(run(["check", "--format", "json"] + reading, folder)[1], drawing.data)
            if status != 0:
                advice = drawing.advice(text)
                if found is None or not show_report(drawing, make_report(drawing, found, note=advice)):
                    show_message((text if found is None else format_findings(found) + "\n") + advice, text + advice)
                return
            status, output, errors = run(["build", "--stats", "-q", "-o", "model.glb"] + reading, folder)
        counted = output + errors
        parts, strings = (re.search(r"^\s*%s\s+(\d+)\s*$" % what, counted, re.M) for what in ("parts", "strings"))
        if status != 0 or parts is None or strings is None:
            raise Failed("okoshi did not report the number of parts and strings:\n\n" + counted)
        counts = "%s, %s" % (plural(parts.group(1), "part"), plural(strings.group(1), "string"))
        if found is None or not show_report(drawing, make_report(drawing, found, counts)):
            verdict = "%s: %s" % ("no errors" if re.search(r"^warning\[", text, re.M) else "no problems", counts)
            show_message("\n\n".join([format_findings(found), verdict]) if found else verdict, text + verdict)


class Preview(Unchanging):
    """Shows the model in the browser; each drawing has a server."""

    def do(self):
        drawing = Drawing(self.options.input_file)
        address = show(find(), drawing)
        remember(drawing)
        if address is not None:
            show_message("The preview is at %s, but no browser was found to open it." % address)


class Stop(Unchanging):
    """Stops the servers."""

    def do(self):
        number = stop_all()
        said = "%s stopped" % plural(str(number), "preview") if number else "no preview is running"
        for name in waiting():
            said += "\n\nWhat the page has changed in %s is not in Inkscape yet: open it there and call Take In Changes." % name
        show_message(said)


class Explain(Unchanging):
    """Shows the manual."""

    def add_arguments(self, pars):
        pars.add_argument("--about", default="")

    def do(self):
        about = self.options.about.strip()
        # `--` because the topic may begin with a dash.
        status, output, errors = run(["explain"] + (["--", about] if about else []))
        show_message(output if status == 0 else errors)
