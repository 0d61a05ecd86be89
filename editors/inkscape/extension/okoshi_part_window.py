"""The form of selected parts. Arguments: the folder of the drawing, and okoshi's arguments to read it; none for a message.

It reads `{"name": …, "forms": […]}` from stdin, or `{"name": …, "message": …}`, which it only shows. *Apply* makes the changes with
`okoshi edit`: what is refused is shown with what can be done instead. The process ends with status 0 once `EDITED` is in the folder,
with `UNCHANGED` if the person changed nothing, and with `NO_WINDOW` if there is no GTK 3 or no screen.
"""

import json
import os
import sys

from okoshi_form import EDITED, FIRST, NO_WINDOW, UNCHANGED, Draft, in_quotes, listed
from okoshi_program import Missing, run

try:
    import gi

    for library in ("Gdk", "Gtk"):
        gi.require_version(library, "3.0")
    from gi.repository import Gdk, Gtk

    from okoshi_controls import Field
    from okoshi_widgets import bold, combo, label
except (ImportError, ValueError):
    sys.exit(NO_WINDOW)


class Refused(Exception):
    """A change that okoshi did not make: why, and what can be done instead."""

    def __init__(self, why, change=None, choices=()):
        super().__init__(why)
        self.change, self.choices = change, choices


def make(changes, folder, reading):
    """Makes changes in the drawing of a folder. Raises `Refused`, with a sentence."""
    os.makedirs(os.path.join(folder, os.path.dirname(EDITED)), exist_ok=True)
    arguments = ["edit", "--json", "-o", EDITED]
    for change in changes:
        arguments.append("--change=" + json.dumps(change))
    try:
        status, output, errors = run(arguments + reading, folder)
    except Missing as missing:
        raise Refused(str(missing))
    if status == 0:
        return
    try:
        refused = json.loads(output)["refused"]
    except (ValueError, KeyError):
        raise Refused(errors or output)
    raise Refused(refused["why"][:1].upper() + refused["why"][1:] + ".", refused["change"], refused["choices"])


class Window(Gtk.Window):
    """The form, what was refused, and two buttons."""

    def __init__(self, name, draft, apply):
        """`apply` is called with the changes, and raises `Refused` if they cannot be made."""
        super().__init__(default_width=560, default_height=640, title="%s in %s: Okoshi" % (listed(draft.parts), name))
        self.draft, self.apply, self.status = draft, apply, UNCHANGED
        # Inkscape waits for this window, which must not get lost behind it.
        self.set_keep_above(True)
        rows = Gtk.Box(orientation=Gtk.Orientation.VERTICAL, spacing=10, margin=12)
        if len(draft.parts) > 1:
            rows.add(label("What is set here is set for all of them: %s." % ", ".join(draft.parts), "dim-label"))
        self.add_head(rows)
        fields = {field["attribute"]: field for field in draft.form["fields"]}
        for attribute in FIRST:
            if attribute in fields:
                rows.add(Field(draft, attribute).section())
        more = [attribute for attribute in fields if attribute not in FIRST]
        if more:
            rows.add(label("More", attributes=bold(1.1)))
        for attribute in more:
            rows.add(Field(draft, attribute).folded())
        if draft.parents is not None:
            leave = Gtk.CheckButton(label="Leave %s out of the model" % ("this part" if len(draft.parts) == 1 else "these parts"), margin_top=6)
            leave.connect("toggled", lambda button: setattr(draft, "left_out", button.get_active()))
            rows.add(leave)
        inside = Gtk.ScrolledWindow(vexpand=True, hscrollbar_policy=Gtk.PolicyType.NEVER)
        inside.add(rows)
        self.refusal = Gtk.Box(orientation=Gtk.Orientation.VERTICAL, spacing=6, margin=12, no_show_all=True)
        buttons = Gtk.ButtonBox(layout_style=Gtk.ButtonBoxStyle.END, spacing=6, margin=12)
        cancel = Gtk.Button(label="Cancel")
        cancel.connect("clicked", lambda _: self.destroy())
        self.applying = Gtk.Button(label="Apply", can_default=True)
        self.applying.get_style_context().add_class("suggested-action")
        self.applying.connect("clicked", lambda _: self.on_apply())
        for button in (cancel, self.applying):
            buttons.add(button)
        box = Gtk.Box(orientation=Gtk.Orientation.VERTICAL)
        for child in (inside, Gtk.Separator(), self.refusal, buttons):
            box.add(child)
        self.add(box)
        self.set_default(self.applying)
        self.connect("key-press-event", self.on_key)
        self.connect("destroy", lambda _: Gtk.main_quit())

    def add_head(self, rows):
        """The name, and what the part hangs on."""
        draft, grid = self.draft, Gtk.Grid(row_spacing=6, column_spacing=12)
        if draft.has_name:
            entry = Gtk.Entry(text=draft.name, hexpand=True, activates_default=True)
            if not draft.form["named"]:
                entry.set_placeholder_text("%s: type a name" % draft.form["part"])
            entry.connect("changed", lambda entry: setattr(draft, "name", entry.get_text()))
            add_row(grid, 0, "Name", entry)
        if draft.parents is not None:
            parents = [None] + draft.parents
            choice = combo(["nothing"] + draft.parents, parents.index(draft.parent) if draft.parent in parents else None)
            choice.connect("changed", lambda choice: setattr(draft, "parent", parents[choice.get_active()]))
            add_row(grid, 1, "Hangs on", choice)
        rows.add(grid)

    def on_apply(self):
        changes = self.draft.changes()
        if not changes:
            self.destroy()
            return
        try:
            self.apply(changes)
        except Refused as refused:
            self.show_refusal(refused)
            return
        self.status = 0
        self.destroy()

    def show_refusal(self, refused):
        """Shows why a change was not made, with a button for each change that can be made instead."""
        for child in self.refusal.get_children():
            child.destroy()
        self.refusal.add(label(in_quotes(str(refused)), attributes=bold()))
        for choice in refused.choices:
            button = Gtk.Button(label=in_quotes(choice["title"]), halign=Gtk.Align.START)
            button.connect("clicked", self.on_choice, refused.change, choice["change"])
            self.refusal.add(button)
        self.refusal.set_no_show_all(False)
        self.refusal.show_all()
        for first in self.refusal.get_children()[1:2]:
            first.grab_focus()

    def on_choice(self, _button, change, instead):
        self.draft.choose(change, instead)
        self.on_apply()

    def on_key(self, _window, event):
        if event.keyval == Gdk.KEY_Escape:
            self.destroy()
        return False


def add_row(grid, row, name, control):
    grid.attach(label(name, attributes=bold()), 0, row, 1, 1)
    grid.attach(control, 1, row, 1, 1)


def show_sentence(name, text):
    """Shows a message until it is closed."""
    dialog = Gtk.MessageDialog(title="%s: Okoshi" % name, message_type=Gtk.MessageType.INFO, buttons=Gtk.ButtonsType.CLOSE, text=in_quotes(text))
    dialog.set_keep_above(True)
    dialog.run()
    dialog.destroy()


def main(arguments):
    """Runs until the window is closed. Returns the exit status."""
    if not Gtk.init_check(None)[0]:
        return NO_WINDOW
    asked = json.load(sys.stdin)
    if "message" in asked:
        show_sentence(asked["name"], asked["message"])
        return UNCHANGED
    folder, *reading = arguments
    window = Window(asked["name"], Draft(asked["forms"]), lambda changes: make(changes, folder, reading))
    window.show_all()
    window.present()
    Gtk.main()
    return window.status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
