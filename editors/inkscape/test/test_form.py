"""What is set in the form of a part, and the changes that it makes: python3 -m unittest discover editors/inkscape/test"""

import copy
import unittest

import common  # noqa: F401, for the place of the extension

import okoshi_form as form

NUMBER = {"type": "number", "min": None, "max": None, "low": -90.0, "high": 90.0, "step": 0.5, "start": None}


def argument(name, value=None, start=None, **takes):
    return {"name": name, "summary": "", "takes": takes or dict(NUMBER, start=start), "value": value}


def variant(word, counts, *arguments):
    return {"word": word, "summary": "", "counts": counts, "arguments": list(arguments)}


def field(attribute, variants, value=None, chosen=None, origin="builtin", flags=""):
    switches = [{"letter": letter, "summary": "", "on": False} for letter in flags]
    made = {"attribute": attribute, "summary": "", "manual": "", "value": value, "from": origin, "string": None, "shared": []}
    return dict(made, default="", flags=switches, variants=variants, chosen=chosen)


SHAPE = field(
    "Shape",
    [
        variant("round", [0, 1, 2], argument("a0", start=-90), argument("a1", start=90)),
        variant("cone", [0, 3], argument("z0", start=0), argument("z1", start=7.3), argument("r", start=0.5)),
        variant("model", [1], argument("file", type="file")),
    ],
    "round",
    0,
    "own",
    "scd",
)
COLOR = field("Color", [variant(None, [1], argument("hex", type="hex"))], "1 0.8 0.6", 0, "legend")
OFFSET = field("Offset", [variant(None, [1], argument("d", start=0))])


def part(name="Arm", **more):
    made = {"part": name, "named": True, "node": True, "parent": "Body", "parents": ["Body", "Head"], "fields": copy.deepcopy([COLOR, SHAPE, OFFSET])}
    return dict(made, **more)


class Values(unittest.TestCase):
    """The words of an attribute."""

    def test_as_many_values_are_written_as_the_variant_needs(self):
        rounded, cone, _ = SHAPE["variants"]
        self.assertEqual(form.with_value(rounded, 0, "-60"), ["-60"])
        self.assertEqual(form.with_value(rounded, 1, "60"), ["-90", "60"])
        self.assertEqual(form.with_value(cone, 0, "3"), ["3", "7.3", "0.5"])

    def test_a_kind_is_chosen_with_the_fewest_values(self):
        self.assertEqual([form.least(one) for one in SHAPE["variants"]], [[], [], None])
        self.assertEqual(form.least(OFFSET["variants"][0]), ["0"])

    def test_flags_and_values_make_the_words(self):
        said = form.saying(SHAPE, 1, ["0", "7", "0.5"], {"d", "c"})
        self.assertEqual((said["value"], said["from"], said["chosen"]), ("-cd cone 0 7 0.5", "own", 1))
        self.assertEqual(form.flags_of(said), {"c", "d"})
        self.assertEqual(form.values_of(said["variants"][1]), ["0", "7", "0.5"])
        self.assertEqual(form.values_of(said["variants"][0]), [])
        self.assertEqual(form.saying(OFFSET, 0, ["3.5"], set())["value"], "3.5")
        silent = form.silent(said)
        self.assertEqual((silent["value"], silent["from"], silent["chosen"], form.flags_of(silent)), (None, "builtin", None, set()))

    def test_numbers_have_the_digits_of_their_slider(self):
        for number, step, text in ((0.125, 0.5, "0.1"), (7.25, 0.005, "7.25"), (-0.01, 1, "0"), (40, 1, "40"), (1e-9, 1e-9, "0")):
            self.assertEqual(form.digits(number, step), text)

    def test_numbers_are_read_as_people_type_them(self):
        self.assertEqual([form.number(text) for text in (" 3.5 ", "3,5", "", "x", "inf", "1e2")], [3.5, 3.5, None, None, None, 100.0])

    def test_texts_are_quoted_where_they_must_be(self):
        self.assertEqual([form.quoted(text, False) for text in ("Arm", "L arm", "9", " ", 'a"b', "Öhr.2")], ["Arm", '"L arm"', '"9"', None, None, "Öhr.2"])
        self.assertEqual(form.quoted("kick.bvh", True), '"kick.bvh"')
        self.assertEqual([form.unquoted(word) for word in ('"a b"', "a", '"')], ["a b", "a", '"'])

    def test_colours_are_read_and_written(self):
        self.assertEqual(form.rgba("1 0.5 0"), (1.0, 0.5, 0.0, 1.0))
        self.assertEqual(form.rgba("1 0.5 0 0.25"), (1.0, 0.5, 0.0, 0.25))
        self.assertEqual(form.rgba("#ff0000"), (1.0, 0.0, 0.0, 1.0))
        self.assertEqual(form.rgba("#ff000033"), (1.0, 0.0, 0.0, 0.2))
        self.assertEqual(form.rgba("#f00"), (1.0, 0.0, 0.0, 1.0))
        self.assertEqual([form.rgba(text) for text in ("red", "#ff", "a b c", "")], [None] * 4)
        self.assertEqual(form.hexadecimal((1.0, 0.5, 0.0, 1.0)), "#ff8000")
        self.assertEqual(form.hexadecimal((1.0, 0.5, -1.0, 0.2)), "#ff800033")
        self.assertTrue(form.is_color(COLOR))
        self.assertFalse(form.is_color(SHAPE))

    def test_lists_of_names_end_where_nobody_reads_on(self):
        self.assertEqual(form.listed(["a", "b"]), "a, b")
        self.assertEqual(form.listed(list("abcdefgh")), "a, b, c, d, e, f and 2 more")


class Changes(unittest.TestCase):
    """The changes of a drawing."""

    def test_a_form_in_which_nothing_is_set_changes_nothing(self):
        self.assertEqual(form.Draft([part()]).changes(), [])

    def test_what_is_set_and_the_name_last(self):
        draft = form.Draft([part()])
        draft.name, draft.parent = " Paw ", None
        draft.say(form.saying(draft.fields["Shape"], 0, ["-60", "60"], set()))
        draft.say(form.worded(draft.fields["Color"], "#ff0000"))
        expected = [
            {"change": "set", "part": "Arm", "attribute": "Color", "value": "#ff0000"},
            {"change": "set", "part": "Arm", "attribute": "Shape", "value": "round -60 60"},
            {"change": "hang", "part": "Arm", "parent": None},
            {"change": "name", "part": "Arm", "name": "Paw"},
        ]
        self.assertEqual(draft.changes(), expected)
        draft.left_out = True
        self.assertIn({"change": "leave-out", "part": "Arm"}, draft.changes())

    def test_what_is_set_back_changes_nothing(self):
        draft = form.Draft([part()])
        draft.say(form.saying(draft.fields["Shape"], 1, [], set()))
        draft.say(form.saying(draft.fields["Shape"], 0, [], set()))
        draft.name = "Arm"
        self.assertEqual(draft.changes(), [])

    def test_only_what_the_part_itself_says_can_be_taken_away(self):
        draft = form.Draft([part()])
        for attribute in ("Shape", "Color", "Offset"):
            draft.say(form.silent(draft.fields[attribute]))
        self.assertEqual(draft.changes(), [{"change": "reset", "part": "Arm", "attribute": "Shape"}])

    def test_a_part_without_a_name_keeps_that_until_one_is_typed(self):
        draft = form.Draft([part("U-1", named=False)])
        self.assertEqual((draft.name, draft.changes()), ("", []))
        draft.name = "Arm"
        self.assertEqual(draft.changes(), [{"change": "name", "part": "U-1", "name": "Arm"}])
        # The automatic name, as one that is to stay.
        draft.name = "U-1"
        self.assertEqual(draft.changes(), [{"change": "name", "part": "U-1", "name": "U-1"}])

    def test_a_piece_of_a_part_has_neither_name_nor_parent(self):
        draft = form.Draft([part(node=False, parent=None, parents=[])])
        draft.name, draft.parent = "Paw", "Body"
        self.assertEqual((draft.has_name, draft.parents, draft.changes()), (False, None, []))

    def test_several_parts_get_the_same_and_keep_their_names(self):
        leg = part("Leg", parent="Head", parents=["Body", "Tail"])
        leg["fields"][1] = form.silent(leg["fields"][1])
        draft = form.Draft([part(), leg])
        self.assertEqual((draft.parts, draft.has_name, draft.parents), (["Arm", "Leg"], False, ["Body", "Head"]))
        draft.name = "Paw"
        draft.say(form.saying(draft.fields["Offset"], 0, ["3"], set()))
        draft.say(form.silent(draft.fields["Shape"]))
        expected = [{"change": "reset", "part": "Arm", "attribute": "Shape"}]
        expected += [{"change": "set", "part": part, "attribute": "Offset", "value": "3"} for part in ("Arm", "Leg")]
        self.assertEqual(draft.changes(), expected)

    def test_what_was_refused_is_replaced_by_what_was_chosen(self):
        draft = form.Draft([part()])
        draft.say(form.worded(draft.fields["Color"], "red"))
        (change,) = draft.changes()
        instead = dict(change, place="legend")
        # As okoshi writes it.
        draft.choose(dict(change, place="ask"), instead)
        self.assertEqual(draft.changes(), [instead])
        other = dict(change, part="Leg", place="ask")
        draft.choose(instead, other)
        self.assertEqual(draft.changes(), [other])
        third = {"change": "variable", "name": "w", "value": 3.0}
        draft.choose(other, third)
        self.assertEqual(draft.changes(), [third])
        # Something else was not refused.
        draft.say(form.worded(draft.fields["Color"], "blue"))
        self.assertEqual(draft.changes(), [dict(change, value="blue")])


if __name__ == "__main__":
    unittest.main()
