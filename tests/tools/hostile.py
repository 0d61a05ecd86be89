#!/usr/bin/env python3
"""Measures what the drawings in a folder take, such as those that `OKOSHI_HOSTILE=FOLDER cargo test --test hostile` writes:

    python3 tests/tools/hostile.py OKOSHI FOLDER [COMMAND] [NAME…]

CPU seconds (of all threads, and of the system for them) and the peak of memory of `okoshi COMMAND`, `build` if none is given, with the
first line of what it says if it refuses. Those over a second or 300 MiB that were not refused are marked; then the exit status is 1.
"""

import os
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

SECONDS = 1.0
MIB = 300
PATIENCE = 30
MOST_MIB = 4096


def measure(okoshi, command, drawing, scratch):
    """The seconds, the MiB, the exit status and the standard error of a run."""
    arguments = [okoshi, command, drawing]
    if command in ("build", "puppet", "render"):
        ending = {"build": "glb", "puppet": "svg", "render": "png"}[command]
        arguments += ["-o", os.path.join(scratch, f"out.{ending}")]
    with tempfile.TemporaryFile() as said:
        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE))
            resource.setrlimit(resource.RLIMIT_AS, (MOST_MIB << 20, MOST_MIB << 20))

        process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=said, preexec_fn=limit)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = status
        said.seek(0)
        error = said.read().decode(errors="replace")
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, status, error


def main():
    okoshi, folder, *rest = sys.argv[1:]
    command = rest[0] if rest else "build"
    names = rest[1:]

    def order(path):
        stem, _, size = path.stem.rpartition("-")
        return (stem, int(size)) if size.isdigit() else (path.stem, 0)

    drawings = [path for path in sorted(Path(folder).glob("*.svg"), key=order) if not names or any(name in path.stem for name in names)]
    slow = 0
    with tempfile.TemporaryDirectory() as scratch:
        for drawing in drawings:
            seconds, memory, status, error = measure(okoshi, command, str(drawing), scratch)
            told = re.search(r"^(?:error|warning)\[E005\].*", re.sub(r"\x1b\[[0-9;]*m", "", error), re.MULTILINE)
            is_over = seconds > SECONDS or memory > MIB
            slow += is_over
            verdict = "ENDED" if os.WIFSIGNALED(status) else "OVER" if is_over else ""
            size = drawing.stat().st_size / 1024
            refused = told.group(0)[:120] if told else ""
            print(f"{drawing.stem:45} {size:7.1f} KiB {seconds:7.2f} s {memory:6.0f} MiB  {verdict:5} {refused}", flush=True)
    sys.exit(slow > 0)


main()
