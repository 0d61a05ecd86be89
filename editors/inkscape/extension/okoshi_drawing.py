"""The drawing that Inkscape hands over: a temporary copy, with the place of the original in the environment.

Found by trying Inkscape 1.2: `DOCUMENT_PATH` is the drawing's own file for effects, for *Export*, for *Save a Copy* and on the
command line; under *Save As* it is the file that is about to be written; it is empty for a drawing that was never saved, and
missing before 1.1. Links of `<image>` are rewritten so that they hold for the temporary copy; links in strings are not touched.
"""

import os
import re
import shutil
import tempfile
from contextlib import contextmanager
from urllib.parse import quote, unquote, urlsplit
from urllib.request import url2pathname
from xml.parsers import expat

SVG = "http://www.w3.org/2000/svg"
XLINK = "http://www.w3.org/1999/xlink"
# A start tag of a well-formed document, and the links in it.
TAG = re.compile(rb"<[^\s/>]+(?:\s+[^\s=]+\s*=\s*(?:\"[^\"]*\"|'[^']*'))*\s*/?>")
LINK = re.compile(rb"(\s(?P<prefix>[^\s=\"':]+:)?href\s*=\s*)(?P<value>\"[^\"]*\"|'[^']*')")
# Where the drawing lies, as Inkscape says. Read at once: inkex puts the temporary copy there if Inkscape says nothing.
ORIGINAL = os.environ.get("DOCUMENT_PATH")


class Drawing:
    """A drawing as it is on the canvas.

    `data`: SVG, as if it lay beside the original. `original`: the path that Inkscape gives, None if there is none.
    `root`: the folder that links are looked for in, None if the drawing has no place yet.
    """

    def __init__(self, copy, original=ORIGINAL):
        self.original = os.path.abspath(original) if original else None
        self.told = original is not None
        self.root = os.path.dirname(self.original) if self.original else None
        with open(copy, "rb") as file:
            self.data = file.read()
        if self.root:
            self.data = bring_home(self.data, os.path.dirname(os.path.abspath(copy)), self.root)

    @property
    def name(self):
        """The file name that diagnostics show; under *Save As* the original ends in .glb already."""
        name = os.path.basename(self.original) if self.original else "drawing"
        return os.path.splitext(name)[0] + ".svg"

    @contextmanager
    def in_folder(self):
        """A temporary folder with the drawing in it, and the arguments for okoshi to read it."""
        folder = tempfile.mkdtemp(prefix="okoshi-")
        try:
            with open(os.path.join(folder, self.name), "wb") as file:
                file.write(self.data)
            links = self.root
            if links is None:
                links = os.path.join(folder, "links")
                os.mkdir(links)
            # The name may begin with a dash.
            yield folder, ["--root", links, "--", self.name]
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def advice(self, said):
        """What to do about links that were not found, as far as Inkscape has a part in it; or nothing."""
        if "[E006]" not in said and "[E007]" not in said:
            return ""
        if not self.told:
            return "\nThis Inkscape does not say where the drawing lies, so linked files are not found. Inkscape 1.1 and newer do.\n"
        if self.root is None:
            return "\nThe drawing was never saved: links are looked for beside it as soon as it has a place.\n"
        if not self.original.lower().endswith((".svg", ".svgz")):
            return (
                "\nLinks were looked for in %s.\nUnder Save As, Inkscape tells the folder that is saved to, not the drawing's. "
                "Take File → Export or File → Save a Copy, or save the model beside the drawing.\n" % self.root
            )
        return ""


def bring_home(data, away, root):
    """The SVG text `data`, with links of images that hold in the folder `away` changed so that they hold in `root`."""
    edits = []
    parser = expat.ParserCreate(namespace_separator=" ")

    def start(name, attributes):
        if name != SVG + " image":
            return
        tag = TAG.match(data, parser.CurrentByteIndex)
        for link in LINK.finditer(tag.group()) if tag else ():
            old = attributes.get(XLINK + " href" if link.group("prefix") else "href")
            new = None if old is None else home_link(old, away, root)
            if new is not None:
                begin, end = link.span("value")
                edits.append((tag.start() + begin, tag.start() + end, b'"' + new.encode("ascii") + b'"'))

    parser.StartElementHandler = start
    try:
        parser.Parse(data, True)
    except expat.ExpatError:
        # What is wrong with it is okoshi's to say.
        return data
    for begin, end, link in reversed(edits):
        data = data[:begin] + link + data[end:]
    return data


def home_link(link, away, root):
    """The link as seen from `root`, or None if it is to stay: it is no file, or it holds there as it is."""
    parts = urlsplit(link)
    if parts.scheme == "file":
        # What Inkscape writes where there is no relative way, from one drive to another.
        path = os.path.normpath(url2pathname(parts.path))
        return escaped(path, root) if inside(path, root) else None
    if parts.scheme or parts.netloc or not parts.path or parts.path.startswith("/"):
        return None
    path = unquote(parts.path)
    stays = os.path.normpath(os.path.join(root, path))
    moved = os.path.normpath(os.path.join(away, path))
    if inside(moved, root):
        # Inkscape's work, unless there is a file at home and none there.
        ours = os.path.exists(moved) or not os.path.exists(stays)
    else:
        ours = os.path.exists(moved) and not os.path.exists(stays)
    return escaped(moved, root) if ours else None


def inside(path, folder):
    """Whether a path lies in a folder, by their names."""
    try:
        return os.path.commonpath([path, folder]) == os.path.normpath(folder)
    except ValueError:
        return False


def escaped(path, root):
    """A path as a link from `root`, or None if there is no way between two drives."""
    try:
        way = os.path.relpath(path, root)
    except ValueError:
        return None
    return quote(way.replace(os.sep, "/"), safe="/!$'()*+,;=:@~")
