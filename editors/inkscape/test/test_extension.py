"""The extension without Inkscape: python3 -m unittest discover editors/inkscape/test

What talks to Inkscape itself takes inkex on PYTHONPATH, and is skipped without; `tests/tools/inkscape.sh` has it.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request
import xml.etree.ElementTree as ElementTree
from unittest import mock

from common import EXTENSION, HERE, PATIENCE, SVG, Folder

import okoshi_cache
import okoshi_drawing
import okoshi_findings
import okoshi_follow
import okoshi_previews
import okoshi_program
import okoshi_report

try:
    import inkex
except ImportError:
    inkex = None


@unittest.skipIf(sys.platform == "win32", "programs are told by their endings there")
class Program(Folder):
    def find(self, **environ):
        environ.setdefault("HOME", os.path.join(self.folder, "home"))
        environ.setdefault("PATH", os.path.join(self.folder, "bin"))
        return okoshi_program.find(environ, os.path.join(self.folder, "extension"))

    def test_places_in_their_order(self):
        cargo = self.write("home/.cargo/bin/okoshi", executable=True)
        self.assertEqual(self.find(), cargo)
        on_path = self.write("bin/okoshi", executable=True)
        self.assertEqual(self.find(), on_path)
        installed_path = self.write("elsewhere/okoshi", executable=True)
        self.write("extension/okoshi.path", installed_path + "\n")
        self.assertEqual(self.find(), installed_path)
        named = self.write("named/okoshi", executable=True)
        self.assertEqual(self.find(OKOSHI=named), named)

    def test_a_note_that_is_out_of_date_is_passed_over(self):
        self.write("extension/okoshi.path", os.path.join(self.folder, "gone") + "\n")
        on_path = self.write("bin/okoshi", executable=True)
        self.assertEqual(self.find(), on_path)

    def test_without_a_program_the_way_out_is_said(self):
        self.write("extension/okoshi.path", "/gone/okoshi\n")
        with self.assertRaises(okoshi_program.Missing) as caught:
            self.find()
        for word in ("/gone/okoshi", "the PATH", ".cargo", "pip install", "install.sh --okoshi", "install.ps1 -Okoshi", "OKOSHI"):
            self.assertIn(word, str(caught.exception))

    def test_a_variable_that_names_nothing_is_said_and_not_passed_over(self):
        self.write("bin/okoshi", executable=True)
        with self.assertRaises(okoshi_program.Missing) as caught:
            self.find(OKOSHI="/gone/okoshi")
        self.assertIn("OKOSHI is set to `/gone/okoshi`", str(caught.exception))

    def test_what_cannot_be_started_is_said(self):
        with self.assertRaises(okoshi_program.Missing) as caught:
            okoshi_program.call([self.write("okoshi", "no program", executable=True)])
        self.assertIn("cannot be started", str(caught.exception))

    def test_okoshi_gets_no_environment_of_inkscapes_python(self):
        with mock.patch.dict(os.environ, {"PYTHONPATH": "x", "INKEX_GETTEXT_DOMAIN": "y", "KEPT": "z"}):
            environment = okoshi_program.environment()
        self.assertEqual((environment.get("PYTHONPATH"), environment.get("INKEX_GETTEXT_DOMAIN")), (None, None))
        self.assertEqual(environment["KEPT"], "z")


class Links(Folder):
    """`away` is where Inkscape's copy lies, `root` where the drawing does."""

    def setUp(self):
        super().setUp()
        self.root = os.path.join(self.folder, "mein Bild")
        self.away = os.path.join(self.folder, "tmp")
        os.mkdir(self.root)
        os.mkdir(self.away)

    def home(self, link):
        return okoshi_drawing.relocated_link(link, self.away, self.root)

    def test_links_from_the_copy_lead_home(self):
        self.write("mein Bild/gull.png")
        self.assertEqual(self.home("../mein%20Bild/gull.png"), "gull.png")
        self.write("mein Bild/sub/ä & b.png")
        self.assertEqual(self.home("../mein%20Bild/sub/%C3%A4%20&%20b.png"), "sub/%C3%A4%20%26%20b.png")

    def test_missing_files_keep_the_name_that_the_person_knows(self):
        self.assertEqual(self.home("../mein%20Bild/gone.png"), "gone.png")
        self.assertIsNone(self.home("gone.png"))

    def test_what_holds_at_home_stays(self):
        self.write("mein Bild/gull.png")
        self.write("tmp/gull.png")
        self.assertIsNone(self.home("gull.png"))

    def test_what_lies_elsewhere_is_named_from_home(self):
        self.write("other/gull.png")
        os.mkdir(os.path.join(self.away, "deep"))
        link = okoshi_drawing.relocated_link("../../other/gull.png", os.path.join(self.away, "deep"), self.root)
        self.assertEqual(link, "../other/gull.png")

    def test_what_is_no_file_stays(self):
        for link in ("data:image/png;base64,AAAA", "https://example.org/a.png", "#id", "", "//host/a.png", "/abs.png"):
            self.assertIsNone(self.home(link), link)

    def test_only_the_links_of_images_are_touched_and_nothing_else_in_the_text(self):
        self.write("mein Bild/a&b.png")
        link = "../mein%20Bild/a&amp;b.png"
        inside = "<image id='i'\n   xlink:href = '%s' x=\"1\"/><a xlink:href=\"%s\"/><text>&lt;image href=\"%s\"</text>\n"
        text = (SVG % (inside % (link, link, link))).encode("utf-8")
        expected = (SVG % (inside.replace("'%s'", '"a%%26b.png"', 1) % (link, link))).encode("utf-8")
        self.assertEqual(okoshi_drawing.relocate_links(text, self.away, self.root), expected)

    def test_both_ways_of_writing_a_link_are_brought_home(self):
        self.write("mein Bild/a.png")
        text = SVG % '<g><image href="../mein%20Bild/a.png"/><image xlink:href="../mein%20Bild/a.png" href="data:,"/></g>'
        expected = SVG % '<g><image href="a.png"/><image xlink:href="a.png" href="data:,"/></g>'
        self.assertEqual(okoshi_drawing.relocate_links(text.encode(), self.away, self.root), expected.encode())

    def test_broken_xml_is_left_to_okoshi(self):
        self.assertEqual(okoshi_drawing.relocate_links(b"<svg", self.away, self.root), b"<svg")


class Drawings(Folder):
    def drawing(self, original):
        return okoshi_drawing.Drawing(self.write("tmp/ink_ext.svg", SVG % ""), original)

    def test_the_copy_has_the_drawings_name_and_the_drawings_folder(self):
        drawing = self.drawing(os.path.join(self.folder, "-Mensch.svg"))
        with drawing.in_folder() as (folder, reading):
            self.assertEqual(reading, ["--base", self.folder, "--", "-Mensch.svg"])
            with open(os.path.join(folder, "-Mensch.svg"), "rb") as file:
                self.assertEqual(file.read(), drawing.data)
        self.assertFalse(os.path.exists(folder))

    def test_a_drawing_that_was_never_saved_has_an_empty_folder_of_links(self):
        with self.drawing("").in_folder() as (folder, reading):
            self.assertEqual(os.listdir(reading[1]), [])
            self.assertEqual(os.path.dirname(reading[1]), folder)

    def test_advice_where_inkscape_has_a_part_in_missing_links(self):
        said = "error[E006]: the link `a.png` is not there"
        self.assertIn("never saved", self.drawing("").advice(said))
        self.assertIn("1.1", self.drawing(None).advice(said))
        self.assertIn("Save a Copy", self.drawing(os.path.join(self.folder, "out.glb")).advice(said))
        self.assertEqual(self.drawing(os.path.join(self.folder, "a.svg")).advice(said), "")
        self.assertEqual(self.drawing("").advice("error[E204]"), "")


class Findings(unittest.TestCase):
    def finding(self, start, severity="error", code="E204", **more):
        return dict({"severity": severity, "code": code, "message": "hm", "start": start, "label": None, "help": None}, **more)

    def answer(self, *findings):
        return json.dumps({"drawings": [{"diagnostics": findings}]})

    def test_errors_come_first_with_their_string_and_object(self):
        text = SVG % '<g id="g"><path id="p"><desc id="d">Ärm</desc></path><text id="t"><tspan id="s">A@B &amp;\n x</tspan></text></g>'
        data = text.encode("utf-8")
        findings = [
            self.finding(data.index(b"<path"), "hint", "H402"),
            self.finding(data.index(b"@B"), label="did you mean `C`?", help="write it alike"),
            self.finding(data.index("Ärm".encode("utf-8")), "warning", "W101"),
        ]
        self.assertEqual(
            okoshi_findings.format_findings(okoshi_findings.read_findings(self.answer(*findings), data)),
            "error[E204]: hm\n    in the string: A@B & x\n    of the object: t\n    did you mean `C`?\n    help: write it alike\n\n"
            "warning[W101]: hm\n    in the string: Ärm\n    of the object: p\n\n"
            "hint[H402]: hm\n    of the object: p\n\n"
            "1 error, 1 warning, 1 hint",
        )

    def test_many_are_cut_short(self):
        said = okoshi_findings.format_findings(okoshi_findings.read_findings(self.answer(*[self.finding(0)] * 70), b"<svg/>"))
        self.assertEqual(said.count("E204"), okoshi_findings.MAX_FINDINGS)
        self.assertIn("… and 20 more\n\n70 errors", said)

    def test_what_is_no_answer_is_told(self):
        for answer in ("", "error: no", "{}", "[]", self.answer({})):
            self.assertIsNone(okoshi_findings.read_findings(answer, b"<svg/>"), answer)
        found = okoshi_findings.read_findings(self.answer(self.finding(3)), b"<svg")
        self.assertEqual(okoshi_findings.format_findings(found), "error[E204]: hm\n\n1 error")


class Reports(Folder):
    """What the window shows, and where there can be none."""

    def setUp(self):
        super().setUp()
        self.drawing = okoshi_drawing.Drawing(self.write("tmp/ink_ext.svg", SVG % ""), os.path.join(self.folder, "car.svg"))
        where = mock.patch.object(okoshi_report, "folder_of", lambda _: os.path.join(self.folder, "cache"))
        where.start()
        self.addCleanup(where.stop)

    def report(self, *severities):
        return okoshi_report.make_report(self.drawing, [{"severity": one} for one in severities], "3 parts", "\nhm\n")

    def test_the_headline_says_how_many_there_are(self):
        self.assertEqual(self.report("error", "hint", "error")["headline"], "2 errors, 1 hint in car.svg")
        report = self.report()
        self.assertEqual([report[one] for one in ("headline", "detail", "note")], ["No problems in car.svg", "3 parts", "hm"])

    @unittest.skipUnless(sys.platform.startswith("linux"), "screens have no names there")
    def test_without_a_screen_there_is_no_window(self):
        with mock.patch.dict(os.environ, {"DISPLAY": "", "WAYLAND_DISPLAY": ""}):
            self.assertFalse(okoshi_report.show_report(self.drawing, self.report()))
        self.assertFalse(os.path.exists(os.path.join(self.folder, "cache")))
        with mock.patch.dict(os.environ, {"DISPLAY": ":9999", "WAYLAND_DISPLAY": ""}):
            self.assertFalse(okoshi_report.show_report(self.drawing, self.report()))

    def test_an_open_window_gets_the_new_report(self):
        cache = os.path.join(self.folder, "cache")
        os.mkdir(cache)
        held = okoshi_cache.lock(cache, okoshi_report.WINDOW_LOCK)
        self.addCleanup(held.close)
        with mock.patch.dict(os.environ, {"DISPLAY": ":9999"}):
            self.assertTrue(okoshi_report.show_report(self.drawing, self.report("hint")))
        with open(os.path.join(cache, okoshi_report.REPORT), encoding="utf-8") as file:
            self.assertEqual(json.load(file), self.report("hint"))


@unittest.skipIf(sys.platform == "win32", "the stand-in is a script")
class Previews(Folder):
    """Servers, with a stand-in for okoshi and for the browser."""

    def setUp(self):
        super().setUp()
        self.program = os.path.join(HERE, "fake_okoshi.py")
        self.calls = os.path.join(self.folder, "calls")
        browser = self.write("browser", '#!/bin/sh\necho "$1" >> "$OPENED"\n', executable=True)
        self.opened = os.path.join(self.folder, "opened")
        patch = {
            # Wherever the system has its cache.
            **dict.fromkeys(("XDG_CACHE_HOME", "LOCALAPPDATA", "HOME"), os.path.join(self.folder, "cache")),
            "FAKE_LOG": self.calls,
            "OPENED": self.opened,
        }
        # A name with blanks is no word of BROWSER: a link without them.
        plain = tempfile.mktemp(prefix="okoshi-browser-")
        os.symlink(browser, plain)
        self.addCleanup(os.remove, plain)
        patch["BROWSER"] = plain + " %s"
        environ = mock.patch.dict(os.environ, patch)
        environ.start()
        self.addCleanup(environ.stop)
        self.addCleanup(okoshi_previews.stop_all)

    def drawing(self, text, name="Mensch.svg"):
        copy = self.write("tmp/ink_ext.svg", SVG % text)
        original = os.path.join(self.folder, name)
        if not os.path.exists(original):
            self.write(name, SVG % "as saved")
        return okoshi_drawing.Drawing(copy, original)

    def show(self, text, name="Mensch.svg"):
        self.assertIsNone(okoshi_previews.show(self.program, self.drawing(text, name)))

    def lines(self, path, number):
        """The lines of a file, as soon as it has so many."""
        end = time.monotonic() + PATIENCE
        while True:
            found = []
            if os.path.exists(path):
                with open(path, encoding="utf-8") as file:
                    found = file.read().splitlines()
            if len(found) >= number or time.monotonic() > end:
                return found
            time.sleep(0.05)

    def served(self, page, text):
        """Waits until the page has the text."""
        end = time.monotonic() + PATIENCE
        while True:
            with urllib.request.urlopen(page, timeout=PATIENCE) as answer:
                body = answer.read().decode("utf-8")
            if text in body or time.monotonic() > end:
                return body
            time.sleep(0.05)

    def test_one_server_a_drawing_that_shows_the_canvas_and_then_what_is_saved(self):
        self.show("on the canvas")
        pages = self.lines(self.opened, 1)
        self.assertRegex(pages[0], r"^http://127\.0\.0\.1:\d+/page$")
        self.assertIn("on the canvas", self.served(pages[0], "on the canvas"))
        self.show("changed on the canvas")
        self.assertEqual(self.lines(self.opened, 2), pages * 2)
        self.assertIn("changed on", self.served(pages[0], "changed on"))
        self.write("Mensch.svg", SVG % "saved anew")
        self.assertIn("saved anew", self.served(pages[0], "saved anew"))
        self.show("other", "zweite.svg")
        self.assertNotEqual(self.lines(self.opened, 3)[2], pages[0])
        calls = [line.split("\t") for line in self.lines(self.calls, 2)]
        self.assertEqual(len(calls), 2)
        self.assertEqual(calls[0][1:3], [os.path.join(self.folder, "Mensch.svg"), "--unsaved"])
        self.assertEqual(os.path.basename(calls[0][3]), "Mensch.svg")
        self.assertEqual(okoshi_previews.stop_all(), 2)
        self.assertEqual(okoshi_previews.stop_all(), 0)
        self.assertFalse(os.path.exists(calls[0][3]))
        self.assertTrue(os.path.exists(calls[0][1]))
        with self.assertRaises(OSError):
            urllib.request.urlopen(pages[0], timeout=2)

    def test_a_server_that_has_died_is_started_anew(self):
        drawing = self.drawing("first")
        self.show("first")
        folder = okoshi_cache.folder_of(drawing)
        os.kill(okoshi_previews.read_state(folder)["pid"], 15)
        end = time.monotonic() + PATIENCE
        while okoshi_previews.is_running(folder) and time.monotonic() < end:
            time.sleep(0.05)
        self.show("second")
        pages = self.lines(self.opened, 2)
        self.assertIn("second", self.served(pages[1], "second"))
        self.assertEqual(len(self.lines(self.calls, 2)), 2)

    @unittest.skipIf(inkex is None, "lxml comes with inkex")
    def test_what_the_page_has_changed_outlives_the_server_and_the_canvas(self):
        self.show('<path id="p"/>')
        page = self.lines(self.opened, 1)[0]
        copy = okoshi_previews.read_state(okoshi_cache.folder_of(self.drawing("")))["copy"]
        self.write(copy, SVG % '<path id="p" data-name="Arm"/>')
        self.write("Mensch.svg", SVG % '<path id="p"/><rect id="saved"/>')
        self.assertIn('<path id="p" data-name="Arm"/><rect id="saved"/>', self.served(page, '"Arm"/><rect'))
        self.assertEqual(okoshi_previews.waiting(), ["Mensch.svg"])
        self.assertEqual(okoshi_previews.stop_all(), 1)
        self.show('<path id="p"/><rect id="canvas"/>')
        page = self.lines(self.opened, 2)[1]
        self.assertIn('<path id="p" data-name="Arm"/><rect id="canvas"/>', self.served(page, '"Arm"/><rect id="canvas"'))

    def test_what_a_server_says_that_does_not_start_is_shown(self):
        with mock.patch.dict(os.environ, {"FAKE_FAILS": "1"}):
            with self.assertRaises(okoshi_cache.Failed) as caught:
                okoshi_previews.show(self.program, self.drawing("x"))
        self.assertIn("the fake fails, as it was told", str(caught.exception))

    def test_an_old_okoshi_is_told(self):
        for number, said in enumerate(("unrecognized subcommand 'preview'", "unexpected argument '--unsaved' found")):
            old = self.write("old%d" % number, '#!/bin/sh\necho "error: %s" >&2; exit 2\n' % said, executable=True)
            with self.assertRaises(okoshi_cache.Failed) as caught:
                okoshi_previews.show(old, self.drawing("x"))
            self.assertIn("too old", str(caught.exception))

    def test_without_a_browser_the_address_is_given(self):
        with mock.patch("webbrowser.get", side_effect=okoshi_previews.webbrowser.Error):
            page = okoshi_previews.show(self.program, self.drawing("x"))
        self.assertIn("x", self.served(page, "x"))

    def test_a_drawing_without_a_place_is_shown_without_links(self):
        drawing = okoshi_drawing.Drawing(self.write("tmp/ink_ext.svg", SVG % "new"), "")
        self.assertIsNone(okoshi_previews.show(self.program, drawing))
        call = self.lines(self.calls, 1)[0].split("\t")
        self.assertEqual(os.listdir(call[3]), [])


class Follow(Folder):
    def test_the_drawing_is_followed_and_its_copy_too(self):
        command = okoshi_follow.preview_command("okoshi", "/cache/a.svg", "/here/a.svg", "/here", "80")
        self.assertEqual(command[3:], ["preview", "/here/a.svg", "--unsaved", "/cache/a.svg", "--port", "80"])
        command = okoshi_follow.preview_command("okoshi", "/cache/a.svg", "/here/a.svgz", "/here", "80")
        self.assertEqual(command[3:], ["preview", "/cache/a.svg", "--base", "/here", "--unsaved", "/cache/a.svg", "--port", "80"])
        # Nobody would know of which drawing the changes are.
        command = okoshi_follow.preview_command("okoshi", "/cache/a.svg", "", "/links", "80")
        self.assertEqual(command[3:], ["preview", "/cache/a.svg", "--base", "/links", "--read-only", "--port", "80"])

    def test_a_save_keeps_the_preview_alive(self):
        copy, original = self.write("copy.svg"), self.write("a.svg")
        os.utime(copy, (50, 50))
        os.utime(original, (90, 90))
        self.assertEqual(okoshi_follow.last_written(copy, original), 90)
        os.remove(original)
        self.assertEqual(okoshi_follow.last_written(copy, original), 50)
        self.assertEqual(okoshi_follow.last_written(copy, ""), 50)
        os.remove(copy)
        self.assertRaises(OSError, okoshi_follow.last_written, copy, "")


class Descriptions(unittest.TestCase):
    """The .inx files name what is there."""

    def test_scripts_dependencies_and_ids(self):
        space = "{http://www.inkscape.org/namespace/inkscape/extension}"
        ids = []
        for name in sorted(os.listdir(EXTENSION)):
            if not name.endswith(".inx"):
                continue
            root = ElementTree.parse(os.path.join(EXTENSION, name)).getroot()
            ids.append(root.findtext(space + "id"))
            for path in (".//%scommand" % space, ".//%sdependency" % space):
                for element in root.iterfind(path):
                    self.assertTrue(os.path.isfile(os.path.join(EXTENSION, element.text)), element.text)
        self.assertEqual(
            ids,
            ["org.okoshi." + one for one in ("check", "explain", "output.glb", "output.gltf", "part", "preview", "stop", "suggest", "take-in")],
        )


@unittest.skipIf(inkex is None, "inkex is not on PYTHONPATH")
class Scripts(Folder):
    """The scripts as Inkscape starts them, with an okoshi that is a shell script."""

    def call(self, script, okoshi, *arguments, drawing=""):
        program = self.write("okoshi", "#!/bin/sh\n" + okoshi, executable=True)
        copy = self.write("tmp/ink_ext.svg", SVG % drawing)
        # Without a screen, so that no window is opened.
        environ = dict(os.environ, OKOSHI=program, DOCUMENT_PATH=os.path.join(self.folder, "Mensch.svg"), DISPLAY="", WAYLAND_DISPLAY="")
        environ.update(dict.fromkeys(("XDG_CACHE_HOME", "LOCALAPPDATA", "HOME"), os.path.join(self.folder, "cache")))
        process = subprocess.Popen(
            [sys.executable, os.path.join(EXTENSION, script), *arguments, copy],
            env=environ,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )
        out, err = process.communicate()
        return process.returncode, out, err.decode("utf-8")

    def test_a_model_is_handed_over_byte_for_byte(self):
        # Arguments: --color never build -o model.glb …
        done = "printf 'gl\\000TF\\r\\n\\377' > \"$5\"; echo 'wrote model.glb: 1 node' >&2\n"
        self.assertEqual(self.call("okoshi_glb.py", done), (0, b"gl\0TF\r\n\xff", ""))
        self.assertEqual(self.call("okoshi_gltf.py", done), (0, b"gl\0TF\r\n\xff", ""))

    def test_warnings_are_shown_and_do_not_block(self):
        done = "printf x > \"$5\"; echo 'warning[W101]: hm' >&2; echo 'wrote model.glb: 1 node' >&2\n"
        self.assertEqual(self.call("okoshi_glb.py", done), (0, b"x", "warning[W101]: hm\n\n"))

    def test_hints_are_no_matter_when_saving(self):
        done = "printf x > \"$5\"; echo 'hint[H402]: hm' >&2\n"
        self.assertEqual(self.call("okoshi_glb.py", done), (0, b"x", ""))

    def test_errors_are_shown_and_nothing_is_handed_over(self):
        status, out, err = self.call("okoshi_glb.py", "printf half > \"$5\"; echo 'error[E204]: ä' >&2; exit 1\n")
        self.assertEqual((status, out), (1, b""))
        self.assertIn("error[E204]: ä", err)

    def test_the_check_counts_what_is_in_order(self):
        okoshi = 'case $3 in check) echo "Mensch.svg: nothing to say";; *) echo "  parts  15"; echo "  strings  1";; esac\n'
        self.assertEqual(self.call("okoshi_check.py", okoshi), (0, b"", "no problems: 15 parts, 1 string\n"))

    def test_the_check_shows_findings(self):
        answer = '{"drawings": [{"diagnostics": [{"severity": "hint", "code": "H402", "message": "hm", "start": 0, "label": null, "help": null}]}]}'
        okoshi = "case $3-$4 in check-) :;; check---format) echo '%s';; *) echo '  parts  1'; echo '  strings  2';; esac\n" % answer
        expected = "hint[H402]: hm\n\n1 hint\n\nno problems: 1 part, 2 strings\n"
        self.assertEqual(self.call("okoshi_check.py", okoshi), (0, b"", expected))
        # An answer that is not understood is shown as it is for terminals.
        status, out, err = self.call("okoshi_check.py", "echo 'error[E006]: gone'; exit 1\n")
        self.assertEqual((status, out, err), (0, b"", "error[E006]: gone\n\n"))

    def test_names_are_written_as_labels_and_shown(self):
        # Arguments: --color never annotate --json -o named/named.svg …
        answer = '{"parts": [{"name": "Arm", "parent": "Body", "certainty": "uncertain", "why": "it is thin", "element": "p"}]}'
        okoshi = "echo '%s'; sed 's/id=\"p\"/id=\"p\" data-name=\"Arm\"/' Mensch.svg > \"$6\"\n" % answer
        status, out, err = self.call("okoshi_suggest.py", okoshi, drawing='<!-- kept --><path id="p" d="M 0,0"/>')
        self.assertEqual(status, 0)
        self.assertIn(b'<!-- kept --><path id="p" d="M 0,0" data-name="Arm"/>', out)
        expected = [
            "1 name in Mensch.svg",
            "look at 1 uncertain name: only place and shape tell",
            "Arm@Body\n    uncertain: it is thin\n    of the object: p",
            "Edit → Undo takes all of them back.\n",
        ]
        self.assertEqual(err, "\n\n".join(expected))

    def test_what_the_file_says_is_taken_in(self):
        self.write("Mensch.svg", SVG % '<path id="p" data-name="Arm"/>')
        status, out, err = self.call("okoshi_take_in.py", "exit 9\n", drawing='<path id="p"/><rect id="r"/>')
        self.assertEqual(status, 0)
        self.assertIn(b'<path id="p" data-name="Arm"/><rect id="r"/>', out)
        expected = ["1 change taken into Mensch.svg", "The label of p is `Arm`\n    of the object: p", "Edit → Undo takes all of them back.\n"]
        self.assertEqual(err, "\n\n".join(expected))
        said = "There is nothing to take in: Mensch.svg is here as the preview's page and the file have it.\n"
        self.assertEqual(self.call("okoshi_take_in.py", "exit 9\n", drawing='<path id="p" data-name="Arm"/>'), (0, b"", said))

    def test_what_was_not_saved_stays_where_the_file_is_known(self):
        drawing = '<path id="p" data-name="Arm"/>'
        self.write("Mensch.svg", SVG % drawing)
        self.call("okoshi_suggest.py", "echo '{\"parts\": []}'; cp Mensch.svg \"$6\"\n", drawing=drawing)
        self.assertEqual(self.call("okoshi_take_in.py", "exit 9\n", drawing='<path id="p" data-name="Paw"/>')[1], b"")

    def test_a_drawing_to_which_nothing_is_added_is_not_given_back(self):
        okoshi = "echo '`Mensch.svg` stays as it is: every part has a name already' >&2; exit 1\n"
        said = "`Mensch.svg` stays as it is: every part has a name already\n\n"
        self.assertEqual(self.call("okoshi_suggest.py", okoshi), (0, b"", said))
        status, out, err = self.call("okoshi_suggest.py", "echo \"error: unrecognized subcommand 'annotate'\" >&2; exit 2\n")
        self.assertEqual((status, out), (0, b""))
        self.assertIn("install a newer one", err)

    def test_a_form_takes_a_selection_and_a_screen(self):
        answer = '{"drawing": "Mensch.svg", "forms": [{"part": "Arm"}, {"part": "Arm"}]}'
        # Arguments: --color never inspect --form=#p --form=#t …
        okoshi = "test \"$4 $5\" = '--form=#p --form=#t' && echo '%s'\n" % answer
        said = "Nothing is selected. Select a shape, or the string of a part, and call Part… again.\n"
        self.assertEqual(self.call("okoshi_part.py", okoshi), (0, b"", said))
        status, out, err = self.call("okoshi_part.py", okoshi, "--id=p", "--id=t", drawing='<path id="p"/><text id="t"/>')
        self.assertEqual((status, out), (0, b""))
        self.assertIn("needs a screen and GTK 3", err)

    def test_a_selection_without_parts_is_told(self):
        okoshi = "echo 'error: Mensch.svg: the text `#t` is the string of no part' >&2; echo 'and more' >&2; exit 2\n"
        said = "Mensch.svg: the text `#t` is the string of no part\n\nSelect a shape, or the string of a part.\n"
        self.assertEqual(self.call("okoshi_part.py", okoshi, "--id=t", drawing='<text id="t"/>'), (0, b"", said))
        status, out, err = self.call("okoshi_part.py", "echo \"error: unexpected argument '--form' found\" >&2; exit 2\n", "--id=t", drawing='<text id="t"/>')
        self.assertIn("install a newer one", err)

    def test_the_manual_takes_a_word(self):
        okoshi = 'shift 2; echo "$*"\n'
        self.assertEqual(self.call("okoshi_explain.py", okoshi), (0, b"", "explain\n\n"))
        self.assertEqual(self.call("okoshi_explain.py", okoshi, "--about=-x"), (0, b"", "explain -- -x\n\n"))

    def test_stop_and_manual_need_no_drawing(self):
        environ = dict(os.environ, XDG_CACHE_HOME=self.folder, LOCALAPPDATA=self.folder, HOME=self.folder)
        environ["OKOSHI"] = self.write("okoshi", "#!/bin/sh\necho manual\n", executable=True)
        for script, expected in (("okoshi_stop.py", "no preview is running\n"), ("okoshi_explain.py", "manual\n\n")):
            process = subprocess.Popen(
                [sys.executable, os.path.join(EXTENSION, script)],
                env=environ,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
            )
            out, err = process.communicate()
            self.assertEqual((process.returncode, out, err.decode()), (0, b"", expected))

    def test_a_missing_program_is_said_in_words(self):
        copy = self.write("tmp/ink_ext.svg", SVG % "")
        for script in ("okoshi_glb.py", "okoshi_check.py", "okoshi_preview.py", "okoshi_explain.py", "okoshi_suggest.py", "okoshi_part.py"):
            process = subprocess.Popen(
                [sys.executable, os.path.join(EXTENSION, script), copy],
                env=dict(os.environ, OKOSHI="/gone/okoshi", DISPLAY="", WAYLAND_DISPLAY=""),
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
            )
            out, err = process.communicate()
            self.assertEqual(out, b"", script)
            self.assertIn("which is not a program", err.decode(), script)
            self.assertNotIn("Traceback", err.decode(), script)


if __name__ == "__main__":
    unittest.main()
