"""The servers of *Preview in 3D*: one for each drawing, each with a folder in the user's cache.

The folder contains a copy of the canvas (`okoshi_canvas`), which the server watches beside the drawing itself, `server.json` with process,
port and copy, and `lock`, which the process that runs the server (`okoshi_follow`) holds.
"""

import json
import os
import re
import socket
import subprocess
import sys
import time
import webbrowser

from okoshi_cache import TIMEOUT, Failed, cache, folder_of, is_locked, remove
from okoshi_canvas import changed, renew

STATE, LOCK, LOG, STOP = "server.json", "lock", "log.txt", "stop"
# Constants that subprocess has on Windows only: DETACHED_PROCESS, CREATE_NEW_PROCESS_GROUP.
DETACHED = 0x00000008 | 0x00000200


def is_running(folder):
    """Whether a server is running for this folder."""
    return is_locked(folder, LOCK)


def read_state(folder):
    """The content of `server.json`, or None if there is none."""
    try:
        with open(os.path.join(folder, STATE), encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return None


def show(program, drawing):
    """Opens the preview of the drawing on the canvas; starts a server if there is none.

    Returns None, or the page's address if there is no browser. Raises `Failed` with the server's output.
    """
    folder = folder_of(drawing)
    os.makedirs(folder, mode=0o700, exist_ok=True)
    if is_running(folder):
        page = wait(folder)
        renew(folder, read_state(folder)["copy"], drawing.data)
    else:
        start(program, drawing, folder)
        page = wait(folder)
    return open_page(page)


def copy_of(folder, drawing):
    """The path of the copy of a drawing's canvas, whether there is one or not."""
    return os.path.join(folder, drawing.name)


def start(program, drawing, folder):
    """Starts the process that runs a server, detached from Inkscape."""
    for old in (STATE, STOP, LOG):
        remove(os.path.join(folder, old))
    copy = copy_of(folder, drawing)
    renew(folder, copy, drawing.data)
    root = drawing.root
    if root is None:
        root = os.path.join(folder, "links")
        os.makedirs(root, exist_ok=True)
    follower = os.path.join(os.path.dirname(os.path.abspath(__file__)), "okoshi_follow.py")
    log = os.path.join(folder, LOG)
    with open(log, "wb") as output:
        detach([sys.executable, follower, program, copy, drawing.original or "", root, folder, str(free_port())], output)


def wait(folder):
    """Waits for the server. Returns the address of the page."""
    end = time.monotonic() + TIMEOUT
    # The process takes its lock a moment after it was started.
    begun = time.monotonic() + 3
    while time.monotonic() < end:
        state = read_state(folder)
        if state is not None and answers(state["port"]):
            return address(folder, state["port"])
        if time.monotonic() > begun and not is_running(folder):
            break
        if state is not None and state.get("ended"):
            break
        time.sleep(0.05)
    output = log_of(folder)
    if "unrecognized subcommand" in output or "unexpected argument '--unsaved'" in output:
        raise Failed("This okoshi is too old to preview: install a newer one.\n\n" + output)
    raise Failed("The preview could not be started.\n\n" + (output or "There was no output."))


def answers(port):
    """Whether something listens on a local port."""
    try:
        socket.create_connection(("127.0.0.1", port), timeout=1).close()
    except OSError:
        return False
    return True


def address(folder, port):
    """The page's address from the server's output, otherwise its root."""
    found = re.search(r"http://(?:127\.0\.0\.1|localhost):%d[^\s\x1b\"'`]*" % port, log_of(folder))
    return found.group() if found else "http://127.0.0.1:%d/" % port


def log_of(folder):
    """The end of the server's output."""
    try:
        with open(os.path.join(folder, LOG), "rb") as file:
            return file.read()[-4000:].decode("utf-8", "replace").strip()
    except OSError:
        return ""


def open_page(page):
    """Opens the browser. Returns None, or the address if there is no browser."""
    try:
        webbrowser.get()
    except webbrowser.Error:
        return page
    # In its own process: a browser that inherits our stdout would block Inkscape until it is closed.
    detach([sys.executable, "-m", "webbrowser", "-t", page], subprocess.DEVNULL)
    return None


def detach(command, output):
    """Starts a process that outlives us and Inkscape, and writes to `output`."""
    options = {"creationflags": DETACHED} if sys.platform == "win32" else {"start_new_session": True}
    process = subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=output, stderr=output, cwd=os.path.expanduser("~"), **options
    )
    # Not waited for. Otherwise Python would warn, and inkex shows all warnings in a window.
    process.returncode = 0


def free_port():
    """An unused port."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def folders():
    """The folders of all drawings."""
    try:
        return [os.path.join(cache(), name) for name in sorted(os.listdir(cache()))]
    except OSError:
        return []


def waiting():
    """The names of the drawings whose page has changes that were not taken in."""
    states = [(folder, read_state(folder)) for folder in folders()]
    return [os.path.basename(state["copy"]) for folder, state in states if state is not None and changed(folder, state["copy"])]


def stop_all():
    """Stops all servers. Returns their number."""
    number = 0
    for folder in folders():
        if not is_running(folder):
            continue
        number += 1
        with open(os.path.join(folder, STOP), "wb"):
            pass
        end = time.monotonic() + TIMEOUT
        while is_running(folder):
            if time.monotonic() > end:
                raise Failed("A preview could not be stopped: process %s." % (read_state(folder) or {}).get("pid"))
            time.sleep(0.05)
    return number
