"""Finds and runs the program okoshi."""

import os
import shutil
import subprocess
import sys

# The folder of the script that Inkscape calls, not of this module: installed files may be links.
HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
# Written by the install script: one line with the program's path.
NOTE = "okoshi.path"
# A constant that subprocess has on Windows only, since Python 3.7.
CREATE_NO_WINDOW = 0x08000000


class Missing(Exception):
    """okoshi was not found; the message says what to do."""


def find(environ=None, folder=HERE):
    """The path of okoshi: from the variable `OKOSHI`, the install script's file, the `PATH`, or cargo's folder.

    `folder` contains the install script's file. Raises `Missing`. Programs started from a desktop often lack what a shell adds to
    the `PATH`, hence that file and cargo's folder.
    """
    environ = os.environ if environ is None else environ
    named = environ.get("OKOSHI")
    if named:
        found = shutil.which(os.path.expanduser(named), path=environ.get("PATH"))
        if found is None:
            raise Missing("The environment variable OKOSHI is set to `%s`, which is not a program." % named)
        return os.path.abspath(found)
    looked = []
    for place in (installed_path(folder), "okoshi", os.path.join(home(environ), ".cargo", "bin", "okoshi")):
        if place is None:
            continue
        found = shutil.which(place, path=environ.get("PATH"))
        if found is not None:
            return os.path.abspath(found)
        looked.append("the PATH" if place == "okoshi" else place)
    raise Missing(
        "The program okoshi was not found. Looked at: %s.\n\n"
        "Install one of okoshi's packages, with `pip install okoshi-*.whl` for instance. If it is installed elsewhere,\n"
        "run `install.sh --okoshi /path/to/okoshi`, on Windows `install.ps1 -Okoshi C:\\path\\to\\okoshi.exe`, or set\n"
        "the environment variable OKOSHI to its path before Inkscape is started." % ", ".join(looked)
    )


def installed_path(folder):
    """The path that the install script wrote, or None."""
    try:
        with open(os.path.join(folder, NOTE), encoding="utf-8-sig") as note:
            return note.readline().strip() or None
    except OSError:
        return None


def home(environ):
    """The user's home folder."""
    return environ.get("HOME") or os.path.expanduser("~")


def environment():
    """Our environment without the variables that Inkscape sets for Python."""
    ours = ("PYTHONPATH", "PYTHONHOME", "PYTHONIOENCODING")
    return {name: value for name, value in os.environ.items() if name not in ours and not name.startswith("INKEX_")}


def run(arguments, folder=None):
    """Runs okoshi in `folder`. Returns exit status, stdout and stderr, as text."""
    return call([find(), "--color", "never"] + list(arguments), folder)


def call(command, folder=None):
    """Runs a command in `folder`. Returns exit status, stdout and stderr, as text. Raises `Missing` if it cannot be started."""
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
    output, errors = process.communicate()
    return process.returncode, output.decode("utf-8", "replace"), errors.decode("utf-8", "replace")
