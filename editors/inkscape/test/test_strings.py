"""Strings of one version of a drawing that are taken over into another one: python3 -m unittest discover editors/inkscape/test

Takes lxml, which comes with Inkscape; skipped without.
"""

import unittest

import common  # noqa: F401, for the place of the extension

try:
    from lxml import etree
except ImportError:
    etree = None
else:
    from okoshi_strings import merge, merge_unsure, parse

SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
    'xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd" id="svg">%s</svg>'
)
DRAWN = (
    '<g id="g"><path id="arm" inkscape:label="Arm" d="M 0,0"/>\n<path id="leg" d="M 1,1"><desc id="d">Leg@Body</desc></path></g>'
    '<text id="t" x="1"><tspan id="s1" sodipodi:role="line">Body</tspan><tspan id="s2" sodipodi:role="line">$Shape flat</tspan></text>'
)


@unittest.skipIf(etree is None, "lxml is not installed")
class Strings(unittest.TestCase):
    def merged(self, theirs, ours, base=DRAWN):
        """The third version after the merge, what was taken over, and what was not."""
        trees = [parse((SVG % text).encode("utf-8")) for text in (base, theirs, ours)]
        taken, kept = merge(*trees)
        sentences = ([one.sentence for one in told] for told in (taken, kept))
        return (etree.tostring(trees[2], encoding="unicode"), *sentences)

    def check(self, theirs, ours, expected, taken, kept=()):
        """Merges, and compares the result with an expected version."""
        text, *said = self.merged(theirs, ours)
        self.assertEqual(text, etree.tostring(parse((SVG % expected).encode("utf-8")), encoding="unicode"))
        self.assertEqual(said, [list(taken), list(kept)])

    def changed(self, *replacements):
        """The drawing with some texts replaced, each of which must be there."""
        text = DRAWN
        for old, new in replacements:
            self.assertIn(old, text)
            text = text.replace(old, new)
        return text

    def test_what_differs_in_no_string_is_ours(self):
        moved = self.changed(("M 0,0", "M 7,7"), ('<g id="g">', '<g id="g" transform="scale(2)">'))
        self.check(moved, DRAWN, DRAWN, [])
        self.check(DRAWN, moved, moved, [])

    def test_labels_are_changed_given_and_taken_away(self):
        theirs = self.changed(('label="Arm"', 'label="Hand"'))
        self.check(theirs, DRAWN, theirs, ["the label of arm, which was `Arm`, is `Hand`"])
        theirs = self.changed(("M 1,1", 'M 1,1" data-name="Shin'))
        self.check(theirs, DRAWN, theirs, ["the label of leg is `Shin`"])
        theirs = self.changed((' inkscape:label="Arm"', ""))
        self.check(theirs, DRAWN, theirs, ["the label of arm, which was `Arm`, was taken away"])

    def test_what_was_drawn_meanwhile_stays(self):
        theirs = self.changed(("Leg@Body", "Leg@Body$Color red"))
        # Moved, put into a group of its own, and with something new in front.
        ours = DRAWN.replace('<path id="leg" d="M 1,1">', '<rect id="new"/><g id="around"><path id="leg" d="M 9,9">')
        ours = ours.replace("</desc></path>", "</desc></path></g>")
        expected = ours.replace("Leg@Body", "Leg@Body$Color red")
        self.check(theirs, ours, expected, ["the description of leg, which was `Leg@Body`, is `Leg@Body$Color red`"])

    def test_lines_of_texts_keep_their_elements(self):
        theirs = self.changed(("$Shape flat", "$Shape roundv"))
        ours = self.changed(('x="1"', 'x="5"'))
        expected = ours.replace("$Shape flat", "$Shape roundv")
        self.check(theirs, ours, expected, ["the text t, which was `Body$Shape flat`, is `Body$Shape roundv`"])

    def test_a_text_with_other_lines_gets_those(self):
        theirs = self.changed(('<tspan id="s2" sodipodi:role="line">$Shape flat</tspan>', ""))
        self.check(theirs, DRAWN, theirs, ["the text t, which was `Body$Shape flat`, is `Body`"])

    def test_new_strings_come_to_their_places(self):
        new = '<text id="new">Tail</text>'
        theirs = self.changed(("<text", new + "<text"), ('label="Arm" d="M 0,0"/>', 'label="Arm" d="M 0,0"><desc>Arm@Body</desc></path>'))
        ours = self.changed(("</g>", '</g><rect id="r"/>'))
        expected = theirs.replace(new, new + '<rect id="r"/>')
        self.check(theirs, ours, expected, ["the description of arm is `Arm@Body`", "the text new is `Tail`"])
        # Taken over once.
        self.check(theirs, expected, expected, [])

    def test_strings_that_were_taken_away(self):
        theirs = self.changed(('<desc id="d">Leg@Body</desc>', ""))
        self.check(theirs, DRAWN, theirs, ["the description of leg, which was `Leg@Body`, was taken away"])

    def test_where_both_have_changed_a_string_ours_stays_and_theirs_is_told(self):
        theirs = self.changed(('label="Arm"', 'label="Hand"'), ("Leg@Body", "Leg@Hips"))
        ours = self.changed(('label="Arm"', 'label="Paw"'), ("Leg@Body", "Shin"))
        kept = [
            "the label of arm became `Hand`, and is `Paw` here: it stays so",
            "the description of leg became `Leg@Hips`, and is `Shin` here: it stays so",
        ]
        self.check(theirs, ours, ours, [], kept)
        # The same change twice is none.
        self.check(theirs, theirs, theirs, [])

    def test_changes_of_what_is_gone_are_told(self):
        theirs = self.changed(('label="Arm"', 'label="Hand"'), ("Leg@Body", "Leg@Hips"))
        ours = DRAWN[DRAWN.index("<text") :]
        kept = [
            "the label of arm became `Hand`, but its object is not in the drawing any more",
            "the description of leg became `Leg@Hips`, but its object is not in the drawing any more",
        ]
        self.check(theirs, ours, ours, [], kept)

    def test_elements_without_ids_are_told_by_what_they_are(self):
        base = '<path d="M 0,0"/><path d="M 1,1"/><text>Arm</text>'
        theirs = '<path d="M 0,0"/><path d="M 1,1" data-name="Leg"/><text>Hand</text>'
        # As Inkscape opens it.
        ours = '<path d="M 0,0" id="path1"/><path d="M 1,1" id="path2"/><text id="text3">Arm</text>'
        text, taken, kept = self.merged(theirs, ours, base)
        expected = '<path d="M 0,0" id="path1"/><path d="M 1,1" id="path2" data-name="Leg"/><text id="text3">Hand</text>'
        self.assertEqual(text, SVG % expected)
        self.assertEqual((len(taken), kept), (2, []))

    def test_a_new_text_among_texts_without_ids(self):
        texts = "<text>Arm</text><text>Leg</text>"
        ours = '<text id="a">Arm</text><text id="l">Leg</text>'
        text, taken, kept = self.merged("<text>Tail</text>" + texts, ours, texts)
        self.assertEqual((text, taken, kept), (SVG % ("<text>Tail</text>" + ours), ["a text is `Tail`"], []))

    def test_what_was_drawn_in_place_of_something_else_is_not_taken_for_that(self):
        gone = ["a text became `Hand`, but its object is not in the drawing any more"]
        other = '<text id="x">Leg</text>'
        self.assertEqual(self.merged("<text>Hand</text>" + other, other, "<text>Arm</text>" + other)[1:], ([], gone))
        new = '<text id="new">Arm</text>'
        gone = ["the text t became `Hand`, but its object is not in the drawing any more"]
        self.assertEqual(self.merged('<text id="t">Hand</text>', new, '<text id="t">Arm</text>'), (SVG % new, [], gone))

    def test_without_a_base_theirs_is_right_and_nothing_is_taken_away(self):
        theirs = self.changed(('label="Arm"', 'label="Hand"'), ('<desc id="d">Leg@Body</desc>', ""), ("<text", "<text>Tail</text><text"))
        ours = self.changed(("M 1,1", 'M 1,1" inkscape:label="Shin'))
        roots = [parse((SVG % text).encode("utf-8")) for text in (theirs, ours)]
        taken, kept = merge_unsure(*roots)
        expected = ours.replace('label="Arm"', 'label="Hand"').replace("<text", "<text>Tail</text><text")
        self.assertEqual(etree.tostring(roots[1], encoding="unicode"), etree.tostring(parse((SVG % expected).encode()), encoding="unicode"))
        self.assertEqual([one.sentence for one in taken], ["the label of arm, which was `Arm`, is `Hand`", "a text is `Tail`"])
        self.assertEqual((taken[0].object, kept), ("arm", []))

    def test_what_is_no_xml_is_told(self):
        self.assertRaises(ValueError, parse, b"<svg")


if __name__ == "__main__":
    unittest.main()
