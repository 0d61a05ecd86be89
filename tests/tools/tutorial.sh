#!/usr/bin/env bash
# Makes the pictures of docs/tutorial.md and docs/how-to.md, and that of a photograph: bash tests/tools/tutorial.sh [NAME…]
#
# Each shows the page of a drawing of examples/tutorial or examples/how-to on the left and its model on the right. NAME is a picture
# without extension: tutorial/3-names. Requires Inkscape for the pages, okoshi for the models, and Python's Pillow. OKOSHI is a binary to
# use instead of building one, OUT a folder to use instead of docs/.
set -euo pipefail
cd "$(dirname "$0")/../.."
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
okoshi=${OKOSHI:-target/release/okoshi}
[ -n "${OKOSHI:-}" ] || cargo build --release --quiet

out=${OUT:-docs}
mkdir -p "$out/tutorial" "$out/how-to"
# PICTURE DRAWING VIEW…: the model from each of these. With `move N SECONDS` before the views, N moments of its clip up to there.
while read -r picture drawing views; do
  [ $# = 0 ] || [[ " $* " == *" $picture "* ]] || continue
  inkscape "examples/$drawing.svg" --export-type=png --export-height=900 --export-background=white \
    --export-filename="$room/page.png" 2> /dev/null
  moments=()
  if [[ $views == move\ * ]]; then
    read -r _ number seconds views <<< "$views"
    moments=(--clip 1 --strip "$number" --from 0 --to "$seconds")
  fi
  models=()
  size=720x720
  [ ${#moments[@]} = 0 ] || size=520x720
  for view in $views; do
    model=$room/model-${#models[@]}.png
    "$okoshi" render --quiet "examples/$drawing.svg" -o "$model" --size $size --view="$view" --background "#ffffff" "${moments[@]}"
    models+=("$model")
  done
  python3 tests/tools/page_and_model.py "$room/page.png" "${models[@]}" "$out/$picture.png"
  echo "$picture"
done <<'END'
tutorial/1-body-and-head tutorial/1-body-and-head 30,12
tutorial/2-arms tutorial/2-arms 30,12
tutorial/preview tutorial/2-arms 0,5 45,12 90,5
tutorial/3-names tutorial/3-names 30,12
tutorial/4-legs-and-shoes tutorial/4-legs-and-shoes 30,12
tutorial/5-face tutorial/5-face 30,12
tutorial/6-hair tutorial/6-hair 30,12 150,12
tutorial/7-walk tutorial/7-walk move 4 0.75 40,8
tutorial/turn tutorial/7-walk 0,6 60,6 120,6 180,6
how-to/face how-to/face 0,5 40,12
how-to/hat how-to/hat 30,8 150,8
how-to/cape how-to/cape move 3 0.44 30,8
how-to/cat how-to/cat move 2 0.5 25,12
how-to/duck how-to/duck 28,16
how-to/birdhouse how-to/birdhouse 30,12 90,5
END

# The photograph, and the figure that it becomes.
if [ $# = 0 ] || [[ " $* " == *" photograph "* ]]; then
  "$okoshi" trace --quiet examples/photographs/boy.jpg -o "$room/boy.svg"
  "$okoshi" annotate --quiet "$room/boy.svg"
  sed -i 's|</svg>|<text x="10" y="20" font-size="14">%Motion walk</text></svg>|' "$room/boy.svg"
  "$okoshi" render --quiet "$room/boy.svg" -o "$room/boy.png" --size 520x720 --view 30,12 --background "#ffffff" --clip walk --strip 3
  python3 tests/tools/page_and_model.py examples/photographs/boy.jpg "$room/boy.png" "$out/photograph.png"
  echo photograph
fi
