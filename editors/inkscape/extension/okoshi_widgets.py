"""Pieces of GTK 3 that the windows share."""

from gi.repository import Gtk, Pango


def label(text, style=None, attributes=None):
    """A label whose long lines are wrapped, with a class of GTK's style."""
    made = Gtk.Label(label=text, xalign=0, wrap=True, wrap_mode=Pango.WrapMode.WORD_CHAR, attributes=attributes)
    if style:
        made.get_style_context().add_class(style)
    return made


def bold(scale=1.0):
    """Attributes of bold text, larger by a factor."""
    attributes = Pango.AttrList()
    for attribute in (Pango.attr_weight_new(Pango.Weight.BOLD), Pango.attr_scale_new(scale)):
        attributes.insert(attribute)
    return attributes


def combo(lines, active):
    """A list to choose one of."""
    made = Gtk.ComboBoxText(hexpand=True)
    for cell in made.get_cells():
        cell.set_property("ellipsize", Pango.EllipsizeMode.END)
    for line in lines:
        made.append_text(line)
    if active is not None:
        made.set_active(active)
    return passive(made)


def passive(made):
    """A control over which the wheel moves the form, and not the control."""
    made.connect("scroll-event", lambda one, _: one.stop_emission_by_name("scroll-event"))
    return made
