"""The strings of a drawing: what differs between two versions of them, and how a third version takes that over.

Versions are trees of lxml. Strings are what okoshi writes: labels, descriptions, titles and texts. All else of a version stays.
"""

from collections import Counter, namedtuple
from copy import deepcopy
from difflib import SequenceMatcher

from lxml import etree

SVG = "http://www.w3.org/2000/svg"
SERIF = "{http://www.serif.com/}id"
TEXTS = tuple("{%s}%s" % (SVG, name) for name in ("text", "flowRoot", "desc", "title"))
# lxml's default limits are too narrow for drawings with pictures in them; nothing else is read than the text itself.
PARSER = {"huge_tree": True, "resolve_entities": False, "no_network": True}


# A sentence without a full stop on a string, and the id of its object or None.
Told = namedtuple("Told", ("sentence", "object"))


def parse(data):
    """The root of an SVG text. Raises `ValueError` if it is not well-formed."""
    try:
        return etree.fromstring(data, etree.XMLParser(**PARSER))
    except etree.XMLSyntaxError as error:
        raise ValueError(str(error))


def merge(base, theirs, ours):
    """Makes in `ours` the changes of strings that lead from `base` to `theirs`. Returns what was changed, and what could not be.

    Both are lists of `Told`. Where `ours` has changed a string, too, it stays.
    """
    merged = Merge(base, theirs, ours)
    merged.run()
    return merged.taken, merged.kept


def merge_unsure(theirs, ours):
    """The same where nobody knows what `theirs` was made of: `theirs` is right where both say something, and nothing is taken away."""
    merged = Merge(deepcopy(ours), theirs, ours, removes=False)
    merged.run()
    return merged.taken, merged.kept


def write(root):
    """The SVG text of a version."""
    return etree.tostring(root.getroottree(), xml_declaration=True, encoding="UTF-8")


def is_label(name):
    """Whether an attribute is a label, as drawing programs call an object in their lists."""
    return name == "data-name" or name == SERIF or name.rpartition("}")[2] == "label" and name.startswith("{")


def strings(root):
    """The texts, descriptions and titles, without those of texts."""
    return [one for one in root.iter(*TEXTS) if not any(above.tag in TEXTS for above in one.iterancestors())]


def text_of(element):
    """The text of an element, as people read it."""
    return " ".join("".join(element.itertext()).split())


def pairs_of(one, other):
    """The elements of a version with their twins in another one: those with the same id, and others by what they are and where."""
    named = [unique_ids(root) for root in (one, other)]
    twins = {one: other}
    for name, element in named[0].items():
        twin = named[1].get(name)
        if twin is not None and twin.tag == element.tag:
            twins.setdefault(element, twin)
    found = set(twins.values())
    waiting = list(twins)
    while waiting:
        parent = waiting.pop()
        # Texts that say the same first: between them one may be new.
        for tell in (wording, signature):
            loose = [child for child in elements(parent) if child not in twins]
            others = [child for child in elements(twins[parent]) if child not in found]
            matcher = SequenceMatcher(None, [tell(child) for child in loose], [tell(child) for child in others], autojunk=False)
            for first, second, length in matcher.get_matching_blocks():
                for child, twin in zip(loose[first : first + length], others[second : second + length]):
                    # Inkscape gives an id to what has none when it opens a drawing; it gives no other one.
                    if not (child.get("id") and twin.get("id")):
                        twins[child] = twin
                        found.add(twin)
                        waiting.append(child)
    return twins


def elements(parent):
    """The child elements, without comments and the like."""
    return [child for child in parent if isinstance(child.tag, str)]


def unique_ids(root):
    """The elements by their ids, without ids that occur more than once."""
    named = [element for element in root.iter(etree.Element) if element.get("id")]
    times = Counter(element.get("id") for element in named)
    return {element.get("id"): element for element in named if times[element.get("id")] == 1}


def signature(element):
    """What tells an element from its neighbours, apart from its id and its strings."""
    kept = [(name, value) for name, value in element.attrib.items() if name != "id" and not is_label(name)]
    return element.tag, tuple(sorted(kept))


def wording(element):
    """The same, and what a text says."""
    return signature(element), text_of(element) if element.tag in TEXTS else None


class Merge:
    """Takes the differences between two versions over into a third."""

    def __init__(self, base, theirs, ours, removes=True):
        self.base, self.theirs = base, theirs
        self.removes = removes
        self.in_theirs = pairs_of(base, theirs)
        self.in_ours = pairs_of(base, ours)
        self.taken, self.kept = [], []

    def run(self):
        in_base = {theirs: base for base, theirs in self.in_theirs.items()}
        for base in list(self.in_theirs):
            self.labels(base)
        for base in strings(self.base):
            self.text(base)
        for theirs in strings(self.theirs):
            if theirs not in in_base:
                self.insert(theirs, in_base)

    def labels(self, base):
        """Takes over what became of the labels of an element."""
        theirs = self.in_theirs[base]
        for name in sorted(set(filter(is_label, list(base.attrib) + list(theirs.attrib)))):
            before, after = base.attrib.get(name), theirs.attrib.get(name)
            if before == after:
                continue
            ours = self.in_ours.get(base)
            place = Place("the label of %s", ours if ours is not None else base)
            if ours is None:
                self.gone(place, after)
            elif self.wanted(place, before, after, ours.attrib.get(name)):
                if after is None:
                    del ours.attrib[name]
                else:
                    ours.attrib[name] = after

    def text(self, base):
        """Takes over what became of a text, description or title."""
        theirs, ours = self.in_theirs.get(base), self.in_ours.get(base)
        before, after = text_of(base), None if theirs is None else text_of(theirs)
        if before == after:
            return
        place = place_of(base if ours is None else ours)
        if ours is None:
            if after is not None:
                self.gone(place, after)
        elif self.wanted(place, before, after, text_of(ours)):
            if theirs is None:
                remove(ours)
            else:
                rewrite(ours, theirs)

    def insert(self, theirs, in_base):
        """Takes over a text, description or title that is new."""
        parent = in_base.get(theirs.getparent())
        ours = self.in_ours.get(parent) if parent is not None else None
        said = text_of(theirs)
        if ours is None:
            self.gone(place_of(theirs), said)
            return
        alike = [child for child in elements(ours) if child.tag == theirs.tag]
        if any(text_of(child) == said for child in alike):
            return
        if alike and not theirs.tag.endswith("}text"):
            # An element has one description.
            if self.wanted(place_of(alike[0]), None, said, text_of(alike[0])):
                rewrite(alike[0], theirs)
            return
        copy = copy_of(theirs)
        copy.tail = None
        before = theirs.getprevious()
        while before is not None and self.in_ours.get(in_base.get(before)) is None:
            before = before.getprevious()
        before = self.in_ours[in_base[before]] if before is not None else None
        if before is not None and before.getparent() is ours:
            copy.tail, before.tail = before.tail, None
            before.addnext(copy)
        else:
            ours.insert(0, copy)
        self.taken.append(told(place_of(copy), None, said))

    def wanted(self, place, before, after, ours):
        """Whether ours is to become `after`, which was `before`. Notes that it is, or why not."""
        if ours == after or (after is None and not self.removes):
            return False
        if ours == before:
            self.taken.append(told(place, before, after))
            return True
        now = "is not there any more" if ours is None else "is `%s` here: it stays so" % ours
        self.kept.append(place.told("%s, and %s" % (became(after), now)))
        return False

    def gone(self, place, after):
        """Notes that the place of a change is not there any more."""
        self.kept.append(place.told("%s, but its object is not in the drawing any more" % became(after)))


class Place:
    """Where a string is: a phrase with the name of an element in it, and the element."""

    def __init__(self, phrase, element):
        self.phrase = phrase % called(element)
        self.object = element.get("id")

    def told(self, words):
        """A sentence on it."""
        return Told("%s %s" % (self.phrase, words), self.object)


def became(after):
    """What others made of a string, for a sentence."""
    return "was taken away" if after is None else "became `%s`" % after


def rewrite(ours, theirs):
    """Gives a text the words of another version of it. Lines keep their elements, as far as they are the same ones."""
    pairs = pairs_of(ours, theirs)
    if len(pairs) == len(list(ours.iter(etree.Element))) == len(list(theirs.iter(etree.Element))):
        for one, other in pairs.items():
            one.text = other.text
            if one is not ours:
                one.tail = other.tail
        return
    for child in list(ours):
        ours.remove(child)
    ours.text = theirs.text
    for child in theirs:
        ours.append(copy_of(child))


def copy_of(element):
    """A copy of an element and of the text behind it, for another tree."""
    copy = deepcopy(element)
    copy.tail = element.tail
    return copy


def remove(element):
    """Removes an element, and leaves the text behind it."""
    parent, before = element.getparent(), element.getprevious()
    if element.tail:
        if before is not None:
            before.tail = (before.tail or "") + element.tail
        else:
            parent.text = (parent.text or "") + element.tail
    parent.remove(element)


def told(place, before, after):
    """What was changed, as a sentence without a full stop."""
    was = ", which was `%s`," % before if before else ""
    now = "was taken away" if after is None else "is `%s`" % after
    return Told("%s%s %s" % (place.phrase, was, now), place.object)


def place_of(element):
    """A text, description or title, for people."""
    name = element.tag.rpartition("}")[2]
    if name in ("desc", "title"):
        return Place("the description of %s" if name == "desc" else "the title of %s", element.getparent())
    return Place("the text %s", element) if element.get("id") else Place("a %s", element)


def called(element):
    """An element, for people: its id, by which Inkscape finds it."""
    return element.get("id") or element.tag.rpartition("}")[2]
