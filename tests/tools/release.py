#!/usr/bin/env python3
"""Makes packages of okoshi that need neither Rust nor Node, and tries each in a bare folder:

    OKOSHI=PROGRAM python3 tests/tools/release.py OUT

PROGRAM is `cargo build --profile dist`'s, or any other with the page inside. For Linux on this machine's kind of processor: an archive, a
Debian package, a Python wheel (`pip install` puts `okoshi` on the path) and an npm package (`npx okoshi`); and Inkscape's extension
with its installers. Beside them are their checksums and a list of what is inside (SBOM, CycloneDX). Requires binutils, dpkg-deb, pip and npm.
"""

import base64
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
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SUMMARY = "Turns one annotated 2D drawing into a moving 3D model: SVG in, glTF out"
TEXTS = ("README.md", "LICENSE-MIT", "LICENSE-APACHE")
SHELLS = {"bash": "bash-completion/completions/okoshi", "zsh": "zsh/site-functions/_okoshi", "fish": "fish/vendor_completions.d/okoshi.fish"}
# Dates in packages, so that the same program gives the same bytes.
EPOCH = 315532800


def run(*command, **more):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, **more)
    if done.returncode != 0:
        sys.exit(f"error: {' '.join(map(str, command))}:\n{done.stdout}{done.stderr}")
    return done.stdout


def metadata():
    return json.loads(run("cargo", "metadata", "--format-version", "1", "--locked", "--filter-platform", "x86_64-unknown-linux-gnu", cwd=ROOT))


def lowest_libc(program):
    """The lowest version of glibc that a program runs with."""
    found = re.findall(r"GLIBC_(\d+)\.(\d+)", run("objdump", "-T", program))
    return max((int(major), int(minor)) for major, minor in found)


def files(program, okoshi):
    """What an installation has below its prefix: per path the bytes, and whether it is a program."""
    content = {"bin/okoshi": (program.read_bytes(), True)}
    for name in TEXTS:
        content[f"share/doc/okoshi/{name}"] = ((ROOT / name).read_bytes(), False)
    for shell, path in SHELLS.items():
        content[f"share/{path}"] = (run(okoshi, "completions", shell).encode(), False)
    return content


def archive(path, content, folder):
    """A .tar.gz with the content in a folder."""
    with tempfile.TemporaryFile() as plain:
        with tarfile.open(fileobj=plain, mode="w", format=tarfile.GNU_FORMAT) as tar:
            for name, (data, is_program) in sorted(content.items()):
                entry = tarfile.TarInfo(f"{folder}/{name}")
                entry.size, entry.mtime, entry.mode = len(data), EPOCH, 0o755 if is_program else 0o644
                tar.addfile(entry, io.BytesIO(data))
        plain.seek(0)
        path.write_bytes(run_bytes("gzip", "-9n", input=plain.read()))


def run_bytes(*command, input):
    return subprocess.run(command, input=input, stdout=subprocess.PIPE, check=True).stdout


def debian(path, content, version, libc, scratch):
    root = scratch / "debian"
    for name, (data, is_program) in content.items():
        file = root / "usr" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)
        file.chmod(0o755 if is_program else 0o644)
    machine = run("dpkg", "--print-architecture").strip()
    size = sum(len(data) for data, _ in content.values()) // 1024
    (root / "DEBIAN").mkdir()
    (root / "DEBIAN/control").write_text(
        f"Package: okoshi\nVersion: {version}\nArchitecture: {machine}\nMaintainer: The okoshi developers <nobody@okoshi.invalid>\n"
        f"Installed-Size: {size}\nDepends: libc6 (>= {libc[0]}.{libc[1]}), libgcc-s1\nSuggests: inkscape\nSection: graphics\nPriority: optional\n"
        f"Description: {SUMMARY}\n"
    )
    environment = {**os.environ, "SOURCE_DATE_EPOCH": str(EPOCH)}
    run("dpkg-deb", "--root-owner-group", "-Zxz", "--build", root, path, env=environment)


def wheel(folder, program, version, libc):
    tag = f"py3-none-manylinux_{libc[0]}_{libc[1]}_{platform.machine()}"
    info = f"okoshi-{version}.dist-info"
    content = {
        f"okoshi-{version}.data/scripts/okoshi": program.read_bytes(),
        f"{info}/METADATA": (
            f"Metadata-Version: 2.4\nName: okoshi\nVersion: {version}\nSummary: {SUMMARY}\nLicense-Expression: MIT OR Apache-2.0\n"
            "License-File: LICENSE-MIT\nLicense-File: LICENSE-APACHE\nDescription-Content-Type: text/markdown\n\n" + (ROOT / "README.md").read_text()
        ).encode(),
        f"{info}/WHEEL": f"Wheel-Version: 1.0\nGenerator: okoshi\nRoot-Is-Purelib: false\nTag: {tag}\n".encode(),
        f"{info}/licenses/LICENSE-MIT": (ROOT / "LICENSE-MIT").read_bytes(),
        f"{info}/licenses/LICENSE-APACHE": (ROOT / "LICENSE-APACHE").read_bytes(),
    }
    record = ""
    for name, data in content.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(data)}\n"
    content[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    path = folder / f"okoshi-{version}-{tag}.whl"
    zipped(path, {name: (data, "/scripts/" in name) for name, data in content.items()})
    return path


def zipped(path, content):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as out:
        for name, (data, is_program) in content.items():
            entry = zipfile.ZipInfo(name)
            entry.external_attr = (0o100755 if is_program else 0o100644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            out.writestr(entry, data)


def npm(path, program, version):
    package = {
        "name": "okoshi", "version": version, "description": SUMMARY, "license": "MIT OR Apache-2.0", "bin": {"okoshi": "bin/okoshi"},
        "os": ["linux"], "cpu": [{"x86_64": "x64", "aarch64": "arm64"}[platform.machine()]], "libc": ["glibc"],
    }
    content = {"package.json": (json.dumps(package, indent=2).encode(), False), "bin/okoshi": (program.read_bytes(), True)}
    content |= {name: ((ROOT / name).read_bytes(), False) for name in TEXTS}
    archive(path, content, "package")


def inkscape(path):
    """The extension with its installers, and the drawings that they put under New from Template."""
    folder = ROOT / "editors/inkscape"
    sources = [folder / "install.sh", folder / "install.ps1", *(folder / "extension").rglob("*")]
    content = {}
    for file in sources:
        if file.is_file() and "__pycache__" not in file.parts:
            content[f"okoshi-inkscape/{file.relative_to(folder)}"] = (file.read_bytes(), file.suffix == ".sh")
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
    path.write_text(json.dumps({"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1, "metadata": about, "components": components}, indent=1))


def tried(okoshi, room):
    """From nothing to a walking figure, with a system's own programs alone."""
    room.mkdir(parents=True)
    bare = {"PATH": "/usr/bin:/bin", "HOME": str(room)}
    for command in (["new", "me"], ["check", "me.svg"], ["build", "me.svg"], ["render", "-q", "me.svg", "-o", "me.png", "--size", "200x200"]):
        run(okoshi, *command, cwd=room, env=bare)
    assert (room / "me.glb").stat().st_size > 100_000 and (room / "me.png").stat().st_size > 1000
    server = subprocess.Popen([okoshi, "preview", "--port", "0", "me.svg"], cwd=room, env=bare, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        address = server.stdout.readline().strip()
        page = run("curl", "-sSf", address)
        assert "page.js" in page, f"no page at {address}"
    finally:
        server.kill()


def main():
    out = Path(sys.argv[1]).resolve()
    okoshi = Path(os.environ.get("OKOSHI", ROOT / "target/dist/okoshi")).resolve()
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    about = metadata()
    version = next(package["version"] for package in about["packages"] if package["name"] == "okoshi")
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        program = scratch / "okoshi"
        run("strip", "-o", program, okoshi)
        libc = lowest_libc(program)
        content = files(program, okoshi)
        name = f"okoshi-{version}-{platform.machine()}-linux"
        archive(out / f"{name}.tar.gz", content, name)
        debian(out / f"okoshi_{version}_{run('dpkg', '--print-architecture').strip()}.deb", content, version, libc, scratch)
        made = wheel(out, program, version, libc)
        npm(out / f"okoshi-{version}.tgz", program, version)
        inkscape(out / f"okoshi-inkscape-{version}.zip")
        bill(out / f"okoshi-{version}.cdx.json", about["packages"], version)

        run("tar", "xf", out / f"{name}.tar.gz", "-C", scratch)
        tried(scratch / name / "bin/okoshi", scratch / "rooms/archive")
        run("dpkg-deb", "-x", next(out.glob("*.deb")), scratch / "installed")
        tried(scratch / "installed/usr/bin/okoshi", scratch / "rooms/debian")
        run(sys.executable, "-m", "venv", scratch / "python")
        run(scratch / "python/bin/pip", "install", "-q", "--no-index", made)
        tried(scratch / "python/bin/okoshi", scratch / "rooms/wheel")
        run("npm", "install", "--silent", "--offline", "--prefix", scratch / "node", out / f"okoshi-{version}.tgz")
        tried(scratch / "node/node_modules/.bin/okoshi", scratch / "rooms/npm")
    packages = sorted(file for file in out.iterdir())
    (out / "SHA256SUMS").write_text("".join(f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}\n" for file in packages))
    for file in packages:
        print(f"{file.name}: {file.stat().st_size // 1024} KiB")
    print(f"runs with glibc {libc[0]}.{libc[1]} or newer; each of the four was installed and made a figure")


if __name__ == "__main__":
    main()
