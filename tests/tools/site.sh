#!/usr/bin/env bash
# Makes a site from the README, docs/ and examples/ in a folder, for any static host: bash tests/tools/site.sh OUT
#
# Fetches Zensical into a Python environment of its own and model-viewer from npm, both below SCRATCH or target/site-tools.
# Exit status 77 if they cannot be fetched. OKOSHI is a binary to use instead of building one. To look at it: python3 -m http.server --directory OUT
set -euo pipefail
out=$(realpath -m "$1")
cd "$(dirname "$0")/../.."
own=${SCRATCH:-target/site-tools}
[ -n "${OKOSHI:-}" ] || cargo build --release --quiet
mkdir -p "$own"
unfetched() { echo "$1 cannot be fetched"; exit 77; }
if [ ! -x "$own/python/bin/zensical" ]; then
  python3 -m venv --clear "$own/python"
  "$own/python/bin/pip" install -q zensical==0.0.73 || unfetched Zensical
fi
viewer=$own/node_modules/@google/model-viewer/dist/model-viewer.min.js
[ -f "$viewer" ] || npm install --prefix "$own" --no-audit --no-fund --silent @google/model-viewer@4.4.0 || unfetched model-viewer
"$own/python/bin/python" tests/tools/site.py "$out" "$viewer"
