#!/usr/bin/env python3
"""Makes packages of okoshi that need neither Rust nor Node, and tries each where there is neither:

    OKOSHI=PROGRAM python3 tests/tools/release.py OUT

PROGRAM is `cargo build --profile dist`'s, or any other with the page inside, for this system and its processor; on Linux it needs glibc, or is
static. On Linux: an archive, a Debian package, a Python wheel (`pip install` puts `okoshi` on the path), an npm package, and the extension
for VS Code with the program inside; on macOS and Windows the same but for the Debian package, which was not run there yet. And Inkscape's
extension with its installers. All hold okoshi in the browser, for `okoshi app`, if the program does: build it with OKOSHI_APP=FOLDER,
a folder that `bash editors/web/app.sh FOLDER` made. Beside them are their checksums and a list of what is inside (SBOM, CycloneDX). first_figure.py installs each
as docs/install.md says, and makes a figure with it as the tutorial says. Requires cargo, pip and npm, and on Linux binutils and dpkg-deb.
"""

import base64
import gzip
import hashlib
import io
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path

import first_figure

ROOT = Path(__file__).resolve().parent.parent.parent
SUMMARY = "Turns one annotated 2D drawing into a moving 3D model: SVG in, glTF out"
TEXTS = ("README.md", "LICENSE-MIT", "LICENSE-APACHE")
SHELLS = {"bash": "bash-completion/completions/okoshi", "zsh": "zsh/site-functions/_okoshi", "fish": "fish/vendor_completions.d/okoshi.fish"}
# Dates in packages, so that the same program gives the same bytes.
EPOCH = 315532800
SYSTEM = {"linux": "linux", "darwin": "macos", "win32": "windows"}[sys.platform]
MACHINE = {"AMD64": "x86_64", "arm64": "aarch64", "ARM64": "aarch64"}.get(platform.machine(), platform.machine())
NAME = "okoshi.exe" if SYSTEM == "windows" else "okoshi"


@dataclass(frozen=True)
class Program:
    """The program that is packaged. `libc` is the lowest version of glibc that it runs with; None if it needs none."""

    path: Path
    version: str
    libc: tuple[int, int] | None

    @property
    def platform(self):
        """The system and the processor, as archives are called."""
        libc = {"linux": f"-glibc{self.libc[0]}.{self.libc[1]}" if self.libc else "-static"}.get(SYSTEM, "")
        return f"{MACHINE}-{SYSTEM}{libc}"

    @property
    def tags(self):
        """The same, as wheels are called."""
        if SYSTEM == "linux":
            return f"manylinux_{self.libc[0]}_{self.libc[1]}_{MACHINE}" if self.libc else f"manylinux_2_17_{MACHINE}.musllinux_1_1_{MACHINE}"
        if SYSTEM == "macos":
            # The oldest that Rust builds for.
            return "macosx_11_0_arm64" if MACHINE == "aarch64" else "macosx_10_12_x86_64"
        return "win_arm64" if MACHINE == "aarch64" else "win_amd64"


def run(*command, **more):
    """Runs a command, and returns what it printed."""
    name, *words = map(str, command)
    # Some of the tools are scripts, which Windows finds by their whole name alone.
    return first_figure.done([shutil.which(name) or name, *words], **more)


def metadata():
    host = re.search(r"^host: (.*)$", run("rustc", "-vV"), re.M)[1]
    return json.loads(run("cargo", "metadata", "--format-version", "1", "--locked", "--filter-platform", host, cwd=ROOT))


def lowest_libc(program):
    """The lowest version of glibc that a program runs with; None for one that needs no library of the system."""
    needed = re.findall(r"^ +NEEDED +(\S+)", run("objdump", "-p", program), re.M)
    found = re.findall(r"GLIBC_(\d+)\.(\d+)", run("objdump", "-T", program)) if needed else []
    if needed and not found:
        first_figure.fail(f"{program} needs {', '.join(needed)}, but not glibc: a program for another C library is packaged if it is static")
    return max(((int(major), int(minor)) for major, minor in found), default=None)


def files(program):
    """What an installation has below its prefix: per path the bytes, and whether it is a program."""
    content = {f"bin/{NAME}": (program.path.read_bytes(), True)}
    for name in TEXTS:
        content[f"share/doc/okoshi/{name}"] = ((ROOT / name).read_bytes(), False)
    for shell, path in SHELLS.items():
        content[f"share/{path}"] = (run(program.path, "completions", shell).encode(), False)
    page = run(program.path, "man")
    content["share/man/man1/okoshi.1"] = (page.encode(), False)
    # The page of the program lists those of its commands.
    for command in re.findall(r"okoshi\\-(\w+)\(1\)", page):
        content[f"share/man/man1/okoshi-{command}.1"] = (run(program.path, "man", command).encode(), False)
    return content


def archive(path, content, folder):
    """A .tar.gz with the content in a folder; a .zip if the path ends so."""
    if path.suffix == ".zip":
        return zipped(path, {f"{folder}/{name}": value for name, value in sorted(content.items())})
    plain = io.BytesIO()
    with tarfile.open(fileobj=plain, mode="w", format=tarfile.GNU_FORMAT) as tar:
        for name, (data, is_program) in sorted(content.items()):
            entry = tarfile.TarInfo(f"{folder}/{name}")
            entry.size, entry.mtime, entry.mode = len(data), EPOCH, 0o755 if is_program else 0o644
            tar.addfile(entry, io.BytesIO(data))
    path.write_bytes(gzip.compress(plain.getvalue(), mtime=EPOCH))


def debian(path, content, program, scratch):
    root = scratch / "debian"
    for name, (data, is_program) in content.items():
        file = root / "usr" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)
        file.chmod(0o755 if is_program else 0o644)
    machine = run("dpkg", "--print-architecture").strip()
    size = sum(len(data) for data, _ in content.values()) // 1024
    depends = f"Depends: libc6 (>= {program.libc[0]}.{program.libc[1]}), libgcc-s1\n" if program.libc else ""
    (root / "DEBIAN").mkdir()
    (root / "DEBIAN/control").write_text(
        f"Package: okoshi\nVersion: {program.version}\nArchitecture: {machine}\nMaintainer: The okoshi developers <nobody@okoshi.invalid>\n"
        f"Installed-Size: {size}\n{depends}Suggests: inkscape\nSection: graphics\nPriority: optional\n"
        f"Description: {SUMMARY}\n"
    )
    environment = {**os.environ, "SOURCE_DATE_EPOCH": str(EPOCH)}
    run("dpkg-deb", "--root-owner-group", "-Zxz", "--build", root, path, env=environment)


def wheel(folder, program):
    version = program.version
    info = f"okoshi-{version}.dist-info"
    tags = "".join(f"Tag: py3-none-{tag}\n" for tag in program.tags.split("."))
    content = {
        f"okoshi-{version}.data/scripts/{NAME}": program.path.read_bytes(),
        f"{info}/METADATA": (
            f"Metadata-Version: 2.4\nName: okoshi\nVersion: {version}\nSummary: {SUMMARY}\nLicense-Expression: MIT OR Apache-2.0\n"
            "License-File: LICENSE-MIT\nLicense-File: LICENSE-APACHE\nDescription-Content-Type: text/markdown\n\n" + (ROOT / "README.md").read_text(encoding="utf-8")
        ).encode(),
        f"{info}/WHEEL": f"Wheel-Version: 1.0\nGenerator: okoshi\nRoot-Is-Purelib: false\n{tags}".encode(),
        f"{info}/licenses/LICENSE-MIT": (ROOT / "LICENSE-MIT").read_bytes(),
        f"{info}/licenses/LICENSE-APACHE": (ROOT / "LICENSE-APACHE").read_bytes(),
    }
    record = ""
    for name, data in content.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(data)}\n"
    content[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    path = folder / f"okoshi-{version}-py3-none-{program.tags}.whl"
    zipped(path, {name: (data, "/scripts/" in name) for name, data in content.items()})
    return path


def zipped(path, content):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as out:
        for name, (data, is_program) in content.items():
            entry = zipfile.ZipInfo(name)
            entry.external_attr = (0o100755 if is_program else 0o100644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            out.writestr(entry, data)


def node_platform():
    """The system and the processor in Node's words."""
    return {"linux": "linux", "macos": "darwin", "windows": "win32"}[SYSTEM], {"x86_64": "x64", "aarch64": "arm64"}[MACHINE]


def npm(path, program):
    system, processor = node_platform()
    package = {
        "name": "okoshi", "version": program.version, "description": SUMMARY, "license": "MIT OR Apache-2.0", "bin": {"okoshi": f"bin/{NAME}"},
        "os": [system], "cpu": [processor], **({"libc": ["glibc"]} if program.libc else {}),
    }
    content = {"package.json": (json.dumps(package, indent=2).encode(), False), f"bin/{NAME}": (program.path.read_bytes(), True)}
    content |= {name: ((ROOT / name).read_bytes(), False) for name in TEXTS}
    archive(path, content, "package")


def inkscape(path):
    """The extension with its installers, and the drawings that they put under New from Template."""
    folder = ROOT / "editors/inkscape"
    sources = [folder / "install.sh", folder / "install.ps1", *(folder / "extension").rglob("*")]
    content = {}
    for file in sources:
        if file.is_file() and "__pycache__" not in file.parts:
            content[f"okoshi-inkscape/{file.relative_to(folder).as_posix()}"] = (file.read_bytes(), file.suffix == ".sh")
    zipped(path, content)


def bill(path, packages, version):
    """What is inside, as CycloneDX."""
    components = [
        {"type": "library", "name": package["name"], "version": package["version"], "purl": f"pkg:cargo/{package['name']}@{package['version']}",
         "licenses": [{"expression": package["license"]}] if package["license"] else []}
        for package in packages if package["name"] != "okoshi"
    ]
    components.sort(key=lambda component: (component["name"], component["version"]))
    about = {"component": {"type": "application", "name": "okoshi", "version": version}}
    path.write_text(json.dumps({"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1, "metadata": about, "components": components}, indent=1), encoding="utf-8", newline="\n")


def vscode(path, program):
    """The extension for VS Code with the program inside."""
    run("node", ROOT / "editors/vscode/scripts/package.mjs", path, program.path, cwd=ROOT)


def vscode_web(path, module):
    """The extension for VS Code for the Web, with the module inside."""
    run("node", ROOT / "editors/vscode/scripts/package.mjs", path, "--web", module, cwd=ROOT)


def extension_tried(package, program, room):
    """The program that the extension brings runs where it is unpacked."""
    with zipfile.ZipFile(package) as archive:
        name = f"extension/bin/{NAME}"
        archive.extract(name, room)
        (room / name).chmod(archive.getinfo(name).external_attr >> 16 & 0o777)
    said = run(room / name, "--version", env={"PATH": ""} if SYSTEM != "windows" else None).strip()
    assert said == f"okoshi {program.version}", said


def app_tried(program):
    """Whether okoshi in the browser is in the program; then its page and the module come."""
    server = subprocess.Popen([program.path, "app", "--port", "0"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        address = server.stdout.readline().strip()
        if not address:
            said = server.stderr.read()
            assert "is not in this program" in said, said
            return False
        page = first_figure.DIRECTLY.open(address, timeout=60).read().decode()
        script = re.search(r'src="(v-[0-9a-f]+)/app\.js"', page)
        assert script, page
        with first_figure.DIRECTLY.open(f"{address}{script[1]}/okoshi_web_bg.wasm", timeout=60) as module:
            assert module.headers["Content-Type"] == "application/wasm", module.headers
            assert module.read(4) == b"\0asm"
        return True
    finally:
        server.kill()
        server.wait()


def main():
    out = Path(sys.argv[1]).resolve()
    okoshi = Path(os.environ.get("OKOSHI", ROOT / "target/dist" / NAME)).resolve()
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    about = metadata()
    version = next(package["version"] for package in about["packages"] if package["name"] == "okoshi")
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        path = scratch / NAME
        # Elsewhere, symbols are in files of their own.
        if SYSTEM == "linux":
            run("strip", "-o", path, okoshi)
        else:
            shutil.copy(okoshi, path)
        program = Program(path, version, lowest_libc(path) if SYSTEM == "linux" else None)
        content = files(program)
        name = f"okoshi-{version}-{program.platform}"
        archived = out / f"{name}{'.zip' if SYSTEM == 'windows' else '.tar.gz'}"
        archive(archived, content, name)
        packages = [archived]
        if SYSTEM == "linux":
            packages.append(out / f"okoshi_{version}_{run('dpkg', '--print-architecture').strip()}.deb")
            debian(packages[-1], content, program, scratch)
        packages.append(wheel(out, program))
        packages.append(out / f"okoshi-{version}.tgz")
        npm(packages[-1], program)
        extension = out / f"okoshi-{'-'.join(node_platform())}-{version}.vsix"
        vscode(extension, program)
        if module := os.environ.get("OKOSHI_MODULE"):
            vscode_web(out / f"okoshi-web-{version}.vsix", Path(module).resolve())
        inkscape(out / f"okoshi-inkscape-{version}.zip")
        bill(out / f"okoshi-{version}.cdx.json", about["packages"], version)

        if not first_figure.HAS_ROOT:
            print("skipped: packages are tried in folders, for only root on Linux may change the root folder")
        for package in packages:
            tutorial, readme = first_figure.tried(package, scratch / "rooms", to_the_end=package is archived)
            print(f"{package.name}: installed as the page says; {tutorial} commands to a walking figure with the tutorial, {readme} with the README")
        extension_tried(extension, program, scratch / "rooms/extension")
        if app_tried(program):
            print("`okoshi app` serves okoshi in the browser from the program")
        else:
            print("okoshi in the browser is not in the program, which was built without OKOSHI_APP")
    made = sorted(out.iterdir())
    (out / "SHA256SUMS").write_text("".join(f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}\n" for file in made), encoding="utf-8", newline="\n")
    for file in made:
        print(f"{file.name}: {file.stat().st_size // 1024} KiB")
    if SYSTEM == "linux":
        print(f"runs with glibc {'.'.join(map(str, program.libc))} or newer" if program.libc else "needs no library of the system")


if __name__ == "__main__":
    main()
