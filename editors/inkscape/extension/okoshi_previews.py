"""The servers behind *Preview in 3D*: one a drawing, each in a folder of the person's cache.

In the folder lie a copy of the drawing, which the server watches, `server.json` with process, port and copy, and `lock`, which
the process that keeps the server (`okoshi_follow`) holds as long as it lives. The lock, not the number of a process, tells
whether a server is there: the system takes it back however the process ends, and numbers are used again.
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
# How long a server may take to answer, in seconds.
PATIENCE = 20
# Of subprocess, on Windows alone: DETACHED_PROCESS, CREATE_NEW_PROCESS_GROUP.
DETACHED = 0x00000008 | 0x00000200


class Failed(Exception):
    """It did not work; the message says why."""


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
    """The folder of a drawing's preview, by where the drawing lies; drawings without a place share one."""
    place = os.path.realpath(drawing.original) if drawing.original else "never saved"
    return os.path.join(cache(), hashlib.sha256(place.encode("utf-8", "surrogatepass")).hexdigest()[:16])


def lock(folder):
    """Takes the folder's lock: the open file to be kept, or None if another process has it."""
    file = open(os.path.join(folder, LOCK), "a+b")
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


def lives(folder):
    """Whether there is a process that keeps a server for this folder."""
    if not os.path.isdir(folder):
        return False
    taken = lock(folder)
    if taken is not None:
        taken.close()
    return taken is None


def read_state(folder):
    """What `server.json` says, or None while there is none."""
    try:
        with open(os.path.join(folder, STATE), encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return None


def write_whole(path, data):
    """Writes a file so that a reader sees the old one or the new one."""
    temporary = path + ".new"
    with open(temporary, "wb") as file:
        file.write(data)
    os.replace(temporary, path)


def show(program, drawing):
    """Opens the page of what is on the canvas; starts a server if the drawing has none.

    Returns None, or the page's address if there is no browser to open it. Raises `Failed` with what the server said.
    """
    folder = folder_of(drawing)
    os.makedirs(folder, mode=0o700, exist_ok=True)
    if lives(folder):
        page = wait(folder)
        write_whole(read_state(folder)["copy"], drawing.data)
    else:
        start(program, drawing, folder)
        page = wait(folder)
    return open_page(page)


def start(program, drawing, folder):
    """Starts a server, and the process that keeps it, apart from Inkscape."""
    for old in (STATE, STOP, LOG):
        remove(os.path.join(folder, old))
    copy = os.path.join(folder, drawing.name)
    write_whole(copy, drawing.data)
    root = drawing.root
    if root is None:
        root = os.path.join(folder, "links")
        os.makedirs(root, exist_ok=True)
    follower = os.path.join(os.path.dirname(os.path.abspath(__file__)), "okoshi_follow.py")
    log = os.path.join(folder, LOG)
    original = drawing.original or ""
    if not original.lower().endswith(".svg"):
        original = ""
    with open(log, "wb") as said:
        detach([sys.executable, follower, program, copy, original, root, folder, str(free_port())], said)


def wait(folder):
    """The address of the page, as soon as the server answers."""
    end = time.monotonic() + PATIENCE
    # The process takes its lock a moment after it is started.
    begun = time.monotonic() + 3
    while time.monotonic() < end:
        state = read_state(folder)
        if state is not None and answers(state["port"]):
            return address(folder, state["port"])
        if time.monotonic() > begun and not lives(folder):
            break
        if state is not None and state.get("ended"):
            break
        time.sleep(0.05)
    said = log_of(folder)
    if "unrecognized subcommand" in said:
        raise Failed("This okoshi is too old to preview: install a newer one.\n\n" + said)
    raise Failed("The preview could not be started.\n\n" + (said or "okoshi said nothing."))


def answers(port):
    """Whether something listens at a port of this machine."""
    try:
        socket.create_connection(("127.0.0.1", port), timeout=1).close()
    except OSError:
        return False
    return True


def address(folder, port):
    """The page's address: what the server said, else its root."""
    said = re.search(r"http://(?:127\.0\.0\.1|localhost):%d[^\s\x1b\"'`]*" % port, log_of(folder))
    return said.group() if said else "http://127.0.0.1:%d/" % port


def log_of(folder):
    """The end of what the server said."""
    try:
        with open(os.path.join(folder, LOG), "rb") as file:
            return file.read()[-4000:].decode("utf-8", "replace").strip()
    except OSError:
        return ""


def open_page(page):
    """Opens the browser. None, or the address if there is none."""
    try:
        webbrowser.get()
    except webbrowser.Error:
        return page
    # A process of its own: a browser that holds our stdout would keep Inkscape waiting until it is closed.
    detach([sys.executable, "-m", "webbrowser", "-t", page], subprocess.DEVNULL)
    return None


def detach(command, said):
    """Starts a process that outlives us and Inkscape, and writes to `said`."""
    options = {"creationflags": DETACHED} if sys.platform == "win32" else {"start_new_session": True}
    process = subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=said, stderr=said, cwd=os.path.expanduser("~"), **options
    )
    # It is not ours to wait for. Else Python warns of it, and inkex has all warnings shown in a window.
    process.returncode = 0


def free_port():
    """A port that nothing listens at."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def stop_all():
    """Ends all servers: how many there were."""
    try:
        names = sorted(os.listdir(cache()))
    except OSError:
        return 0
    number = 0
    for folder in (os.path.join(cache(), name) for name in names):
        if not lives(folder):
            continue
        number += 1
        with open(os.path.join(folder, STOP), "wb"):
            pass
        end = time.monotonic() + PATIENCE
        while lives(folder):
            if time.monotonic() > end:
                raise Failed("A preview does not end: process %s." % (read_state(folder) or {}).get("pid"))
            time.sleep(0.05)
    return number


def remove(path):
    """Removes a file or folder, if it is there."""
    try:
        if os.path.isdir(path):
            shutil.rmtree(path)
        else:
            os.remove(path)
    except OSError:
        pass
