"""What the tests of the extension share."""

import os
import stat
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
EXTENSION = os.path.join(os.path.dirname(HERE), "extension")
sys.path.insert(0, EXTENSION)

# The limit of every wait, in seconds: it only ends a test that hangs.
PATIENCE = 60
SVG = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink">%s</svg>\n'
)


class Folder(unittest.TestCase):
    """A test with a folder of its own, whose name has a blank and a letter beyond ASCII."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="zwei Öhrchen ")
        self.addCleanup(holder.cleanup)
        self.folder = os.path.realpath(holder.name)

    def write(self, name, text="", executable=False):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        if executable:
            os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
        return path
