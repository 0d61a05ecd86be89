#!/usr/bin/env bash
# Makes the gallery's pictures, docs/NAME.png, drawing and model side by side: bash tests/tools/gallery.sh [NAME…]
#
# Takes Inkscape for the drawing, okoshi for the model, and Python's Pillow to put them together.
set -euo pipefail
cd "$(dirname "$0")/../.."
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
cargo build --release --quiet
for drawing in examples/*.svg; do
  name=$(basename "$drawing" .svg)
  [ $# = 0 ] || [[ " $* " == *" $name "* ]] || continue
  inkscape "$drawing" --export-type=png --export-width=800 --export-background=white \
    --export-filename="$room/$name-drawing.png" 2> /dev/null
  target/release/okoshi render --quiet "$drawing" -o "$room/$name-model.png" --size 1000x1000 --background "#ffffff"
  python3 tests/tools/side_by_side.py "$room/$name-drawing.png" "$room/$name-model.png" "docs/$name.png"
  echo "docs/$name.png"
done
