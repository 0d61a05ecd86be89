"""Formats diagnostics for Inkscape's message window, which has a proportional font and wraps lines.

On terminals okoshi points with carets at lines of the SVG file. The window shows the same text with the string and its object
instead: Edit → Find finds objects by their ids.
"""

import json
from xml.parsers import expat

# More would not be read in a window.
MAX_FINDINGS = 50
SEVERITIES = ("error", "warning", "hint")
# Elements that Inkscape selects as part of their parent.
INNER = ("tspan", "textPath", "desc", "title", "flowPara", "flowSpan", "flowDiv", "flowRoot")


def format_findings(answer, data):
    """Formats the output of `check --format json` for the SVG text `data`, errors first; None if it is invalid."""
    try:
        found = [one for drawing in json.loads(answer)["drawings"] for one in drawing["diagnostics"]]
        found.sort(key=lambda one: SEVERITIES.index(one["severity"]))
        objects = Objects(data, [one["start"] for one in found[:MAX_FINDINGS]])
        texts = [format_finding(one, objects) for one in found[:MAX_FINDINGS]]
    except (ValueError, KeyError, TypeError):
        return None
    if len(found) > MAX_FINDINGS:
        texts.append("… and %d more\n" % (len(found) - MAX_FINDINGS))
    counts = [(sum(one["severity"] == severity for one in found), severity) for severity in SEVERITIES]
    texts.append(", ".join(plural(number, severity) for number, severity in counts if number))
    return "\n".join(texts)


def format_finding(finding, objects):
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
    """The objects and strings at some byte offsets of an SVG text."""

    def __init__(self, data, offsets):
        self.found = {}
        # An offset lies in the elements that are open when the parser passes it.
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
            # Then objects are missing; okoshi reports what is wrong.
            pass

    def at(self, offset):
        """The id of the object at an offset, and the string there; either may be None or empty."""
        chain = self.found.get(offset, [])
        text = " ".join(chain[-1][2].split()) if chain and chain[-1][0] in INNER + ("text",) else ""
        for name, identifier, _ in reversed(chain):
            if name not in INNER:
                return identifier, text
        return None, text
