"""The drawing that Inkscape passes to an extension: a temporary copy, with the path of the original in the environment.

As tested with Inkscape 1.2, `DOCUMENT_PATH` is the drawing's own file for effects, for *Export*, for *Save a Copy* and on the
command line; for *Save As* it is the file to be written; it is empty for a drawing that was never saved, and not set before 1.1.
Inkscape rewrites the links of `<image>` relative to the temporary copy, but not links in strings.
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
# The path of the drawing. Read at import: inkex sets it to the temporary copy if Inkscape did not set it.
ORIGINAL = os.environ.get("DOCUMENT_PATH")


class Drawing:
    """The drawing on the canvas.

    `data`: the SVG, with links relative to the original. `original`: its path, None if it has none.
    `root`: the folder for links, None if the drawing was never saved.
    """

    def __init__(self, copy, original=ORIGINAL):
        self.original = os.path.abspath(original) if original else None
        self.reported = original is not None
        self.root = os.path.dirname(self.original) if self.original else None
        with open(copy, "rb") as file:
            self.data = file.read()
        if self.root:
            self.data = relocate_links(self.data, os.path.dirname(os.path.abspath(copy)), self.root)

    @property
    def name(self):
        """The file name for diagnostics; for *Save As* the original already ends in .glb."""
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
            # `--` because the name may begin with a dash.
            yield folder, ["--base", links, "--", self.name]
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def advice(self, output):
        """Advice on links that were not found for reasons that lie in Inkscape; may be empty."""
        if "[E006]" not in output and "[E007]" not in output:
            return ""
        if not self.reported:
            return "\nLinked files are not found, because this Inkscape does not report the path of the drawing. Inkscape 1.1 and newer do.\n"
        if self.root is None:
            return "\nThe drawing was never saved. Once it is, links are relative to its folder.\n"
        if not self.original.lower().endswith((".svg", ".svgz")):
            return (
                "\nLinks were looked for in %s.\nFor Save As, Inkscape reports the folder of the new file, not that of the drawing. "
                "Use File → Export or File → Save a Copy, or save the model beside the drawing.\n" % self.root
            )
        return ""


def relocate_links(data, away, root):
    """Changes image links relative to the folder `away` in the SVG text `data`, so that they are relative to `root`."""
    edits = []
    parser = expat.ParserCreate(namespace_separator=" ")

    def start(name, attributes):
        if name != SVG + " image":
            return
        tag = TAG.match(data, parser.CurrentByteIndex)
        for link in LINK.finditer(tag.group()) if tag else ():
            old = attributes.get(XLINK + " href" if link.group("prefix") else "href")
            new = None if old is None else relocated_link(old, away, root)
            if new is not None:
                begin, end = link.span("value")
                edits.append((tag.start() + begin, tag.start() + end, b'"' + new.encode("ascii") + b'"'))

    parser.StartElementHandler = start
    try:
        parser.Parse(data, True)
    except expat.ExpatError:
        # okoshi reports what is wrong.
        return data
    for begin, end, link in reversed(edits):
        data = data[:begin] + link + data[end:]
    return data


def relocated_link(link, away, root):
    """The link relative to `root`, or None if it stays: it is not a file, or is relative to `root` already."""
    parts = urlsplit(link)
    if parts.scheme == "file":
        # Inkscape writes these between two drives, where there is no relative path.
        path = os.path.normpath(url2pathname(parts.path))
        return escaped(path, root) if inside(path, root) else None
    if parts.scheme or parts.netloc or not parts.path or parts.path.startswith("/"):
        return None
    path = unquote(parts.path)
    stays = os.path.normpath(os.path.join(root, path))
    moved = os.path.normpath(os.path.join(away, path))
    if inside(moved, root):
        # Written by Inkscape, unless the file only exists relative to `root`.
        ours = os.path.exists(moved) or not os.path.exists(stays)
    else:
        ours = os.path.exists(moved) and not os.path.exists(stays)
    return escaped(moved, root) if ours else None


def inside(path, folder):
    """Whether a path is in a folder, by name only."""
    try:
        return os.path.commonpath([path, folder]) == os.path.normpath(folder)
    except ValueError:
        return False


def escaped(path, root):
    """A path as a link relative to `root`, or None between two drives."""
    try:
        way = os.path.relpath(path, root)
    except ValueError:
        return None
    return quote(way.replace(os.sep, "/"), safe="/!$'()*+,;=:@~")
