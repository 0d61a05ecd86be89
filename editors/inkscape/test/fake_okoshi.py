#!/usr/bin/env python3
"""Stands in for okoshi: serves the drawing that it is given, or its unsaved copy if that was written later; all else is REAL_OKOSHI's.

Every start of a preview is written to the file FAKE_LOG, with its arguments.
"""

import http.server
import os
import sys

arguments = [one for one in sys.argv[1:] if one not in ("--color", "never")]
if arguments[:1] != ["preview"]:
    os.execv(os.environ["REAL_OKOSHI"], [os.environ["REAL_OKOSHI"]] + sys.argv[1:])
if "--help" in arguments:
    sys.exit(0)
with open(os.environ["FAKE_LOG"], "a", encoding="utf-8") as log:
    log.write("\t".join(arguments) + "\n")
if os.environ.get("FAKE_FAILS"):
    sys.exit("error: the fake fails, as it was told")


class Page(http.server.BaseHTTPRequestHandler):
    """The drawing, as it is now."""

    def do_GET(self):
        files = [arguments[1]]
        if "--unsaved" in arguments:
            files.append(arguments[arguments.index("--unsaved") + 1])
        with open(max(files, key=lambda path: os.stat(path).st_mtime_ns), "rb") as file:
            data = file.read()
        self.send_response(200)
        self.end_headers()
        self.wfile.write(data)

    def log_message(self, *_):
        pass


port = int(arguments[arguments.index("--port") + 1])
server = http.server.HTTPServer(("127.0.0.1", port), Page)
print("serving at http://127.0.0.1:%d/page" % port, flush=True)
server.serve_forever()
