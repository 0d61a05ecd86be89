#!/usr/bin/env python3
"""Makes a site from the README, docs/ and examples/, which any static host can serve:

    bash tests/tools/site.sh OUT

Every page of docs/ with search, in light and dark, and one that shows each example as a drawing and as a model that turns. A link that leads
nowhere is an error. site.sh calls this with Zensical in a Python environment of its own and model-viewer from npm; OKOSHI is a binary to
use instead of target/release/okoshi.
"""

import json
import os
import posixpath
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parent.parent.parent
LINK = re.compile(r"(\]\(|src=\"|href=\")([^)\s\"]+)")
# Where a link to a folder leads, by its path in the repository.
FOLDERS = {"examples": "models.md", ".": "index.md", "docs": "pages.md"}
# Pages under another name: Zensical takes a README.md for a folder's first page, which is that of the repository.
PAGES = {"README.md": "index.md", "docs/README.md": "pages.md"}

STYLE = """
.okoshi-example { display: grid; grid-template-columns: 1fr 1fr; gap: 1rem; align-items: center; margin-bottom: 2rem; }
.okoshi-example img { max-height: 18rem; margin: auto; background: white; }
.okoshi-example model-viewer { width: 100%; height: 18rem; background: white; }
"""


def fail(message):
    sys.exit(f"error: {message}")


def place(path):
    """Where a file of the repository is in the site."""
    if path in PAGES:
        return PAGES[path]
    return path.removeprefix("docs/")


class Site:
    def __init__(self, pages):
        self.pages = pages
        self.waiting = []
        self.seen = set()

    def add(self, path):
        """Copies a file of the repository, with its links as they are in the site."""
        if path in self.seen:
            return
        self.seen.add(path)
        source, target = ROOT / path, self.pages / place(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.suffix == ".md":
            target.write_text(self.linked(source.read_text(), path))
        else:
            shutil.copyfile(source, target)

    def linked(self, text, path):
        def replaced(match):
            link, _, anchor = match[2].partition("#")
            if not link or ":" in link:
                return match[0]
            file = posixpath.normpath(posixpath.join(posixpath.dirname(path), link))
            if file.startswith(".."):
                fail(f"{path} links to {link}, which is outside of the repository")
            source = ROOT / file
            if source.is_dir():
                to = FOLDERS.get(file) or self.listing(file)
            elif source.is_file():
                self.waiting.append(file)
                to = place(file)
            else:
                fail(f"{path} links to {link}, which does not exist")
            to = posixpath.relpath(to, posixpath.dirname(place(path)) or ".")
            return match[1] + to + (f"#{anchor}" if anchor else "")

        # Code is left as it is.
        pieces = re.split(r"(^```.*?^```|`[^`\n]*`)", text, flags=re.MULTILINE | re.DOTALL)
        return "".join(piece if piece.startswith("`") else LINK.sub(replaced, piece) for piece in pieces)

    def listing(self, folder):
        """A page with the files of a folder of the repository."""
        page = f"{place(folder)}/files.md"
        target = self.pages / page
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            files = sorted(file for file in (ROOT / folder).rglob("*") if file.is_file() and "node_modules" not in file.parts)
            lines = []
            for file in files:
                path = file.relative_to(ROOT).as_posix()
                self.waiting.append(path)
                name = file.relative_to(ROOT / folder).as_posix()
                lines.append(f"- [{name}]({name})\n")
            target.write_text(f"# {folder}\n\n" + "".join(lines))
        return page

    def add_all(self, paths):
        self.waiting += paths
        while self.waiting:
            self.add(self.waiting.pop())


def title(page):
    return next(line[2:].strip() for line in page.read_text().splitlines() if line.startswith("# "))


def navigation(pages):
    """The sections of the list of pages, and the pages in each."""
    sections = [{"okoshi": "index.md"}, {"Models": "models.md"}]
    listed = set()
    for part in re.split(r"^## ", (pages / "pages.md").read_text(), flags=re.MULTILINE)[1:]:
        heading, _, rest = part.partition("\n")
        entries = []
        for link in re.findall(r"\]\(([^)#]+\.md)\)", rest):
            if link not in listed:
                listed.add(link)
                entries.append({title(pages / link): link})
        sections.append({heading.strip(): entries})
    return sections


def models(okoshi, pages):
    """Builds the model of each example, and the page that shows them."""
    drawings = sorted(path.relative_to(ROOT / "examples").as_posix() for path in (ROOT / "examples").rglob("*.svg"))

    def build(name):
        out = pages / "models" / Path(name).with_suffix(".glb")
        out.parent.mkdir(parents=True, exist_ok=True)
        command = [okoshi, "build", "-q", ROOT / "examples" / name, "-o", out]
        return name, subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for name, built in pool.map(build, drawings):
            if built.returncode != 0:
                fail(f"examples/{name} is not built: {built.stderr}")
    text = "# Models\n\nEach example as it is drawn, and the model that okoshi makes of it. Drag a model to turn it.\n"
    folder = None
    for name in sorted(drawings, key=lambda name: (posixpath.dirname(name), name)):
        if posixpath.dirname(name) != folder:
            folder = posixpath.dirname(name)
            text += f"\n## {folder.capitalize() or 'Figures and things'}\n"
        stem = name.removesuffix(".svg")
        short = posixpath.basename(stem)
        text += (
            f"\n### {short}\n\n<div class=\"okoshi-example\">\n"
            f"<a href=\"examples/{name}\"><img src=\"examples/{name}\" alt=\"{short}: the drawing\" loading=\"lazy\"></a>\n"
            f"<model-viewer src=\"models/{stem}.glb\" alt=\"{short}: the model\" camera-controls camera-orbit=\"20deg 75deg auto\" auto-rotate autoplay loading=\"lazy\" "
            "shadow-intensity=\"1\" touch-action=\"pan-y\"></model-viewer>\n</div>\n"
        )
    (pages / "models.md").write_text(text)
    return len(drawings)


class Links(HTMLParser):
    """What a page links to, and the places in it that can be linked to."""

    def __init__(self, text):
        super().__init__()
        self.links, self.places = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src") and value:
                self.links.append(value)
            elif name in ("id", "name") and tag != "meta":
                self.places.add(value)


def check_links(site):
    """Every link within the site leads to a file, and to a place in it that is there."""
    pages = {page: Links(page.read_text()) for page in site.rglob("*.html")}
    broken, count = [], 0
    for page, read in pages.items():
        # It stands for any address.
        if page.name == "404.html":
            continue
        for link in read.links:
            url = urlsplit(link)
            if url.scheme or url.netloc:
                continue
            count += 1
            target = (page.parent / unquote(url.path)).resolve() if url.path else page
            if target.is_dir():
                target /= "index.html"
            place = unquote(url.fragment)
            if not target.is_file() or (place and target in pages and place not in pages[target].places):
                broken.append(f"{page.relative_to(site)} links to {link}")
    if broken:
        fail("\n  ".join(["links lead nowhere:", *broken]))
    return count


def main():
    out, viewer = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    okoshi = Path(os.environ.get("OKOSHI", ROOT / "target/release/okoshi")).resolve()
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        pages = scratch / "pages"
        (pages / "assets").mkdir(parents=True)
        site = Site(pages)
        # Drawings link to pictures and motions beside them.
        beside = [path.relative_to(ROOT).as_posix() for path in (ROOT / "examples").rglob("*") if path.is_file() and path.suffix != ".glb"]
        docs = [path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").rglob("*.md")]
        site.add_all(["README.md", *docs, *beside])
        count = models(okoshi, pages)
        shutil.copyfile(viewer, pages / "assets/model-viewer.js")
        (pages / "assets/okoshi.css").write_text(STYLE)
        palette = [
            {"media": f"(prefers-color-scheme: {scheme})", "scheme": name, "primary": "white" if scheme == "light" else "black",
             "toggle": {"icon": icon, "name": f"Switch to {other}"}}
            for scheme, name, icon, other in (
                ("light", "default", "material/weather-night", "dark"),
                ("dark", "slate", "material/weather-sunny", "light"),
            )
        ]
        settings = {
            "site_name": "okoshi",
            "docs_dir": "pages",
            "site_dir": "site",
            # Nothing is fetched from elsewhere.
            "theme": {"name": "material", "font": False, "palette": palette, "features": ["navigation.tabs", "search.suggest", "content.code.copy"]},
            "plugins": ["search"],
            "nav": navigation(pages),
            "extra_css": ["assets/okoshi.css"],
            "extra_javascript": [{"path": "assets/model-viewer.js", "type": "module"}],
            "markdown_extensions": ["tables", "fenced_code", "md_in_html", "toc"],
                    }
        # JSON is YAML.
        (scratch / "zensical.yml").write_text(json.dumps(settings))
        command = [Path(sys.executable).parent / "zensical", "build", "--strict", "--clean", "-f", scratch / "zensical.yml"]
        status = subprocess.run([str(part) for part in command], check=False).returncode
        if status != 0:
            fail("the site is not built")
        links = check_links(scratch / "site")
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(scratch / "site", out)
    size = sum(file.stat().st_size for file in out.rglob("*") if file.is_file())
    print(f"{out}: {len(list(out.rglob('*.html')))} pages, {count} models, {links} links, {size // 2**20} MiB")


if __name__ == "__main__":
    main()
