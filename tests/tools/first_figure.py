"""From nothing to a walking figure, as a new user gets there: with the commands of docs/install.md, docs/tutorial.md and README.md.

The commands are read from these pages, so that they cannot drift. What the tutorial draws by hand is taken from the drawings to which its
steps link. As root on Linux each package is installed in a root folder of its own with a handful of the system's programs, where there is
neither Rust nor Node; elsewhere in a folder, with an empty PATH.
"""

import glob
import json
import os
import re
import shlex
import shutil
import struct
import subprocess
import sys
import tarfile
import urllib.request
import venv
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
# From nothing to a walking figure takes fewer commands than this.
MOST_COMMANDS = 10
# What a bare root has: a shell, and what unpacks an archive and installs a Debian package.
PROGRAMS = ("sh", "tar", "gzip", "xz", "rm", "diff", "apt", "dpkg", "dpkg-deb", "dpkg-split", "ldconfig", "start-stop-daemon")
SYSTEM_PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
# The preview is on this machine, whatever proxy there is.
DIRECTLY = urllib.request.build_opener(urllib.request.ProxyHandler({}))
HAS_ROOT = sys.platform == "linux" and os.geteuid() == 0 and shutil.which("chroot", path=SYSTEM_PATH) is not None


def fail(text):
    sys.exit(f"error: {text}")


def done(command, **more):
    """Runs a command, and returns what it printed."""
    command = [str(part) for part in command]
    # Nothing may wait for an answer.
    ran = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", stdin=subprocess.DEVNULL, check=False, **more)
    if ran.returncode != 0:
        fail(f"{' '.join(command)}:\n{ran.stdout}{ran.stderr}")
    return ran.stdout


# ---- What the pages say

def steps(page):
    """What a page has its readers do, in its order: ("run", command) for lines of its `sh` blocks, ("draw", path) for links to drawings."""
    found, in_block = [], False
    for line in page.read_text(encoding="utf-8").splitlines():
        if line.startswith("```"):
            in_block = line == "```sh"
        elif in_block and line.strip():
            found.append(("run", line.strip()))
        elif drawing := re.search(r"^The drawing: \[[^\]]*\]\(([^)]+\.svg)\)", line):
            found.append(("draw", (page.parent / drawing[1]).resolve()))
    return found


def installation(ending):
    """The commands of docs/install.md for packages whose names end so: those of the block with such a name."""
    page = (ROOT / "docs/install.md").read_text(encoding="utf-8")
    blocks = [block.strip().splitlines() for block in re.findall(r"^```sh\n(.*?)^```", page, re.M | re.S)]
    chosen = [block for block in blocks if any(f"{ending} " in f"{line} " for line in block)]
    if len(chosen) != 1:
        fail(f"docs/install.md has {len(chosen)} ways to install a package *{ending}, and not one")
    return chosen[0]


def first_screen():
    """The commands of README.md for who draws: its first block, and the build of its five minutes."""
    page = (ROOT / "README.md").read_text(encoding="utf-8")
    block = re.search(r"^```sh\n(.*?)^```", page, re.M | re.S)[1].strip().splitlines()
    build = re.search(r"^\d+\. `(okoshi build me\.svg)`", page, re.M)
    if build is None or block[0] != "okoshi new me":
        fail("README.md does not lead from `okoshi new me` to `okoshi build me.svg`")
    return [("run", line) for line in [*block, build[1]]]


# ---- Where it happens

class Room:
    """A home without Rust and Node, where commands run: in a bare root folder if there may be one, else with an empty PATH."""

    def __init__(self, folder):
        self.folder = folder
        self.home = folder / "home"
        self.home.mkdir(parents=True)
        # The program, where there is no root with a path.
        self.okoshi = None
        if HAS_ROOT:
            self._furnish()

    def _furnish(self):
        # Most systems have these as links into `usr`.
        for name in ("bin", "sbin", "lib", "lib64"):
            if (link := Path("/") / name).is_symlink():
                (self.folder / "usr" / name).mkdir(parents=True)
                (self.folder / name).symlink_to(os.readlink(link))
        methods = sorted(Path("/usr/lib/apt/methods").glob("*"))
        # With the C library comes what is not a program's own.
        libraries = [path for name in ("libm.so.6", "libgcc_s.so.1") for folder in ("lib/*-linux-gnu", "lib64") for path in Path("/").glob(f"{folder}/{name}")]
        for program in [*filter(None, (shutil.which(name, path=SYSTEM_PATH) for name in PROGRAMS)), *methods, *libraries]:
            self._copy(Path(program))
        for name in ("tmp", "dev", "usr/local/bin", "etc/apt/apt.conf.d", "etc/apt/preferences.d", "etc/apt/sources.list.d", "var/lib/apt/lists/partial",
                     "var/cache/apt/archives/partial", "var/lib/dpkg/info", "var/lib/dpkg/updates", "var/log/apt"):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
        try:
            os.mknod(self.folder / "dev/null", 0o20666, os.makedev(1, 3))
        except PermissionError:
            # Containers may forbid devices; a file takes as much.
            (self.folder / "dev/null").touch()
        (self.folder / "dev/null").chmod(0o666)
        if not shutil.which("dpkg"):
            return
        shutil.copytree("/usr/share/dpkg", self.folder / "usr/share/dpkg", ignore=shutil.ignore_patterns("*.mk", "*.sh"))
        # There are no other users.
        (self.folder / "etc/apt/apt.conf").write_text('APT::Sandbox::User "root";\n')
        # What is there, for the dependencies of packages: the C library, and what that stands on.
        installed = re.findall(r"^((?:libc6|libgcc-s1|gcc-\d+-base)(?::\w+)?)$", done(["dpkg-query", "-W", "-f", "${binary:Package}\n"]), re.M)
        status = "\n".join(done(["dpkg-query", "-s", name]) for name in installed)
        (self.folder / "var/lib/dpkg/status").write_text(status)

    def _copy(self, file, to=None):
        """Copies a program with the libraries of the system that it needs."""
        there = self.folder / str(to or file).lstrip("/")
        if there.exists():
            return
        there.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, there)
        listed = subprocess.run(["ldd", file], capture_output=True, text=True, check=False).stdout
        for library in re.findall(r"(/\S+) \(0x", listed):
            self._copy(Path(library))

    def _command(self, line):
        if HAS_ROOT:
            return ["chroot", self.folder, "/bin/sh", "-ec", f"cd /home\nexec {line.removeprefix('sudo ')}"], {"PATH": SYSTEM_PATH, "HOME": "/home"}
        name, *words = shlex.split(line)
        if name != "okoshi":
            fail(f"`{line}` is not a command of okoshi")
        # Windows programs do not start without the variable.
        system = {name: os.environ[name] for name in ("SYSTEMROOT",) if name in os.environ}
        return [self.okoshi, *words], {"PATH": "", "HOME": str(self.home), "USERPROFILE": str(self.home), **system}

    def run(self, line):
        command, environment = self._command(line)
        return done(command, env={**environment, "DEBIAN_FRONTEND": "noninteractive"}, cwd=self.home)

    def start(self, line):
        """Starts a command that stays."""
        command, environment = self._command(line)
        return subprocess.Popen([str(part) for part in command], cwd=self.home, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)

    def take(self, program):
        """Puts a program that was installed elsewhere on the path."""
        self.okoshi = program
        if HAS_ROOT:
            self._copy(program, "usr/local/bin/okoshi")


def unpacked(package, folder):
    """The program of an archive or a Debian package, unpacked."""
    if package.suffix == ".deb":
        done(["dpkg-deb", "-x", package, folder])
    elif package.suffix == ".zip":
        zipfile.ZipFile(package).extractall(folder)
    else:
        with tarfile.open(package) as tar:
            tar.extractall(folder, filter="data")
    return next(path for path in sorted(folder.rglob("bin/okoshi*")) if path.is_file())


def into_system(room, package, commands):
    """Installs a package for everybody, in a root folder; elsewhere it is unpacked."""
    if not HAS_ROOT:
        return room.take(unpacked(package, room.folder / "unpacked"))
    shutil.copy(package, room.home)
    for command in commands:
        room.run(command)
    (room.home / package.name).unlink()
    for name in ("man/man1/okoshi.1", "man/man1/okoshi-build.1", "bash-completion/completions/okoshi"):
        if not any((room.folder / prefix / "share" / name).exists() for prefix in ("usr", "usr/local")):
            fail(f"{package.name} does not bring {name}")


def into_folder(room, package, commands, path, **environment):
    """Installs a package with the tool of a language, whose programs alone are on the path."""
    for command in commands:
        name, *words = shlex.split(command)
        words = [match for word in words for match in (sorted(glob.glob(word, root_dir=package.parent)) or [word])]
        words = [f"./{word}" if (package.parent / word).is_file() else word for word in words]
        tool = shutil.which(name, path=path)
        if tool is None:
            fail(f"docs/install.md installs {package.name} with `{name}`, which is not there")
        done([tool, *words], cwd=package.parent, env={**os.environ, "PATH": path, **environment})


def by_pip(room, package, commands):
    python = room.folder / "python"
    venv.create(python, with_pip=True)
    scripts = python / ("Scripts" if os.name == "nt" else "bin")
    into_folder(room, package, commands, str(scripts), PIP_NO_INDEX="1", PIP_DISABLE_PIP_VERSION_CHECK="1")
    room.take(Path(shutil.which("okoshi", path=str(scripts))).resolve())


def by_npm(room, package, commands):
    prefix = room.folder / "npm"
    path = os.pathsep.join(sorted({str(Path(shutil.which(name)).parent) for name in ("node", "npm")}))
    settings = {"npm_config_prefix": prefix, "npm_config_cache": room.folder / "cache", "npm_config_offline": "true", "npm_config_audit": "false"}
    into_folder(room, package, commands, path, **{name: str(value) for name, value in settings.items()})
    scripts = prefix if os.name == "nt" else prefix / "bin"
    room.take(Path(shutil.which("okoshi", path=str(scripts))).resolve())


# ---- What comes out

def moves(glb, name):
    """Whether a model has a clip of this name in which a part turns by more than a few degrees."""
    data = glb.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    model, start = json.loads(data[20:20 + length]), 28 + length
    for clip in model.get("animations", []):
        for channel in clip["channels"] if clip.get("name") == name else []:
            if channel["target"]["path"] != "rotation":
                continue
            keys = model["accessors"][clip["samplers"][channel["sampler"]]["output"]]
            view = model["bufferViews"][keys["bufferView"]]
            at = start + view.get("byteOffset", 0) + keys.get("byteOffset", 0)
            turns = [struct.unpack_from("<4f", data, at + 16 * key) for key in range(keys["count"])]
            if any(abs(sum(a * b for a, b in zip(turns[0], turn))) < 0.99 for turn in turns):
                return True
    return False


def followed(room, what, to_the_end):
    """Does what a page says in a fresh folder, to its end or only until there is a model, and checks that a figure walks."""
    server, model = None, room.home / "me.glb"
    try:
        for kind, step in what:
            if kind == "draw":
                shutil.copy(step, room.home / "me.svg")
            elif step.startswith("okoshi preview "):
                server = room.start(step)
                address = server.stdout.readline().strip()
                with DIRECTLY.open(address, timeout=60) as page:
                    text = page.read().decode()
                if "page.js" not in text:
                    fail(f"`{step}` shows no page at {address}: {text[:300]}")
            else:
                room.run(step)
            if model.exists() and not to_the_end:
                break
        if server is None or server.poll() is not None:
            fail("the preview ended by itself")
    finally:
        if server is not None:
            server.kill()
            server.wait()
    if not moves(model, "walk"):
        fail("me.glb does not walk")
    for _, step in what if to_the_end else ():
        if made := re.search(r" -o (\S+)", step if isinstance(step, str) else ""):
            if (room.home / made[1]).stat().st_size < 10_000:
                fail(f"`{step}` made next to nothing")
    for file in room.home.iterdir():
        file.unlink()


def tried(package, scratch, to_the_end):
    """Installs a package as the page says, follows the tutorial and the README's first screen, and returns the number of commands of each.

    Films take long, and are the same with every package: without `to_the_end`, what the pages do with the model is left out.
    """
    ending = "".join(re.findall(r"\.tar\.gz$|\.[a-z]+$", package.name))
    # The archive of Windows is unpacked by hand.
    commands = [] if ending == ".zip" else installation(ending)
    room = Room(scratch / ending.lstrip("."))
    install = {".whl": by_pip, ".tgz": by_npm}.get(ending, into_system)
    install(room, package, commands)
    counts = []
    for page in (steps(ROOT / "docs/tutorial.md"), first_screen()):
        count = len(commands) + sum(1 for kind, _ in page if kind == "run")
        if count >= MOST_COMMANDS:
            fail(f"{package.name}: {count} commands to a walking figure, and not fewer than {MOST_COMMANDS}")
        followed(room, page, to_the_end)
        counts.append(count)
    return counts
