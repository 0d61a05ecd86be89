"""Runs `okoshi preview` for a drawing: of its own file and of a copy of the canvas, it shows the one that was written last.

Arguments: program, copy, original (may be empty), root of links, folder of the preview, port. It exits with the server, when the
file `stop` appears in the folder, or when nothing was shown or saved for half a day; then it removes the copy, unless that has changes
that were not taken in. When the drawing is saved, what the page has changed in the copy is changed in a copy of what was saved.
"""

import json
import os
import signal
import subprocess
import sys
import time

from okoshi_cache import lock, read, remove, write_atomic
from okoshi_canvas import BASE, changed, renew
from okoshi_previews import LOCK, STATE, STOP
from okoshi_program import CREATE_NO_WINDOW, environment

# In seconds: how often is looked whether the server is still wanted, and the time until an unused server is stopped.
PAUSE = 0.25
IDLE = 12 * 60 * 60


def take_lock(folder):
    """Takes the folder's lock, or None. Other processes that test the lock hold it for a moment."""
    for _ in range(40):
        taken = lock(folder, LOCK)
        if taken is not None:
            return taken
        time.sleep(0.05)
    return None


def preview_command(program, copy, original, root, port):
    """The command of the server. Only the copy is shown if the drawing was never saved, or is packed."""
    if not original:
        # Nobody would know of which drawing the changes are.
        shown = [copy, "--base", root, "--read-only"]
    elif is_plain(original):
        shown = [original, "--unsaved", copy]
    else:
        shown = [copy, "--base", root, "--unsaved", copy]
    return [program, "--color", "never", "preview"] + shown + ["--port", port]


def is_plain(original):
    """Whether a drawing's file can be read as it is."""
    return original.lower().endswith(".svg")


def last_written(copy, original):
    """When the copy or the original was written last, in seconds. Raises `OSError` if there is no copy."""
    times = [os.stat(copy).st_mtime]
    if original and os.path.exists(original):
        times.append(os.stat(original).st_mtime)
    return max(times)


def run_until_stopped(server, folder, copy, original):
    """Waits until the server exits or should be stopped, and follows what is saved."""
    follower = Follower(folder, copy, original) if is_plain(original) else None
    while server.poll() is None:
        if os.path.exists(os.path.join(folder, STOP)):
            return
        try:
            if time.time() - last_written(copy, original) > IDLE:
                return
        except OSError:
            return
        if follower is not None:
            follower.look()
        time.sleep(PAUSE)


class Follower:
    """Makes what is saved the canvas that the copy is of. Saves before this are none."""

    def __init__(self, folder, copy, original):
        self.folder, self.copy, self.original = folder, copy, original
        self.known = self.last = stamp(original)

    def look(self):
        """Looks for something new. Inkscape writes in pieces: the file must have stayed the same since the last look."""
        now = stamp(self.original)
        if now is not None and now != self.known and now == self.last:
            saved = read(self.original)
            if saved is not None:
                self.known = now
                try:
                    renew(self.folder, self.copy, saved)
                except ValueError:
                    # The page says what is wrong with it.
                    pass
        self.last = now


def stamp(path):
    """When a file was written last, and its size; None if there is none."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size


def main(program, copy, original, root, folder, port):
    """Runs until the preview ends."""
    held = take_lock(folder)
    if held is None:
        # Another process serves the same drawing already.
        return
    state = {"pid": os.getpid(), "port": int(port), "copy": copy}
    server = None
    try:
        for name in ("SIGTERM", "SIGHUP"):
            if hasattr(signal, name):
                signal.signal(getattr(signal, name), lambda *_: sys.exit(0))
        server = subprocess.Popen(
            preview_command(program, copy, original, root, port),
            cwd=folder,
            env=environment(),
            stdin=subprocess.DEVNULL,
            creationflags=CREATE_NO_WINDOW if sys.platform == "win32" else 0,
        )
        write_atomic(os.path.join(folder, STATE), json.dumps(state).encode())
        run_until_stopped(server, folder, copy, original)
    finally:
        if server is not None and server.poll() is None:
            server.terminate()
            try:
                server.wait(5)
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()
        remove(os.path.join(folder, STOP))
        if changed(folder, copy) is None:
            for path in (copy, os.path.join(folder, BASE)):
                remove(path)
        state["ended"] = True
        write_atomic(os.path.join(folder, STATE), json.dumps(state).encode())
        held.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
