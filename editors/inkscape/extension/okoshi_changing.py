"""The entries of *Extensions → Okoshi* that change the drawing, each in one step of Inkscape's undo history.

Only strings are changed in the document that Inkscape passed and takes back: okoshi's own output is only compared with the input.
"""

import json
import os

from okoshi_cache import Failed, folder_of
from okoshi_canvas import remember, take, take_saved
from okoshi_drawing import Drawing
from okoshi_entry import Entry
from okoshi_findings import plural
from okoshi_messages import show_message
from okoshi_previews import copy_of
from okoshi_program import run
from okoshi_report import make_report, show_report
from okoshi_strings import merge, parse

UNCERTAIN = "uncertain"


class Suggest(Entry):
    """Names the parts that nobody has named, as `okoshi annotate` does, and shows the names."""

    def do(self):
        drawing = Drawing(self.options.input_file)
        with drawing.in_folder() as (folder, reading):
            # Of its own, so that no drawing has this name.
            os.mkdir(os.path.join(folder, "named"))
            named = os.path.join("named", "named.svg")
            status, output, errors = run(["annotate", "--json", "-o", named] + reading, folder)
            if status != 0:
                if "unrecognized subcommand" in errors:
                    raise Failed("This okoshi is too old to suggest strings: install a newer one.\n\n" + errors)
                raise Failed(errors + drawing.advice(errors))
            with open(os.path.join(folder, named), "rb") as file:
                new = file.read()
        remember(drawing)
        merge(parse(drawing.data), parse(new), self.document.getroot())
        names = [name_row(one) for one in json.loads(output)["parts"]]
        report = make_report(drawing, names, headline="%s in %s" % (plural(len(names), "name"), drawing.name), **remarks(names))
        show_rows(drawing, report)


class TakeIn(Entry):
    """Takes in what the preview's page, or another program, has changed about the strings since, and shows it."""

    def do(self):
        drawing = Drawing(self.options.input_file)
        if drawing.original is None:
            raise Failed("Save the drawing first: the page changes nothing of a drawing that was never saved.")
        folder = folder_of(drawing)
        os.makedirs(folder, mode=0o700, exist_ok=True)
        root = self.document.getroot()
        saved = take_saved(folder, drawing.original, root)
        paged = take(folder, copy_of(folder, drawing), drawing.data, root)
        taken, kept = (one + other for one, other in zip(saved, paged))
        if not taken and not kept:
            raise Failed("There is nothing to take in: %s is here as the preview's page and the file have it." % drawing.name)
        rows = [change_row(one, "warning") for one in kept] + [change_row(one, "") for one in taken]
        headline = "%s taken into %s" % (plural(len(taken), "change"), drawing.name)
        detail = "%s not: see the warnings" % plural(len(kept), "change") if kept else ""
        note = "Edit → Undo takes all of them back." if taken else ""
        show_rows(drawing, make_report(drawing, rows, headline=headline, detail=detail, note=note))


def change_row(one, severity):
    """What became of a change, as a row of the window."""
    sentence = one.sentence[:1].upper() + one.sentence[1:]
    return {"severity": severity, "code": "", "message": sentence, "string": None, "label": None, "help": None, "object": one.object}


def show_rows(drawing, report):
    """Shows a report in the window, or else in a message."""
    if not show_report(drawing, report):
        rows = [format_row(one) for one in report["findings"]]
        show_message("\n\n".join(filter(None, [report["headline"], report["detail"], *rows, report["note"]])))


def name_row(one):
    """A name that okoshi has found, as a row of the window."""
    string = one["name"] if one["parent"] is None else "%s@%s" % (one["name"], one["parent"])
    row = {"severity": "", "code": one["certainty"], "message": string, "string": None}
    return dict(row, label=one["why"], help=None, object=one["element"])


def remarks(names):
    """What is said below the headline and below the names."""
    unsure = sum(one["code"] == UNCERTAIN for one in names)
    detail = "look at %s: only place and shape tell" % plural(unsure, "uncertain name") if unsure else ""
    return {"detail": detail, "note": "Edit → Undo takes all of them back."}


def format_row(one):
    """A row for a message."""
    lines = ["%s: %s" % (one["severity"], one["message"]) if one["severity"] else one["message"]]
    if one["label"]:
        lines.append("    %s: %s" % (one["code"], one["label"]))
    if one["object"]:
        lines.append("    of the object: %s" % one["object"])
    return "\n".join(lines)
