"""How a message reaches the person."""

import os
import sys

import inkex


def say(text, terminal=None):
    """Shows a text in Inkscape's message window; without a window, on Inkscape's own stderr, there as `terminal` if given."""
    inkex.errormsg(text)
    sys.stderr.flush()
    if version() < (1, 4):
        beside(text if terminal is None else terminal)


def version():
    """The version of inkex, which is Inkscape's but for the last number."""
    numbers = getattr(inkex, "__version__", "1.0").split(".")
    try:
        return int(numbers[0]), int(numbers[1])
    except (IndexError, ValueError):
        return 1, 0


def beside(text):
    """Writes to Inkscape's own stderr as well: without a window, Inkscape 1.2 and older drop what extensions say.

    Inkscape is the process at the other end of our stderr, which /proc tells. Where it does not, nothing is written.
    """
    place = reader_of(2)
    if place is None:
        return
    try:
        with open(place, "ab", 0) as stream:
            # In a file, Inkscape goes on writing where it was, over what we append: it shall find blanks there.
            blanks = b" " * 1024 + b"\n" if os.path.isfile(place) else b""
            stream.write(blanks + text.encode("utf-8", "replace") + b"\n")
    except OSError:
        pass


def reader_of(number):
    """The stderr, below /proc, of the Inkscape that reads the pipe behind one of our file descriptors; or None."""
    try:
        pipe = os.readlink("/proc/self/fd/%d" % number)
        if not pipe.startswith("pipe:"):
            return None
        processes = [name for name in os.listdir("/proc") if name.isdigit()]
    except OSError:
        return None
    for process in processes:
        descriptors = "/proc/%s/fd" % process
        try:
            if not os.path.basename(os.readlink("/proc/%s/exe" % process)).startswith("inkscape"):
                continue
            if any(os.readlink(os.path.join(descriptors, one)) == pipe for one in os.listdir(descriptors)):
                return os.path.join(descriptors, "2")
        except OSError:
            continue
    return None
