"""Keeps one preview: runs `okoshi preview` on the copy of a drawing, and brings the copy up to date when the drawing is saved.

Arguments: program, copy, original (empty: none), root of links, folder of the preview, port. It ends with the server, when
the file `stop` appears in the folder, or when nothing was shown or saved for half a day; then the copy is removed.
"""

import json
import os
import signal
import subprocess
import sys
import time

from okoshi_previews import STATE, STOP, lock, remove, write_whole
from okoshi_program import CREATE_NO_WINDOW, environment

# In seconds: how often files are looked at, how long a server is kept.
PAUSE = 0.25
IDLE = 12 * 60 * 60


def stamp(path):
    """What tells one state of a file from another; None if it is not there."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size


class Follower:
    """Takes over what is saved, as soon as it has been the same at two looks: Inkscape writes in place, in pieces."""

    def __init__(self, original, copy):
        self.original = original
        self.copy = copy
        self.taken = self.seen = stamp(original)

    def look(self):
        """Looks once; copies if there is something new that has settled."""
        now = stamp(self.original)
        settled, self.seen = now == self.seen, now
        if now is None or now == self.taken or not settled or now[1] == 0:
            return
        try:
            with open(self.original, "rb") as file:
                data = file.read()
        except OSError:
            return
        # Written to while it was read: the next look sees it.
        if stamp(self.original) == now:
            write_whole(self.copy, data)
            self.taken = now


def take_lock(folder):
    """The folder's lock; a look by another process holds it for a moment."""
    for _ in range(40):
        taken = lock(folder)
        if taken is not None:
            return taken
        time.sleep(0.05)
    return None


def keep(server, follower, folder, copy):
    """Until there is a reason to end."""
    while server.poll() is None:
        if os.path.exists(os.path.join(folder, STOP)):
            return
        try:
            if time.time() - os.stat(copy).st_mtime > IDLE:
                return
        except OSError:
            return
        if follower is not None:
            follower.look()
        time.sleep(PAUSE)


def main(program, copy, original, root, folder, port):
    """Runs until the preview ends."""
    held = take_lock(folder)
    if held is None:
        # Another one was faster, and serves the same drawing.
        return
    state = {"pid": os.getpid(), "port": int(port), "copy": copy}
    follower = Follower(original, copy) if original else None
    command = [program, "--color", "never", "preview", copy, "--root", root, "--port", port]
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
        write_whole(os.path.join(folder, STATE), json.dumps(state).encode())
        keep(server, follower, folder, copy)
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
        write_whole(os.path.join(folder, STATE), json.dumps(state).encode())
        held.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
