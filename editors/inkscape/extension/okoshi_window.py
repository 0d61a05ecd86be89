"""The window with the findings of a drawing, or the names that were suggested. Argument: the drawing's folder in the cache.

It shows the report in that folder's `report.json`, and the new one when an entry of the menu replaces it, so that each drawing has one
window. A click on a finding selects its object in Inkscape. The process writes a line to stdout once the window is open, and
ends with status 1 at once if there is no GTK 3 or no screen.
"""

import json
import os
import sys

from okoshi_cache import lock
from okoshi_findings import MAX_FINDINGS
from okoshi_report import REPORT, WINDOW_LOCK
from okoshi_select import select

try:
    import gi

    for library in ("Gdk", "Gtk"):
        gi.require_version(library, "3.0")
    from gi.repository import Gdk, Gio, GLib, Gtk

    from okoshi_widgets import bold, label
except (ImportError, ValueError):
    sys.exit(1)

ICONS = {"error": "dialog-error", "warning": "dialog-warning", "hint": "dialog-information", "uncertain": "dialog-question"}


class Window(Gtk.Window):
    """A headline, a list of findings, and what became of the last click."""

    def __init__(self, path):
        super().__init__(default_width=520, default_height=420)
        self.path = path
        self.headline = label("", attributes=bold(1.25))
        self.detail = label("", "dim-label")
        self.note = label("")
        self.status = label("", "dim-label")
        self.list = Gtk.ListBox(activate_on_single_click=True, selection_mode=Gtk.SelectionMode.BROWSE)
        self.list.connect("row-activated", self.on_click)
        self.list.set_header_func(lambda row, before: row.set_header(Gtk.Separator() if before else None))
        rows = Gtk.ScrolledWindow(vexpand=True, hscrollbar_policy=Gtk.PolicyType.NEVER)
        rows.add(self.list)
        box = Gtk.Box(orientation=Gtk.Orientation.VERTICAL, spacing=6, margin=12)
        for child in (self.headline, self.detail, rows, self.note, self.status):
            box.add(child)
        self.add(box)
        self.connect("key-press-event", self.on_key)
        self.connect("destroy", lambda _: Gtk.main_quit())
        # Kept, as a monitor that is dropped reports nothing.
        self.monitor = Gio.File.new_for_path(path).monitor_file(Gio.FileMonitorFlags.WATCH_MOVES, None)
        self.monitor.connect("changed", self.on_change)

    def load(self):
        """Shows the report. Leaves the window as it is if there is none."""
        try:
            with open(self.path, encoding="utf-8") as file:
                report = json.load(file)
        except (OSError, ValueError):
            return
        found = report["findings"]
        self.set_title("%s: Okoshi" % report["name"])
        self.headline.set_text(report["headline"])
        more = ["the first %d are shown" % MAX_FINDINGS] if len(found) > MAX_FINDINGS else []
        self.detail.set_text("; ".join([report["detail"]] * bool(report["detail"]) + more))
        self.note.set_text(report["note"])
        self.status.set_text("Click a row to select its object." if found else "")
        for row in self.list.get_children():
            row.destroy()
        for one in found[:MAX_FINDINGS]:
            self.list.add(row_of(one))
        self.show_all()
        for line in (self.detail, self.note, self.status):
            line.set_visible(bool(line.get_text()))
        self.list.get_parent().set_visible(bool(found))

    def on_change(self, _monitor, _file, _other, event):
        if event in (Gio.FileMonitorEvent.CHANGES_DONE_HINT, Gio.FileMonitorEvent.RENAMED, Gio.FileMonitorEvent.CREATED):
            self.load()
            self.present()

    def on_click(self, _list, row):
        identifier = row.finding["object"]
        if identifier is None:
            self.status.set_text("This finding is about the whole drawing.")
        elif select(identifier):
            self.status.set_text("Selected in Inkscape: %s" % identifier)
        else:
            self.status.set_text("This Inkscape cannot be told what to select. Edit → Find finds the object by its id: %s" % identifier)

    def on_key(self, _window, event):
        if event.keyval == Gdk.KEY_Escape:
            self.destroy()
        return False


def row_of(one):
    """A finding as a row of the list."""
    texts = Gtk.Box(orientation=Gtk.Orientation.VERTICAL, spacing=2)
    texts.add(label(one["message"], attributes=bold()))
    if one["string"]:
        texts.add(label(one["string"], "monospace"))
    for text in (one["label"], one["help"]):
        if text:
            texts.add(label(text))
    texts.add(label(" · ".join(filter(None, [("%s %s" % (one["severity"], one["code"])).strip(), one["object"]])), "dim-label"))
    content = Gtk.Box(spacing=8, margin=8)
    icon = Gtk.Image.new_from_icon_name(ICONS.get(one["severity"] or one["code"], ICONS["hint"]), Gtk.IconSize.LARGE_TOOLBAR)
    icon.set_valign(Gtk.Align.START)
    content.add(icon)
    content.add(texts)
    row = Gtk.ListBoxRow()
    row.finding = one
    row.add(content)
    return row


def main(folder):
    """Runs until the window is closed."""
    if not Gtk.init_check(None)[0]:
        sys.exit(1)
    held = lock(folder, WINDOW_LOCK)
    if held is None:
        # Another process has this drawing's window, and shows the report.
        print("shown", flush=True)
        return
    window = Window(os.path.join(folder, REPORT))
    window.load()
    window.present()
    GLib.idle_add(print, "shown")
    GLib.idle_add(sys.stdout.flush)
    Gtk.main()
    held.close()


if __name__ == "__main__":
    main(sys.argv[1])
