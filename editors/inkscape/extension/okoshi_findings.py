"""Diagnostics for Inkscape's message window, whose letters are of different widths and whose lines wrap.

What okoshi prints for terminals points with carets at lines of the SVG file. In the window there are the same words, with the
string and the object that it belongs to: Edit → Find finds objects by their ids.
"""

import json
from xml.parsers import expat

# As many as a person reads in a window.
MOST = 50
SEVERITIES = ("error", "warning", "hint")
# What is selected with the element that it is in.
INNER = ("tspan", "textPath", "desc", "title", "flowPara", "flowSpan", "flowDiv", "flowRoot")


def for_window(answer, data):
    """What `check --format json` said of the SVG text `data`, errors first; None if it is no such answer."""
    try:
        found = [one for drawing in json.loads(answer)["drawings"] for one in drawing["diagnostics"]]
        found.sort(key=lambda one: SEVERITIES.index(one["severity"]))
        objects = Objects(data, [one["start"] for one in found[:MOST]])
        texts = [one_finding(one, objects) for one in found[:MOST]]
    except (ValueError, KeyError, TypeError):
        return None
    if len(found) > MOST:
        texts.append("… and %d more\n" % (len(found) - MOST))
    counts = [(sum(one["severity"] == severity for one in found), severity) for severity in SEVERITIES]
    texts.append(", ".join(plural(number, severity) for number, severity in counts if number))
    return "\n".join(texts)


def one_finding(finding, objects):
    """A finding as a few short lines."""
    lines = ["%s[%s]: %s" % (finding["severity"], finding["code"], finding["message"])]
    place, text = objects.at(finding["start"])
    if text:
        lines.append("    in the string: %s" % text)
    if place:
        lines.append("    of the object: %s" % place)
    if finding["label"]:
        lines.append("    %s" % finding["label"])
    if finding["help"]:
        lines.append("    help: %s" % finding["help"])
    return "\n".join(lines) + "\n"


def plural(number, thing):
    """`1 part`, `2 parts`."""
    return "%s %s" % (number, thing if int(number) == 1 else thing + "s")


class Objects:
    """Which object, and which text, stands at some byte offsets of an SVG text."""

    def __init__(self, data, offsets):
        self.found = {}
        # An offset lies in the elements that are open when the parser has passed it.
        waiting = sorted(set(offsets))
        parser = expat.ParserCreate(namespace_separator=" ")
        open_elements = []

        def settle(end):
            while waiting and waiting[0] < end:
                self.found.setdefault(waiting.pop(0), list(open_elements))

        def start(name, attributes):
            settle(parser.CurrentByteIndex)
            open_elements.append([name.rpartition(" ")[2], attributes.get("id"), ""])

        def end(_):
            settle(parser.CurrentByteIndex)
            open_elements.pop()

        def characters(text):
            if open_elements:
                open_elements[-1][2] += text

        parser.StartElementHandler = start
        parser.EndElementHandler = end
        parser.CharacterDataHandler = characters
        try:
            parser.Parse(data, True)
        except expat.ExpatError:
            # Places are left out then; what is wrong is okoshi's to say.
            pass

    def at(self, offset):
        """The id of the object at an offset, and the string there; either may be None or empty."""
        chain = self.found.get(offset, [])
        text = " ".join(chain[-1][2].split()) if chain and chain[-1][0] in INNER + ("text",) else ""
        for name, identifier, _ in reversed(chain):
            if name not in INNER:
                return identifier, text
        return None, text
