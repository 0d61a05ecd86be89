"""The servers of *Preview in 3D*: one for each drawing, each with a folder in the user's cache.

The folder contains a copy of the canvas, which the server watches beside the drawing itself, `server.json` with process, port and
copy, and `lock`, which the process that runs the server (`okoshi_follow`) holds. The lock, not a process id, shows whether a server is
running: the system releases it however the process ends, while process ids are reused.
"""

import hashlib
import json
import os
import re
import shutil
import socket
import subprocess
import sys
import time
import webbrowser

STATE, LOCK, LOG, STOP = "server.json", "lock", "log.txt", "stop"
# How long a server may take to start or stop, in seconds.
TIMEOUT = 20
# Constants that subprocess has on Windows only: DETACHED_PROCESS, CREATE_NEW_PROCESS_GROUP.
DETACHED = 0x00000008 | 0x00000200


class Failed(Exception):
    """An error with a message for the user."""


def cache():
    """The folder of all previews."""
    home = os.path.expanduser("~")
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA") or os.path.join(home, "AppData", "Local")
    elif sys.platform == "darwin":
        base = os.path.join(home, "Library", "Caches")
    else:
        base = os.environ.get("XDG_CACHE_HOME") or os.path.join(home, ".cache")
    return os.path.join(base, "okoshi", "inkscape")


def folder_of(drawing):
    """The folder of a drawing's preview, by its path; drawings that were never saved share one."""
    place = os.path.realpath(drawing.original) if drawing.original else "never saved"
    return os.path.join(cache(), hashlib.sha256(place.encode("utf-8", "surrogatepass")).hexdigest()[:16])


def lock(folder, name=LOCK):
    """Takes a lock of the folder. Returns the open file, which holds the lock, or None if another process has it."""
    file = open(os.path.join(folder, name), "a+b")
    try:
        if sys.platform == "win32":
            import msvcrt

            file.seek(0)
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        file.close()
        return None
    return file


def is_running(folder):
    """Whether a server is running for this folder."""
    return is_locked(folder, LOCK)


def is_locked(folder, name):
    """Whether a process holds a lock of the folder."""
    if not os.path.isdir(folder):
        return False
    taken = lock(folder, name)
    if taken is not None:
        taken.close()
    return taken is None


def read_state(folder):
    """The content of `server.json`, or None if there is none."""
    try:
        with open(os.path.join(folder, STATE), encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return None


def write_atomic(path, data):
    """Replaces a file atomically."""
    temporary = path + ".new"
    with open(temporary, "wb") as file:
        file.write(data)
    os.replace(temporary, path)


def show(program, drawing):
    """Opens the preview of the drawing on the canvas; starts a server if there is none.

    Returns None, or the page's address if there is no browser. Raises `Failed` with the server's output.
    """
    folder = folder_of(drawing)
    os.makedirs(folder, mode=0o700, exist_ok=True)
    if is_running(folder):
        page = wait(folder)
        write_atomic(read_state(folder)["copy"], drawing.data)
    else:
        start(program, drawing, folder)
        page = wait(folder)
    return open_page(page)


def start(program, drawing, folder):
    """Starts the process that runs a server, detached from Inkscape."""
    for old in (STATE, STOP, LOG):
        remove(os.path.join(folder, old))
    copy = os.path.join(folder, drawing.name)
    write_atomic(copy, drawing.data)
    root = drawing.root
    if root is None:
        root = os.path.join(folder, "links")
        os.makedirs(root, exist_ok=True)
    follower = os.path.join(os.path.dirname(os.path.abspath(__file__)), "okoshi_follow.py")
    log = os.path.join(folder, LOG)
    original = drawing.original or ""
    if not original.lower().endswith(".svg"):
        original = ""
    with open(log, "wb") as output:
        detach([sys.executable, follower, program, copy, original, root, folder, str(free_port())], output)


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


def stop_all():
    """Stops all servers. Returns their number."""
    try:
        names = sorted(os.listdir(cache()))
    except OSError:
        return 0
    number = 0
    for folder in (os.path.join(cache(), name) for name in names):
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


def remove(path):
    """Removes a file or folder, if it exists."""
    try:
        if os.path.isdir(path):
            shutil.rmtree(path)
        else:
            os.remove(path)
    except OSError:
        pass
