#!/usr/bin/env bash
# Makes the pictures of docs/lessons.md that no other page has: bash tests/tools/lessons.sh
#
# Requires Inkscape for the pages, okoshi for the models, and Python's Pillow. OKOSHI is a binary to use instead of building one, OUT a folder to
# use instead of docs/.
set -euo pipefail
cd "$(dirname "$0")/../.."
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
okoshi=${OKOSHI:-target/release/okoshi}
[ -n "${OKOSHI:-}" ] || cargo build --release --quiet

out=${OUT:-docs}/lessons
mkdir -p "$out"
model() { "$okoshi" render --quiet "$1" -o "$2" --size 720x720 --view="$3" --background "#ffffff"; }

# PICTURE DRAWING VIEW…: the page beside the model from each of these.
while read -r picture drawing views; do
  inkscape "examples/$drawing.svg" --export-type=png --export-height=900 --export-background=white \
    --export-filename="$room/page.png" 2> /dev/null
  models=()
  for view in $views; do
    models+=("$room/model-${#models[@]}.png")
    model "examples/$drawing.svg" "${models[-1]}" "$view"
  done
  python3 tests/tools/page_and_model.py "$room/page.png" "${models[@]}" "$out/$picture.png"
  echo "lessons/$picture"
done <<'END'
turn characters/boy 0,0 22,0 45,0
box terrain/basic 30,30
pond terrain/pond 30,30
houses terrain/house 30,30
island island 30,30
END

# One house, of which the wall and the roof have three depths.
sheet=()
for depths in thin:4:8 "as drawn:20:27" deep:60:68; do
  IFS=: read -r name wall roof <<< "$depths"
  sed "s/Shape default -20 20/Shape default -$wall $wall/; s/Shape default -27 27/Shape default -$roof $roof/" examples/how-to/birdhouse.svg > "$room/house.svg"
  model "$room/house.svg" "$room/$name.png" 40,12
  sheet+=("$name" "$room/$name.png")
done
python3 tests/tools/contact_sheet.py "$out/thickness.png" "${sheet[@]}"
echo lessons/thickness

# Kinds of shape, by their names on the page.
sheet=()
for kind in default roundv round inflate cone lathe; do
  model "examples/shapes/$kind.svg" "$room/$kind.png" 30,15
  sheet+=("$kind" "$room/$kind.png")
done
python3 tests/tools/contact_sheet.py "$out/kinds.png" "${sheet[@]}"
echo lessons/kinds
