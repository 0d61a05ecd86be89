"""Diagnostics with their strings and objects.

On terminals okoshi points with carets at lines of the SVG file. Inkscape shows the string and its object instead: objects are
selected, and Edit → Find finds them, by their ids.
"""

import json
from xml.parsers import expat

# More would not be read in a window.
MAX_FINDINGS = 50
SEVERITIES = ("error", "warning", "hint")
# Elements that Inkscape selects as part of their parent.
INNER = ("tspan", "textPath", "desc", "title", "flowPara", "flowSpan", "flowDiv", "flowRoot")


def read_findings(answer, data):
    """Reads the output of `check --format json` for the SVG text `data`: a list, errors first, or None if it is invalid.

    Each finding is a dictionary with `severity`, `code`, `message`, `label` and `help` as okoshi gives them, and the first
    `MAX_FINDINGS` have `object`, the id of the object, and `string`, both None if there is none.
    """
    try:
        found = [one for drawing in json.loads(answer)["drawings"] for one in drawing["diagnostics"]]
        found.sort(key=lambda one: SEVERITIES.index(one["severity"]))
        objects = Objects(data, [one["start"] for one in found[:MAX_FINDINGS]])
        return [finding(one, objects) for one in found]
    except (ValueError, KeyError, TypeError):
        return None


def finding(one, objects):
    """A diagnostic of okoshi as a finding."""
    read = {name: one[name] for name in ("severity", "code", "message", "label", "help")}
    read["object"], read["string"] = objects.at(one["start"])
    return read


def format_findings(found):
    """Formats findings for a message, with their number in the last line."""
    texts = [format_finding(one) for one in found[:MAX_FINDINGS]]
    if len(found) > MAX_FINDINGS:
        texts.append("… and %d more\n" % (len(found) - MAX_FINDINGS))
    texts.append(count(found))
    return "\n".join(texts)


def format_finding(one):
    """A finding as a few short lines."""
    lines = ["%s[%s]: %s" % (one["severity"], one["code"], one["message"])]
    if one["string"]:
        lines.append("    in the string: %s" % one["string"])
    if one["object"]:
        lines.append("    of the object: %s" % one["object"])
    if one["label"]:
        lines.append("    %s" % one["label"])
    if one["help"]:
        lines.append("    help: %s" % one["help"])
    return "\n".join(lines) + "\n"


def count(found):
    """`1 error, 2 hints`, or nothing."""
    counts = [(sum(one["severity"] == severity for one in found), severity) for severity in SEVERITIES]
    return ", ".join(plural(number, severity) for number, severity in counts if number)


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
        """The id of the object at an offset, and the string there; either may be None."""
        chain = self.found.get(offset, [])
        text = " ".join(chain[-1][2].split()) if chain and chain[-1][0] in INNER + ("text",) else None
        for name, identifier, _ in reversed(chain):
            if name not in INNER:
                return identifier, text
        return None, text
