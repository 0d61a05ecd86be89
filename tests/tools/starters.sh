#!/usr/bin/env bash
# Makes docs/starters.png, the models of all drawings that `okoshi new` writes, with their names: bash tests/tools/starters.sh
#
# `okoshi new --list` shows the same picture in terminals that can. Requires Python's Pillow. OKOSHI is a binary to use instead of
# building one, OUT a file to write instead.
set -euo pipefail
cd "$(dirname "$0")/../.."
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
okoshi=${OKOSHI:-target/release/okoshi}
[ -n "${OKOSHI:-}" ] || cargo build --release --quiet

# name VIEW: a template's model from there.
pictures=()
while read -r name view; do
  "$okoshi" new --quiet "$room/$name" --template "$name"
  "$okoshi" render --quiet "$room/$name.svg" -o "$room/$name.png" --size 720x720 --view="$view" --background "#ffffff"
  pictures+=("$name" "$room/$name.png")
done <<'END'
girl 28,10
boy -28,10
dog 28,12
dragon 28,12
robot 28,10
racing-car 32,16
island 24,34
turning 22,6
END
python3 tests/tools/contact_sheet.py "${OUT:-docs/starters.png}" "${pictures[@]}"
