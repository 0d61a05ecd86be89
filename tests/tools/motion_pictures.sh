#!/usr/bin/env bash
# Makes the pictures of docs/motion.md from the drawings in examples/motion/: bash tests/tools/motion_pictures.sh [NAME…]
#
# NAME is a drawing there, without extension. The film strips show the limited clip (NAME-limited.png) and the full one
# (NAME-full.png), or drawings that are held by hand (NAME-held.png) and each for a frame (NAME-each.png); drawings with only one of them get NAME.png, and those that play a clip that comes along NAME-WORD.png. Requires okoshi
# and Python's Pillow. OKOSHI is a binary to use instead of building one, OUT a folder to use instead of docs/.
set -euo pipefail
cd "$(dirname "$0")/../.."
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
okoshi=${OKOSHI:-target/release/okoshi}
[ -n "${OKOSHI:-}" ] || cargo build --release --quiet
okoshi=$(realpath "$okoshi")
out=${OUT:-docs}
mkdir -p "$out/motion"
cp examples/motion/* "$room"
mkdir "$room/full"
cp "$room"/*.bvh "$room/full"
for drawing in "$room"/*.svg; do
  sed -E 's/ ?Limited [0-9]+ [0-9]+//; s/ ?Held( [0-9]+)+//' "$drawing" > "$room/full/$(basename "$drawing")"
done
# smaller PICTURE COLOURS: with so many colours.
smaller() {
  python3 -c "
import sys
from PIL import Image
Image.open(sys.argv[1]).convert('RGB').quantize(int(sys.argv[2])).save(sys.argv[1], optimize=True)" "$@"
}
wanted="$*"
want() { [ -z "$wanted" ] || [[ " $wanted " == *" $1 "* ]]; }
# strip DRAWING OUT VIEW FROM TO SIZE CELLS
strip() {
  "$okoshi" render --quiet "$1" -o "$2" --clip 1 --view="$3" --from "$4" --to "$5" --size "$6" --strip "$7" --background '#ffffff'
  smaller "$2" 128
}
pair() {
  want "$1" || return 0
  strip "$room/full/$1.svg" "$out/motion/$1-full.png" "${@:2}"
  strip "$room/$1.svg" "$out/motion/$1-limited.png" "${@:2}"
}
single() {
  want "$1" || return 0
  strip "$room/$1.svg" "$out/motion/$2.png" "${@:3}"
}
# held DRAWING VIEW FROM TO SIZE CELLS: with the drawings that are held by hand, and with each for a frame.
held() {
  want "$1" || return 0
  strip "$room/full/$1.svg" "$out/motion/$1-each.png" "${@:2}"
  strip "$room/$1.svg" "$out/motion/$1-held.png" "${@:2}"
}
# clip DRAWING WORD VIEW SIZE CELLS: the drawing plays a clip that comes along, in place.
clip() {
  want "$(basename "$1" .svg)" || return 0
  local name
  name=$(basename "$1" .svg)-$2
  sed -E "s/Motion( -[il]+)?( \"[^\"]*\"( \"[^\"]*\")?| [a-z]+)/Motion -i $2/; s/ ?Limited [0-9]+ [0-9]+//" "$1" > "$room/$name.svg"
  "$okoshi" render --quiet "$room/$name.svg" -o "$out/motion/$name.png" --clip 1 --view="$3" --size "$4" --strip "$5" --background '#ffffff'
  smaller "$out/motion/$name.png" 96
}
# A walk has no fast part from which in-betweens could be omitted.
sed -i 's/Motion "walk.bvh" "walk"/& Limited 0 24/' "$room/dog.svg"
pair kick -75,8 1.01 1.594 200x240 8
pair boxer 0,8 1.25 1.6 200x240 8
pair ant 40,8 2.0 2.35 200x240 8
pair dog 8,8 0 1.25 220x160 8
single beetle beetle 8,12 0 1.25 200x130 8
single robot-ja robot 40,8 2.0 2.35 200x240 8
single stick stick -75,8 1.01 1.594 200x240 8
# Eight frames, in which the foot hits.
held stick -75,8 1.42 1.71 200x240 8
single visitor visitor-greeting -55,8 1.75 3.1 150x190 10
# The last frame is the first one.
single lamp lamp -20,6 0 1.95 150x190 10
clip examples/motion/monkey.svg walk 35,8 200x240 8
clip src/starters/boy.svg walk -75,8 130x170 10
clip src/starters/boy.svg run -75,8 130x170 10
clip src/starters/boy.svg dance 0,8 130x170 10
clip examples/motion/dog.svg walk 8,8 160x120 8
clip examples/motion/dog.svg run 8,8 160x120 8
clip examples/motion/beetle.svg walk 8,12 160x120 8
clip examples/motion/ant.svg dance 0,8 130x170 10
clip examples/motion/bird.svg walk 8,8 160x130 8
clip examples/motion/spider.svg walk 20,14 160x120 8
# alone DRAWING CLIP VIEW SIZE CELLS: the drawing says `Motion` alone, and plays in place what fits it.
alone() {
  want "$1" || return 0
  sed -E 's/Motion</Motion -i</' "examples/motion/$1.svg" > "$room/$1.svg"
  "$okoshi" render --quiet "$room/$1.svg" -o "$out/motion/$1-$2.png" --clip "$2" --view="$3" --size "$4" --strip "$5" --background '#ffffff'
  smaller "$out/motion/$1-$2.png" 96
}
alone parade float 20,10 260x190 4
alone girl walk -30,8 150x180 8
alone knight walk -30,8 170x180 8
alone horse walk 15,8 160x160 8
clip examples/motion/trousers.svg walk -40,8 150x190 8
alone motorbike drive 20,10 200x150 6
# perform OUT CLIP [OPTIONS…]: a clip of the performed hook, as a strip.
perform() {
  want ant-hook || return 0
  "$okoshi" render --quiet "$room/ant-hook.svg" -o "$out/motion/$1.png" --clip "$2" --size 120x160 --strip 8 --background '#ffffff' "${@:3}"
  smaller "$out/motion/$1.png" 64
}
perform ant-hook-before before --view 0,5
perform ant-hook-after after --view 0,5
perform ant-hook-camera after --camera
if want kick; then
  "$okoshi" render --quiet "$room/kick.svg" -o "$out"/motion/kick.gif --clip kick --view=-60,8 --size 260x240 --background '#ffffff'
  "$okoshi" motion --quiet "$room/kick.bvh" -o "$out"/motion/kick.svg
fi
