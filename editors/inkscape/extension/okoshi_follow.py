"""Runs `okoshi preview` on a copy of a drawing, and updates the copy when the drawing is saved.

Arguments: program, copy, original (may be empty), root of links, folder of the preview, port. It exits with the server, when the
file `stop` appears in the folder, or when nothing was shown or saved for half a day; then it removes the copy.
"""

import json
import os
import signal
import subprocess
import sys
import time

from okoshi_previews import STATE, STOP, lock, remove, write_atomic
from okoshi_program import CREATE_NO_WINDOW, environment

# In seconds: the interval between polls, and the time until an unused server is stopped.
PAUSE = 0.25
IDLE = 12 * 60 * 60


def stamp(path):
    """Changes whenever a file does; None if it is missing."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size


class Follower:
    """Copies a drawing that was saved once it is unchanged between two polls: Inkscape writes in place, in pieces."""

    def __init__(self, original, copy):
        self.original = original
        self.copy = copy
        self.taken = self.seen = stamp(original)

    def poll(self):
        """Copies the drawing if it changed and has settled."""
        now = stamp(self.original)
        settled, self.seen = now == self.seen, now
        if now is None or now == self.taken or not settled or now[1] == 0:
            return
        try:
            with open(self.original, "rb") as file:
                data = file.read()
        except OSError:
            return
        # If it was written to while it was read, the next poll copies it.
        if stamp(self.original) == now:
            write_atomic(self.copy, data)
            self.taken = now


def take_lock(folder):
    """Takes the folder's lock, or None. Other processes that test the lock hold it for a moment."""
    for _ in range(40):
        taken = lock(folder)
        if taken is not None:
            return taken
        time.sleep(0.05)
    return None


def run_until_stopped(server, follower, folder, copy):
    """Waits until the server exits or should be stopped."""
    while server.poll() is None:
        if os.path.exists(os.path.join(folder, STOP)):
            return
        try:
            if time.time() - os.stat(copy).st_mtime > IDLE:
                return
        except OSError:
            return
        if follower is not None:
            follower.poll()
        time.sleep(PAUSE)


def main(program, copy, original, root, folder, port):
    """Runs until the preview ends."""
    held = take_lock(folder)
    if held is None:
        # Another process serves the same drawing already.
        return
    state = {"pid": os.getpid(), "port": int(port), "copy": copy}
    follower = Follower(original, copy) if original else None
    command = [program, "--color", "never", "preview", copy, "--base", root, "--port", port]
    server = None
    try:
        for name in ("SIGTERM", "SIGHUP"):
            if hasattr(signal, name):
                signal.signal(getattr(signal, name), lambda *_: sys.exit(0))
        server = subprocess.Popen(
            command,
            cwd=folder,
            env=environment(),
            stdin=subprocess.DEVNULL,
            creationflags=CREATE_NO_WINDOW if sys.platform == "win32" else 0,
        )
        write_atomic(os.path.join(folder, STATE), json.dumps(state).encode())
        run_until_stopped(server, follower, folder, copy)
    finally:
        if server is not None and server.poll() is None:
            server.terminate()
            try:
                server.wait(5)
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()
        for path in (copy, os.path.join(folder, STOP)):
            remove(path)
        state["ended"] = True
        write_atomic(os.path.join(folder, STATE), json.dumps(state).encode())
        held.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
