#!/usr/bin/env bash
# Makes the picture of docs/tracking.md from tests/tracking/data/sticks.webp: bash tests/tools/tracking_picture.sh
#
# Requires okoshi and Python's Pillow. OKOSHI is a binary to use instead of building one, OUT a folder to use instead of docs/.
set -euo pipefail
cd "$(dirname "$0")/../.."
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
okoshi=${OKOSHI:-target/release/okoshi}
[ -n "${OKOSHI:-}" ] || cargo build --release --quiet
"$okoshi" track --quiet tests/tracking/data/sticks.webp --mark red --mark green -o "$room/a.json" --annotated "$room/a.png"
python3 -c "
import sys
from PIL import Image
frames = [Image.open(f'{sys.argv[1]}/a-{number}.png').convert('RGB') for number in (30, 75)]
picture = Image.new('RGB', (648, 240), 'white')
for index, frame in enumerate(frames):
    picture.paste(frame, (index * 328, 0))
picture.save(f'{sys.argv[2]}/tracking.jpg', quality=88)" "$room" "${OUT:-docs}"
