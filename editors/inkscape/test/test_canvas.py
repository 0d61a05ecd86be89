"""What the page changes in the copy of the canvas, and how it comes into the document: python3 -m unittest discover editors/inkscape/test

Takes lxml, which comes with Inkscape; skipped without.
"""

import os
import unittest
from unittest import mock

from common import SVG, Folder

import okoshi_cache
import okoshi_canvas
import okoshi_drawing
import okoshi_follow

try:
    from okoshi_strings import parse, write
except ImportError:
    parse = None

ARM, LEG = '<path id="arm" data-name="%s"/>', '<path id="leg" data-name="%s"/>'


def canvas(arm="Arm", leg="Leg", more=""):
    """A drawing with two labels."""
    return (SVG % (ARM % arm + LEG % leg + more)).encode("utf-8")


@unittest.skipIf(parse is None, "lxml is not installed")
class Case(Folder):
    def setUp(self):
        super().setUp()
        environ = mock.patch.dict(os.environ, dict.fromkeys(("XDG_CACHE_HOME", "LOCALAPPDATA", "HOME"), os.path.join(self.folder, "cache")))
        environ.start()
        self.addCleanup(environ.stop)
        self.copy = os.path.join(self.folder, "Mensch.svg")

    def put(self, path, data):
        with open(path, "wb") as file:
            file.write(data)

    def same(self, data, expected):
        """Compares drawings, whatever they are written like."""
        self.assertEqual(write(parse(data)), write(parse(expected)))

    def sentences(self, told):
        return [[one.sentence for one in some] for some in told]


class Copies(Case):
    def renew(self, data):
        okoshi_canvas.renew(self.folder, self.copy, data)

    def take(self, data):
        """What the document has then, and what was told."""
        root = parse(data)
        told = okoshi_canvas.take(self.folder, self.copy, data, root)
        return write(root), self.sentences(told)

    def test_without_changes_the_copy_is_the_canvas(self):
        for data in (canvas(), canvas("Paw"), b"<svg"):
            self.renew(data)
            self.assertEqual(okoshi_cache.read(self.copy), data)
            self.assertIsNone(okoshi_canvas.changed(self.folder, self.copy))

    def test_the_pages_changes_come_into_the_document_once(self):
        self.renew(canvas())
        self.put(self.copy, canvas("Hand"))
        moved = canvas(leg="Shin", more='<rect id="new"/>')
        text, told = self.take(moved)
        self.same(text, canvas("Hand", "Shin", '<rect id="new"/>'))
        self.assertEqual(told, [["the label of arm, which was `Arm`, is `Hand`"], []])
        self.same(okoshi_cache.read(self.copy), text)
        self.assertIsNone(okoshi_canvas.changed(self.folder, self.copy))
        # Inkscape's undo takes them back, and they do not come again.
        self.assertEqual(self.take(moved)[1], [[], []])

    def test_a_save_keeps_the_pages_changes(self):
        self.renew(canvas())
        self.put(self.copy, canvas("Hand"))
        self.renew(canvas(leg="Shin"))
        self.same(okoshi_cache.read(self.copy), canvas("Hand", "Shin"))
        text, told = self.take(canvas(leg="Shin"))
        self.same(text, canvas("Hand", "Shin"))
        self.assertEqual(told, [["the label of arm, which was `Arm`, is `Hand`"], []])

    def test_a_change_that_a_save_contradicts_is_told_once(self):
        self.renew(canvas())
        self.put(self.copy, canvas("Hand"))
        self.renew(canvas("Paw"))
        self.assertEqual(okoshi_cache.read(self.copy), canvas("Paw"))
        kept = ["the label of arm became `Hand`, and is `Paw` here: it stays so"]
        self.assertEqual(self.take(canvas("Paw"))[1], [[], kept])
        self.assertEqual(self.take(canvas("Paw"))[1], [[], []])

    def test_what_the_page_changes_meanwhile_is_not_lost(self):
        self.renew(canvas())
        self.put(self.copy, canvas("Hand"))
        merged, times = okoshi_canvas.merged, []

        def slow(page, data):
            if not times:
                self.put(self.copy, canvas("Hand", "Foot"))
            times.append(page)
            return merged(page, data)

        with mock.patch.object(okoshi_canvas, "merged", slow):
            self.renew(canvas(more='<rect id="new"/>'))
            self.same(okoshi_cache.read(self.copy), canvas("Hand", "Foot", '<rect id="new"/>'))
            del times[:]
            self.put(self.copy, canvas("Hand", more='<rect id="new"/>'))
            text, _ = self.take(canvas(more='<rect id="new"/>'))
        text, told = self.take(text)
        self.same(text, canvas("Hand", "Foot", '<rect id="new"/>'))
        self.assertEqual(told, [["the label of leg, which was `Leg`, is `Foot`"], []])

    def test_what_is_half_written_is_left_out(self):
        self.renew(canvas())
        self.put(self.copy, canvas("Hand"))
        self.assertRaises(ValueError, self.renew, b"<svg")
        self.assertEqual(okoshi_cache.read(self.copy), canvas("Hand"))

    def test_saves_are_followed_once_they_have_settled(self):
        original = os.path.join(self.folder, "saved.svg")
        self.put(original, canvas())
        self.renew(canvas("Unsaved"))
        follower = okoshi_follow.Follower(self.folder, self.copy, original)
        follower.look()
        self.assertEqual(okoshi_cache.read(self.copy), canvas("Unsaved"))
        self.put(original, canvas("Saved")[:40])
        follower.look()
        self.put(original, canvas("Saved"))
        follower.look()
        self.assertEqual(okoshi_cache.read(self.copy), canvas("Unsaved"))
        follower.look()
        self.assertEqual(okoshi_cache.read(self.copy), canvas("Saved"))


class Saved(Case):
    """Another program changes the drawing's file."""

    def setUp(self):
        super().setUp()
        self.original = os.path.join(self.folder, "original.svg")
        for path in (self.original, self.copy):
            self.put(path, canvas())

    def remember(self, data):
        self.put(self.copy, data)
        okoshi_canvas.remember(okoshi_drawing.Drawing(self.copy, self.original))

    def take(self, data):
        drawing = okoshi_drawing.Drawing(self.copy, self.original)
        folder = okoshi_cache.folder_of(drawing)
        os.makedirs(folder, exist_ok=True)
        root = parse(data)
        told = okoshi_canvas.take_saved(folder, self.original, root)
        return write(root), self.sentences(told)

    def test_what_the_file_said_when_inkscape_had_it_is_no_change(self):
        self.remember(canvas())
        text, told = self.take(canvas("Paw"))
        self.same(text, canvas("Paw"))
        self.assertEqual(told, [[], []])
        self.put(self.original, canvas(leg="Foot"))
        text, told = self.take(canvas("Paw"))
        self.same(text, canvas("Paw", "Foot"))
        self.assertEqual(told, [["the label of leg, which was `Leg`, is `Foot`"], []])
        # Undone in Inkscape.
        self.assertEqual(self.take(canvas("Paw"))[1], [[], []])

    def test_where_nobody_knows_the_file_is_right(self):
        # What Inkscape has not saved says something else than the file.
        self.remember(canvas("Paw"))
        text, told = self.take(canvas("Paw", more='<text id="t">Tail</text>'))
        self.same(text, canvas(more='<text id="t">Tail</text>'))
        self.assertEqual(told, [["the label of arm, which was `Paw`, is `Arm`"], []])
        self.assertEqual(self.take(canvas("Paw"))[1], [[], []])

    def test_another_inkscape_has_read_the_file_anew(self):
        self.remember(canvas())
        self.put(self.original, canvas("Hand"))
        with mock.patch("os.getppid", lambda: 1):
            self.assertEqual(self.take(canvas("Paw"))[1], [["the label of arm, which was `Paw`, is `Hand`"], []])

    def test_packed_and_missing_files_say_nothing(self):
        self.put(self.original, b"\x1f\x8b")
        self.assertEqual(self.take(canvas())[1], [[], []])
        os.remove(self.original)
        self.assertEqual(self.take(canvas())[1], [[], []])


if __name__ == "__main__":
    unittest.main()
