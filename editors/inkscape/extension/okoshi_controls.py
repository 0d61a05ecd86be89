"""The controls of an attribute in the form of a part, by the types of its arguments."""

from gi.repository import Gdk, Gtk, Pango

from okoshi_form import digits, flags_of, hexadecimal, is_color, least, listed, number, quoted, rgba, saying, silent, unquoted, with_value, worded
from okoshi_widgets import bold, combo, label, passive

FROM = {"own": "set here", "legend": "from a legend", "default": "from the drawing's defaults", "builtin": ""}


class Field:
    """The controls of an attribute."""

    def __init__(self, draft, attribute):
        self.draft, self.attribute = draft, attribute
        self.first = draft.fields[attribute]
        self.value = label("", "dim-label")
        self.value.set_line_wrap(False)
        self.value.set_ellipsize(Pango.EllipsizeMode.END)
        self.reset = Gtk.Button(label="Reset", relief=Gtk.ReliefStyle.NONE, no_show_all=True, tooltip_text="Take it away: %s" % self.first["default"])
        self.reset.connect("clicked", lambda _: self.say(silent(self.now), anew=True))
        self.controls = Gtk.Box(orientation=Gtk.Orientation.VERTICAL, spacing=6)
        self.arguments = None
        self.fill()
        self.tell()

    @property
    def now(self):
        """The field as it was set last."""
        return self.draft.fields[self.attribute]

    def say(self, field, anew=False):
        """Sets the field. Its controls are drawn anew if they have become others."""
        self.draft.say(field)
        if anew:
            self.fill()
            self.controls.show_all()
        self.tell()

    def tell(self):
        """Says what the attribute is, and from where."""
        now = self.now
        if now["value"] is None:
            told = now["default"] if now is not self.first else ""
        else:
            told = " · ".join(filter(None, [now["value"] or "on", FROM.get(now["from"], now["from"])]))
        self.value.set_text(told.replace("`", ""))
        self.reset.set_visible(now["from"] == "own")

    def section(self):
        """The attribute as a part of the form that is always there."""
        head = Gtk.Box(spacing=8)
        head.add(label(self.attribute, attributes=bold()))
        self.value.set_hexpand(True)
        head.add(self.value)
        head.add(self.reset)
        return self.boxed([head])

    def folded(self):
        """The same, opened when it is needed, or set here."""
        head = Gtk.Box(spacing=8)
        head.add(label(self.attribute))
        head.add(self.value)
        expander = Gtk.Expander(label_widget=head, label_fill=True, expanded=self.first["from"] == "own")
        inside = self.boxed([])
        inside.set_margin_start(18)
        self.reset.set_halign(Gtk.Align.START)
        inside.add(self.reset)
        expander.add(inside)
        return expander

    def boxed(self, children):
        box = Gtk.Box(orientation=Gtk.Orientation.VERTICAL, spacing=4)
        for child in children:
            box.add(child)
        summary = self.first["summary"].replace("`", "")
        box.add(label(summary[:1].upper() + summary[1:] + ".", "dim-label"))
        if self.first["shared"]:
            box.add(label("Shared with %s." % listed([name.replace("`", "") for name in self.first["shared"]]), "dim-label"))
        box.add(self.controls)
        return box

    def fill(self):
        """Draws the controls for what the field says."""
        for child in self.controls.get_children():
            child.destroy()
        now = self.now
        variants = now["variants"]
        if is_color(now):
            self.controls.add(self.color())
            return
        if not variants:
            return
        bare = next((index for index, one in enumerate(variants) if one["word"] is None and 0 in one["counts"]), None)
        if bare is not None:
            self.controls.add(self.switch(bare))
        if len(variants) > (1 if bare is None else 2):
            self.controls.add(self.which())
        self.arguments = Gtk.Grid(row_spacing=4, column_spacing=8)
        self.controls.add(self.arguments)
        if now["chosen"] is not None:
            self.show_arguments(now["chosen"])
        elif len(variants) == 1 or bare is not None:
            # Numbers of a list that is not chosen would be of something else.
            self.show_arguments(next((index for index, one in enumerate(variants) if one["arguments"]), 0))
        for flag in now["flags"]:
            self.controls.add(self.flag(flag))

    def switch(self, bare):
        """A switch for an attribute that needs no argument."""
        now = self.now
        # What others say cannot be unsaid here.
        button = Gtk.CheckButton(label=self.attribute, active=now["value"] is not None, sensitive=now["value"] is None or now["from"] == "own")
        button.connect("toggled", lambda button: self.say(saying(self.now, bare, [], flags_of(self.now)) if button.get_active() else silent(self.now), anew=True))
        return button

    def which(self):
        """The list of the words that the attribute can begin with."""
        now = self.now
        nothing = [] if now["value"] is not None else ["(%s)" % now["default"].replace("`", "")]
        choice = combo(nothing + [title(one) for one in now["variants"]], 0 if now["chosen"] is None else now["chosen"] + len(nothing))

        def on_change(choice):
            index = choice.get_active() - len(nothing)
            if index < 0:
                self.say(silent(self.now), anew=True)
                return
            values = least(self.now["variants"][index])
            if values is None:
                # Something must be typed first.
                self.show_arguments(index)
            else:
                self.say(saying(self.now, index, values, flags_of(self.now)), anew=True)

        choice.connect("changed", on_change)
        return choice

    def flag(self, flag):
        """A switch for a letter behind the attribute, such as that for a second copy."""
        button = Gtk.CheckButton(active=flag["on"])
        button.add(label(flag["summary"].replace("`", "")))

        def on_toggle(button):
            letters = flags_of(self.now) - {flag["letter"]} | ({flag["letter"]} if button.get_active() else set())
            chosen = self.now["chosen"] or 0
            values = [one["value"] for one in self.now["variants"][chosen]["arguments"] if one["value"] is not None]
            self.say(saying(self.now, chosen, values, letters))

        button.connect("toggled", on_toggle)
        return button

    def show_arguments(self, index):
        """Shows the arguments of a variant."""
        for child in self.arguments.get_children():
            child.destroy()
        for row, argument in enumerate(self.now["variants"][index]["arguments"]):
            self.arguments.attach(label(argument["name"]), 0, 2 * row, 1, 1)
            controls = self.controls_of(index, row, argument)
            for column, control in enumerate(controls, 1):
                self.arguments.attach(control, column, 2 * row, 1, 1)
            self.arguments.attach(label(argument["summary"].replace("`", ""), "dim-label"), 1, 2 * row + 1, 2, 1)
        self.arguments.show_all()

    def controls_of(self, index, row, argument):
        """The controls of an argument."""
        takes = argument["takes"]

        def set_value(value):
            self.say(saying(self.now, index, with_value(self.now["variants"][index], row, value), flags_of(self.now)))

        if takes["type"] == "number":
            return number_controls(argument, set_value)
        if takes["type"] == "choice":
            words = [word for word, _ in takes["words"]]
            choice = combo(["%s: %s" % (word, summary.replace("`", "")) for word, summary in takes["words"]], words.index(argument["value"]) if argument["value"] in words else None)
            choice.connect("changed", lambda choice: set_value(words[choice.get_active()]))
            return [choice]
        is_list = takes["type"] == "names"
        entry = Gtk.Entry(hexpand=True, activates_default=True)
        entry.set_text((self.now["value"] or "") if is_list else unquoted(argument["value"] or ""))

        def on_change(entry):
            # Names stand for all that follow.
            text = entry.get_text().strip()
            value = text if is_list else quoted(text, takes["type"] == "file")
            if not text:
                self.say(silent(self.now))
            elif is_list:
                self.say(saying(self.now, index, [value], flags_of(self.now)))
            elif value is not None:
                set_value(value)

        entry.connect("changed", on_change)
        return [entry]

    def color(self):
        """A button that opens GTK's colours, and the colour as text."""
        box = Gtk.Box(spacing=8)
        now = self.now
        shown = Gdk.RGBA(0.5, 0.5, 0.5, 1.0)
        numbers = rgba(now["value"] or "")
        if numbers is not None:
            shown = Gdk.RGBA(*numbers)
        elif now["value"]:
            # By its name.
            shown.parse(now["value"])
        button = Gtk.ColorButton(rgba=shown, use_alpha=self.attribute == "Color", title=self.attribute)
        entry = Gtk.Entry(hexpand=True, activates_default=True, text=now["value"] or "", placeholder_text=now["default"].replace("`", ""))

        def on_pick(button):
            entry.set_text(hexadecimal(tuple(getattr(button.get_rgba(), one) for one in ("red", "green", "blue", "alpha"))))

        def on_type(entry):
            text = entry.get_text().strip()
            self.say(worded(self.now, text) if text else silent(self.now))
            numbers, named = rgba(text), Gdk.RGBA()
            if numbers is not None:
                button.set_rgba(Gdk.RGBA(*numbers))
            elif text and named.parse(text):
                button.set_rgba(named)

        button.connect("color-set", on_pick)
        entry.connect("changed", on_type)
        box.add(button)
        box.add(entry)
        return box


def number_controls(argument, set_value):
    """A slider with the number beside it, which can be typed and may be outside of the slider."""
    takes = argument["takes"]
    known = takes["start"] if argument["value"] is None else number(argument["value"])
    slider = Gtk.Scale.new_with_range(Gtk.Orientation.HORIZONTAL, takes["low"], max(takes["high"], takes["low"] + takes["step"]), takes["step"])
    slider.set_draw_value(False)
    slider.set_has_origin(False)
    slider.set_hexpand(True)
    slider.set_size_request(220, -1)
    slider.set_value(takes["low"] if known is None else known)
    passive(slider)
    entry = Gtk.Entry(width_chars=8, activates_default=True, text=argument["value"] or "")
    if known is not None:
        entry.set_placeholder_text(digits(known, takes["step"]))
    state = {"typing": False}

    def on_slide(slider):
        if not state["typing"]:
            entry.set_text(digits(slider.get_value(), takes["step"]))

    def on_type(entry):
        found = number(entry.get_text())
        if found is None:
            return
        set_value(entry.get_text().strip().replace(",", "."))
        state["typing"] = True
        slider.set_value(found)
        state["typing"] = False

    slider.connect("value-changed", on_slide)
    entry.connect("changed", on_type)
    return [slider, entry]


def title(variant):
    """A line of the list of variants."""
    if variant["word"] is None:
        return " and ".join(argument["name"] for argument in variant["arguments"])
    return ": ".join(filter(None, [variant["word"], variant["summary"].replace("`", "")]))
