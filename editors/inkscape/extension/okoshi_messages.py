"""Shows messages to the user."""

import os
import sys

import inkex


def show_message(text, terminal=None):
    """Shows a text in Inkscape's message window; without a window, on its stderr, there `terminal` if given."""
    inkex.errormsg(text)
    sys.stderr.flush()
    if version() < (1, 4):
        write_to_inkscape_stderr(text if terminal is None else terminal)


def version():
    """The version of inkex: the first two numbers of Inkscape's."""
    numbers = getattr(inkex, "__version__", "1.0").split(".")
    try:
        return int(numbers[0]), int(numbers[1])
    except (IndexError, ValueError):
        return 1, 0


def write_to_inkscape_stderr(text):
    """Writes to Inkscape's stderr too: without a window, Inkscape 1.2 and older drop the messages of extensions.

    Inkscape is the process at the other end of our stderr, found in /proc. Without /proc nothing is written.
    """
    place = stderr_of_reader(2)
    if place is None:
        return
    try:
        with open(place, "ab", 0) as stream:
            # If it is a file, Inkscape continues to write at its own offset, over what we append: let it overwrite blanks.
            blanks = b" " * 1024 + b"\n" if os.path.isfile(place) else b""
            stream.write(blanks + text.encode("utf-8", "replace") + b"\n")
    except OSError:
        pass


def stderr_of_reader(number):
    """The stderr, in /proc, of the Inkscape that reads the pipe of one of our file descriptors; or None."""
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
