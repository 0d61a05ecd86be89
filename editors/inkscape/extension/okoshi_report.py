"""What *Check Strings* and *Suggest Strings* show: a window of its own (`okoshi_window`), or a message where there can be none."""

import json
import os
import subprocess
import sys
import threading

from okoshi_cache import folder_of, is_locked, write_atomic
from okoshi_findings import count
from okoshi_previews import DETACHED

REPORT, WINDOW_LOCK = "report.json", "window.lock"
# How long the window may take to open, in seconds.
TIMEOUT = 20


def make_report(drawing, found, detail="", note="", headline=None):
    """A report for the window: the findings, a headline, which else is their number, a line below it, and advice."""
    if headline is None:
        headline = "%s in %s" % (count(found) or "No problems", drawing.name)
    return {"name": drawing.name, "headline": headline, "detail": detail, "note": note.strip(), "findings": found}


def show_report(drawing, report):
    """Shows a report in the drawing's window. Returns whether there is one."""
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return False
    folder = folder_of(drawing)
    os.makedirs(folder, mode=0o700, exist_ok=True)
    write_atomic(os.path.join(folder, REPORT), json.dumps(report).encode())
    # An open window follows the file.
    return is_locked(folder, WINDOW_LOCK) or open_window(folder)


def open_window(folder):
    """Opens the window, in a process that outlives us. Returns whether it could be opened."""
    options = {"creationflags": DETACHED} if sys.platform == "win32" else {"start_new_session": True}
    window = os.path.join(os.path.dirname(os.path.abspath(__file__)), "okoshi_window.py")
    process = subprocess.Popen(
        [sys.executable, window, folder],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        # Inkscape would wait for the window to close its stderr.
        stderr=subprocess.DEVNULL,
        **options
    )
    late = threading.Timer(TIMEOUT, process.kill)
    late.start()
    line = process.stdout.readline()
    late.cancel()
    process.stdout.close()
    # Not waited for. Otherwise Python would warn, and inkex shows all warnings in a window.
    process.returncode = 0
    return bool(line)
