#!/usr/bin/env bash
# Makes the gallery's pictures from the drawings in examples/, without those of tests/tools/tutorial.sh: bash tests/tools/gallery.sh [NAME…]
#
# NAME is a drawing in examples/ without extension: girl, shapes/cone. Each drawing gets gallery/NAME-drawing.png and
# gallery/NAME-model.png in docs/; island-textured and looks also get NAME.png there, with both side by side,
# island gets terrain-on.png and terrain-off.png, its drawn look and true 3D, characters/boy gets characters-matches.png, which of
# its regions are pairs, and robot-ja gets robot.png, as `okoshi render` alone makes it, but smaller. Requires Inkscape for the
# drawings, okoshi for the models, and Python's Pillow. OKOSHI is a binary to use instead of building one, OUT a folder to use instead of
# docs/.
set -euo pipefail
cd "$(dirname "$0")/../.."
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
okoshi=${OKOSHI:-target/release/okoshi}
[ -n "${OKOSHI:-}" ] || cargo build --release --quiet

out=${OUT:-docs}
mkdir -p "$out/gallery"
while IFS= read -r drawing; do
  name=${drawing#examples/}
  name=${name%.svg}
  [ $# = 0 ] || [[ " $* " == *" $name "* ]] || continue
  flat=${name//\//-}
  case $name in
    # Between the drawn views.
    characters/cat) view=0,15 ;;
    characters/bird) view=15,0 ;;
    characters/*) view=22,8 ;;
    # These lie on the ground.
    shapes/conev | shapes/coneh) view=25,38 ;;
    island* | terrain/*) view=30,30 ;;
    *) view=30,15 ;;
  esac
  inkscape "$drawing" --export-type=png --export-width=1000 --export-background=white \
    --export-filename="$room/$flat-drawing.png" 2> /dev/null
  "$okoshi" render --quiet "$drawing" -o "$room/$flat-model.png" --size 1000x1000 --view $view --background "#ffffff"
  for side in drawing model; do
    python3 tests/tools/thumbnail.py "$room/$flat-$side.png" "$out/gallery/$flat-$side.png"
  done
  case $name in
    island-textured | looks)
      python3 tests/tools/side_by_side.py "$room/$flat-drawing.png" "$room/$flat-model.png" "$out/$flat.png" ;;
    robot-ja)
      "$okoshi" render --quiet "$drawing" -o "$out/robot.png" --size 400x400 ;;
    characters/boy)
      "$okoshi" inspect --quiet "$drawing" --matches "$room/matches.png" > "$room/list.txt"
      python3 -c 'import sys; from PIL import Image; Image.open(sys.argv[1]).convert("RGB").quantize(128).save(sys.argv[2], optimize=True)' \
        "$room/matches.png" "$out/characters-matches.png" ;;
    island)
      for bend in on off; do
        "$okoshi" render --quiet "$drawing" -o "$room/bend-$bend.png" --size 1000x1000 --view 0,45 \
          --projection orthographic --bend $bend --background "#ffffff"
        python3 tests/tools/thumbnail.py "$room/bend-$bend.png" "$out/terrain-$bend.png"
      done ;;
  esac
  echo "$name"
done < <(find examples -name '*.svg' -not -path 'examples/tutorial/*' -not -path 'examples/how-to/*' | sort)
