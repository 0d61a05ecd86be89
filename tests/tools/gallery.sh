#!/usr/bin/env bash
# Makes the gallery's pictures from all drawings in examples/: bash tests/tools/gallery.sh [NAME…]
#
# NAME is that of a drawing from examples/ on, without its ending: human, shapes/cone. Each drawing gets
# docs/gallery/NAME-drawing.png and docs/gallery/NAME-model.png; human and clockwork-dragon get docs/NAME.png too, both
# side by side, for the README. Takes Inkscape for the drawings, Blender for the models, and Python's Pillow. OKOSHI names
# a binary to use instead of building one.
set -euo pipefail
cd "$(dirname "$0")/../.."
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
okoshi=${OKOSHI:-target/release/okoshi}
[ -n "${OKOSHI:-}" ] || cargo build --release --quiet

mkdir -p docs/gallery
while IFS= read -r drawing; do
  name=${drawing#examples/}
  name=${name%.svg}
  [ $# = 0 ] || [[ " $* " == *" $name "* ]] || continue
  flat=${name//\//-}
  case $name in
    # They lie on the ground.
    shapes/conev | shapes/coneh) view=25,38 ;;
    *) view=30,15 ;;
  esac
  "$okoshi" build --quiet "$drawing" -o "$room/$flat.glb"
  inkscape "$drawing" --export-type=png --export-width=1000 --export-background=white \
    --export-filename="$room/$flat-drawing.png" 2> /dev/null
  blender -b --factory-startup --python-exit-code 1 --python tests/tools/picture.py -- \
    "$room/$flat.glb" "$room/$flat-model.png" --size 1000x1000 --view $view --samples 64 > "$room/log" ||
    { cat "$room/log"; exit 1; }
  for side in drawing model; do
    python3 tests/tools/thumbnail.py "$room/$flat-$side.png" "docs/gallery/$flat-$side.png"
  done
  case $name in
    human | clockwork-dragon)
      python3 tests/tools/side_by_side.py "$room/$flat-drawing.png" "$room/$flat-model.png" "docs/$flat.png" ;;
  esac
  echo "$name"
done < <(find examples -name '*.svg' | sort)
