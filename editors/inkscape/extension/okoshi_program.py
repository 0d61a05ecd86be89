"""Where the program okoshi is, and how it is run."""

import os
import shutil
import subprocess
import sys

# Of the script that Inkscape calls: a module's own place is another one where the files are links.
HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
# What the install script notes: one line, the program's path.
NOTE = "okoshi.path"
# Of subprocess, which has it from Python 3.7 on, and on Windows alone.
CREATE_NO_WINDOW = 0x08000000


class Missing(Exception):
    """There is no okoshi; the message says what to do."""


def find(environ=None, folder=HERE):
    """The path of okoshi: by the variable `OKOSHI`, the note of the install script, `PATH`, or cargo's folder.

    `folder` is where the note lies. Raises `Missing`. Programs that a desktop starts often lack what a shell adds to `PATH`,
    hence the note and cargo's folder.
    """
    environ = os.environ if environ is None else environ
    named = environ.get("OKOSHI")
    if named:
        found = shutil.which(os.path.expanduser(named), path=environ.get("PATH"))
        if found is None:
            raise Missing("The environment variable OKOSHI names `%s`, and there is no such program." % named)
        return os.path.abspath(found)
    looked = []
    for place in (noted(folder), "okoshi", os.path.join(home(environ), ".cargo", "bin", "okoshi")):
        if place is None:
            continue
        found = shutil.which(place, path=environ.get("PATH"))
        if found is not None:
            return os.path.abspath(found)
        looked.append("the PATH" if place == "okoshi" else place)
    raise Missing(
        "The program okoshi was not found. Looked at: %s.\n\n"
        "To install it, run `cargo install --path .` in okoshi's folder. If it is installed elsewhere, run\n"
        "`editors/inkscape/install.sh --okoshi /path/to/okoshi`, or set the environment variable OKOSHI\n"
        "to its path before Inkscape is started." % ", ".join(looked)
    )


def noted(folder):
    """The path that the install script noted, or None."""
    try:
        with open(os.path.join(folder, NOTE), encoding="utf-8-sig") as note:
            return note.readline().strip() or None
    except OSError:
        return None


def home(environ):
    """The person's own folder."""
    return environ.get("HOME") or os.path.expanduser("~")


def environment():
    """The environment for okoshi: ours, without what Inkscape has set for Python."""
    ours = ("PYTHONPATH", "PYTHONHOME", "PYTHONIOENCODING")
    return {name: value for name, value in os.environ.items() if name not in ours and not name.startswith("INKEX_")}


def run(arguments, folder=None):
    """Runs okoshi in `folder`: exit status, and what it said on stdout and stderr, as texts."""
    return call([find(), "--color", "never"] + list(arguments), folder)


def call(command, folder=None):
    """Runs a command in `folder`: exit status, stdout, stderr. Raises `Missing` if it cannot be started."""
    try:
        process = subprocess.Popen(
            command,
            cwd=folder,
            env=environment(),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            creationflags=CREATE_NO_WINDOW if sys.platform == "win32" else 0,
        )
    except OSError as error:
        raise Missing("`%s` cannot be started: %s" % (command[0], error))
    said, complained = process.communicate()
    return process.returncode, said.decode("utf-8", "replace"), complained.decode("utf-8", "replace")
