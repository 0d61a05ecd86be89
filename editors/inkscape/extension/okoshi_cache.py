"""Folders in the user's cache, one for each drawing, with locks.

A lock, not a process id, shows whether a process is running: the system releases it however the process ends, while process ids are
reused.
"""

import hashlib
import os
import shutil
import sys
import time
from contextlib import contextmanager

# How long is waited for another process, in seconds.
TIMEOUT = 20


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


def lock(folder, name):
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


@contextmanager
def held(folder, name):
    """Waits for a lock of the folder, and holds it. Raises `Failed` if another process keeps it."""
    end = time.monotonic() + TIMEOUT
    taken = lock(folder, name)
    while taken is None:
        if time.monotonic() > end:
            raise Failed("Another process has the file `%s` locked." % os.path.join(folder, name))
        time.sleep(0.05)
        taken = lock(folder, name)
    try:
        yield
    finally:
        taken.close()


def is_locked(folder, name):
    """Whether a process holds a lock of the folder."""
    if not os.path.isdir(folder):
        return False
    taken = lock(folder, name)
    if taken is not None:
        taken.close()
    return taken is None


def read(path):
    """The content of a file, or None if there is none."""
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError:
        return None


def write_atomic(path, data):
    """Replaces a file atomically."""
    temporary = path + ".new"
    with open(temporary, "wb") as file:
        file.write(data)
    os.replace(temporary, path)


def remove(path):
    """Removes a file or folder, if it exists."""
    try:
        if os.path.isdir(path):
            shutil.rmtree(path)
        else:
            os.remove(path)
    except OSError:
        pass
