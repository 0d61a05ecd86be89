"""The entries of Inkscape's menu *Extensions → Okoshi*. None of them changes the drawing."""

import re

from okoshi_drawing import Drawing
from okoshi_findings import for_window, plural
from okoshi_previews import Failed, show, stop_all
from okoshi_program import Missing, find, run
from okoshi_say import say

import inkex


class Entry(inkex.EffectExtension):
    """An entry of the menu: `do` does it, and says what went wrong."""

    def load_raw(self):
        """Nothing is read: okoshi reads the drawing, and some entries are called without one."""

    def effect(self):
        try:
            self.do()
        except (Missing, Failed) as error:
            say(str(error))

    def has_changed(self, ret):
        """Nothing is given back to Inkscape, so that there is nothing to undo either."""
        return False

    def do(self):
        raise NotImplementedError


class Check(Entry):
    """Shows all diagnostics; of a drawing in order, how many parts and strings it has."""

    def do(self):
        drawing = Drawing(self.options.input_file)
        with drawing.in_folder() as (folder, reading):
            status, said, complained = run(["check"] + reading, folder)
            text = said + complained
            found = for_window(run(["check", "--format", "json"] + reading, folder)[1], drawing.data)
            if status != 0:
                advice = drawing.advice(text)
                say((text if found is None else found + "\n") + advice, text + advice)
                return
            status, said, complained = run(["build", "--stats", "-q", "-o", "model.glb"] + reading, folder)
        counted = said + complained
        parts, strings = (re.search(r"^\s*%s\s+(\d+)\s*$" % what, counted, re.M) for what in ("parts", "strings"))
        if status != 0 or parts is None or strings is None:
            raise Failed("okoshi did not say what the drawing has:\n\n" + counted)
        verdict = "%s: %s, %s" % (
            "no errors" if re.search(r"^warning\[", text, re.M) else "no problems",
            plural(parts.group(1), "part"),
            plural(strings.group(1), "string"),
        )
        say("\n\n".join([found, verdict]) if found else verdict, text + verdict)


class Preview(Entry):
    """Shows the model in the browser, by one server a drawing."""

    def do(self):
        drawing = Drawing(self.options.input_file)
        address = show(find(), drawing)
        if address is not None:
            say("The model is at %s; no browser was found to open it." % address)


class Stop(Entry):
    """Ends the servers."""

    def do(self):
        number = stop_all()
        say("%s stopped" % plural(str(number), "preview") if number else "no preview is running")


class Explain(Entry):
    """The manual."""

    def add_arguments(self, pars):
        pars.add_argument("--about", default="")

    def do(self):
        about = self.options.about.strip()
        # A word that begins with a dash is no option.
        status, said, complained = run(["explain"] + (["--", about] if about else []))
        say(said if status == 0 else complained)
