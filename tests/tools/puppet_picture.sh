#!/usr/bin/env bash
# Makes the picture of docs/puppet.md, a sheet as Inkscape shows it: bash tests/tools/puppet_picture.sh
#
# Requires okoshi, Inkscape and Python's Pillow. OKOSHI is a binary to use instead of building one, OUT a
# folder to use instead of docs/.
set -euo pipefail
cd "$(dirname "$0")/../.."
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
okoshi=${OKOSHI:-target/release/okoshi}
[ -n "${OKOSHI:-}" ] || cargo build --release --quiet
"$okoshi" puppet --quiet examples/lady.svg -o "$room/sheet.svg"
inkscape "$room/sheet.svg" --export-type=png --export-dpi=75 --export-background=white -o "$room/sheet.png" 2> /dev/null
python3 -c "
import sys
from PIL import Image, ImageOps
sheet = Image.open(sys.argv[1]).convert('RGB')
ImageOps.expand(sheet, 1, '#d1d9e0').quantize(96).save(sys.argv[2], optimize=True)" "$room/sheet.png" "${OUT:-docs}/puppet.png"
