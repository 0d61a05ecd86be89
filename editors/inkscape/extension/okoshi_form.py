"""What a person sets in the form of a part, and the changes of the drawing that this makes.

Forms are those of `okoshi inspect --form`, changes those of `okoshi edit`; the preview's page builds its form in the same way.
"""

import math
import os
import re

# The drawing as a window has changed it. In a folder of its own, so that no drawing has this name.
EDITED = os.path.join("edited", "edited.svg")
# How the window's process ends without having changed anything: the person did not, or there is no GTK 3 or no screen.
UNCHANGED, NO_WINDOW = 3, 4
# Attributes that are shown without being asked for.
FIRST = ("Color", "Shape", "Offset")
WORD = re.compile(r"^[^\W\d][\w.]*$")


class Draft:
    """A form with what was set in it. Several parts get the same attributes; the first one's are shown."""

    def __init__(self, forms):
        self.forms = forms
        self.form = forms[0]
        self.name = self.form["part"] if self.form["named"] else ""
        self.parent = self.form["parent"]
        self.left_out = False
        self.fields = {field["attribute"]: field for field in self.form["fields"]}
        # What was chosen instead of changes that were refused, by those.
        self.instead = []

    @property
    def parts(self):
        """The names of the parts."""
        return [form["part"] for form in self.forms]

    @property
    def has_name(self):
        """Whether a name can be typed: only one part can have it."""
        return len(self.forms) == 1 and self.form["node"]

    @property
    def parents(self):
        """What all parts could hang on; None if some cannot hang on anything."""
        if not all(form["node"] for form in self.forms):
            return None
        others = [set(form["parents"]) | {form["parent"]} for form in self.forms]
        return [name for name in self.form["parents"] if all(name in names for names in others)]

    def say(self, field):
        """Sets an attribute to what another version of its field says."""
        self.fields[field["attribute"]] = field

    def choose(self, refused, choice):
        """Makes another change instead of one that was refused."""
        self.instead.append((plain(refused), choice))

    def changes(self):
        """The changes of the drawing, in the order in which they are made: the name comes last, as the others speak of the part by the old one."""
        made = []
        for form in self.forms:
            made += [one for field in form["fields"] for one in self.of_field(form, field)]
        parents = self.parents
        if parents is not None and self.parent != self.form["parent"]:
            made += [{"change": "hang", "part": part, "parent": self.parent} for part in self.parts]
        if self.left_out:
            made += [{"change": "leave-out", "part": part} for part in self.parts]
        name = self.name.strip()
        if self.has_name and name and not (self.form["named"] and name == self.form["part"]):
            made.append({"change": "name", "part": self.form["part"], "name": name})
        return [self.replaced(change) for change in made]

    def of_field(self, form, field):
        """The change of an attribute of a part, if there is one."""
        shown = next(one for one in self.form["fields"] if one["attribute"] == field["attribute"])
        said = self.fields[field["attribute"]]
        if said is shown or said["value"] == shown["value"] and said["from"] == shown["from"]:
            return
        change = {"part": form["part"], "attribute": field["attribute"]}
        if said["value"] is not None:
            yield dict(change, change="set", value=said["value"])
        elif field["from"] == "own":
            yield dict(change, change="reset")

    def replaced(self, change):
        """A change, or what was chosen instead of it."""
        for refused, choice in self.instead:
            if plain(change) == refused:
                change = choice
        return change


def plain(change):
    """A change without the place that it has if nothing is said of it."""
    return {name: value for name, value in change.items() if (name, value) != ("place", "ask")}


def saying(field, chosen, values, flags):
    """A field that says something: with one of its variants, arguments of that, and flags."""
    variants = [
        dict(one, arguments=[dict(argument, value=at(values, index) if number == chosen else None) for index, argument in enumerate(one["arguments"])])
        for number, one in enumerate(field["variants"])
    ]
    letters = "".join(flag["letter"] for flag in field["flags"] if flag["letter"] in flags)
    word = field["variants"][chosen]["word"] or ""
    value = " ".join(filter(None, ["-" + letters if letters else "", word] + list(values)))
    flagged = [dict(flag, on=flag["letter"] in flags) for flag in field["flags"]]
    return dict(field, value=value, variants=variants, flags=flagged, chosen=chosen, **{"from": "own"})


def silent(field):
    """A field of which the part itself says nothing."""
    variants = [dict(one, arguments=[dict(argument, value=None) for argument in one["arguments"]]) for one in field["variants"]]
    flags = [dict(flag, on=False) for flag in field["flags"]]
    return dict(field, value=None, variants=variants, flags=flags, chosen=None, **{"from": "builtin"})


def worded(field, value):
    """A field whose value is written as a whole."""
    return dict(field, value=value, **{"from": "own"})


def flags_of(field):
    """The letters of the flags that a field has."""
    return {flag["letter"] for flag in field["flags"] if flag["on"]}


def values_of(variant):
    """The values that a variant has, without those that are left out at its end."""
    values = []
    for argument in variant["arguments"]:
        if argument["value"] is None:
            break
        values.append(argument["value"])
    return values


def with_value(variant, index, value):
    """The same with one of them replaced. As many others are written as the variant then needs."""
    before = values_of(variant)
    fewest = max(index + 1, len(before))
    count = min([count for count in variant["counts"] if count >= fewest] or [fewest])
    arguments = variant["arguments"][:count]
    return [value if one == index else at(before, one) or start(argument) for one, argument in enumerate(arguments)]


def least(variant):
    """The fewest values with which a variant can be written; None if one of them must be typed first."""
    count = min(variant["counts"] + [len(variant["arguments"])]) if variant["counts"] else 1
    needed = variant["arguments"][:count]
    if any(argument["takes"]["type"] != "number" for argument in needed):
        return None
    return [start(argument) for argument in needed]


def start(argument):
    """What is written of an argument that nobody has set."""
    takes = argument["takes"]
    if argument["value"] is not None:
        return argument["value"]
    if takes["type"] != "number":
        return ""
    return digits(takes["low"] if takes["start"] is None else takes["start"], takes["step"])


def digits(number, step):
    """A number with as many digits as its slider tells apart."""
    places = min(max(0, math.ceil(-math.log10(step) - 1e-9)), 6)
    text = "%.*f" % (places, number)
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text == "-0" else text


def number(text):
    """The number that a person has typed, or None. A comma is taken for a point."""
    try:
        found = float(text.strip().replace(",", "."))
    except ValueError:
        return None
    return found if math.isfinite(found) else None


def unquoted(word):
    """Text as it is shown: without quotes around it."""
    return word[1:-1] if len(word) > 1 and word.startswith('"') and word.endswith('"') else word


def quoted(text, always):
    """Text as it is written; None if it cannot be."""
    text = text.strip()
    if not text or '"' in text:
        return None
    return '"%s"' % text if always or not WORD.match(text) else text


def at(values, index):
    """A value, or None behind the last one."""
    return values[index] if index < len(values) else None


def listed(names):
    """A list of names that is not longer than it can be read."""
    return ", ".join(names[:6]) + (" and %d more" % (len(names) - 6) if len(names) > 6 else "")


def in_quotes(text):
    """A sentence with quotes for the signs of code in it."""
    return re.sub("`([^`]*)`", "“\\1”", text)


def is_color(field):
    """Whether an attribute is a colour."""
    return any(one["arguments"] and one["arguments"][0]["takes"]["type"] == "hex" for one in field["variants"])


def rgba(value):
    """Red, green, blue and opacity, 0 to 1, of a colour in numbers or in hexadecimal digits; None for a name."""
    words = value.split()
    if len(words) in (3, 4):
        try:
            numbers = [float(word) for word in words]
        except ValueError:
            return None
        return tuple(numbers + [1.0] * (4 - len(numbers)))
    found = re.match(r"^#((?:[0-9a-fA-F]{2}){3,4})$", value) or re.match(r"^#([0-9a-fA-F]{3,4})$", value)
    if found is None:
        return None
    text = found.group(1)
    text = text if len(text) > 4 else "".join(letter * 2 for letter in text)
    numbers = [int(text[place : place + 2], 16) / 255 for place in range(0, len(text), 2)]
    return tuple(numbers + [1.0] * (4 - len(numbers)))


def hexadecimal(color):
    """A colour as `#rrggbb`, with its opacity if it has one."""
    pairs = ["%02x" % round(min(max(one, 0.0), 1.0) * 255) for one in color]
    return "#" + "".join(pairs[:3] if pairs[3:] in ([], ["ff"]) else pairs)
