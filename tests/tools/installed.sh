#!/usr/bin/env bash
# Installs okoshi from an unpacked package into an empty folder, without npm and without network, asks its preview for the page, and
# `okoshi app` for a folder that was put into the program: bash tests/tools/installed.sh PACKAGE TARGET
set -euo pipefail
package=$1
target=$2
drawing=$PWD/examples/human.svg

room=$(mktemp -d)
servers=()
trap '[ ${#servers[@]} = 0 ] || kill "${servers[@]}"; rm -rf "$room"' EXIT
cd "$room"
mkdir without
printf '#!/bin/sh\necho "npm is not to be run" >&2\nexit 1\n' > without/npm
chmod +x without/npm
# The files that okoshi in the browser has at least.
mkdir -p app/v-0123456789ab
for name in index.html service-worker.js v-0123456789ab/{app.css,app.js,okoshi_web.js,worker.js}; do echo "$name" > "app/$name"; done
head -c 100000 /dev/urandom > app/v-0123456789ab/okoshi_web_bg.wasm
# With the default features, but named: cargo would take what it builds for that of the repository, which has the same folder, and then
# build the repository once more.
# Without optimization, which takes longer than what it saves here.
env -u OKOSHI_NO_PAGE OKOSHI_APP="$room/app" CARGO_PROFILE_DEV_OPT_LEVEL=0 PATH="$room/without:$PATH" \
  cargo install --locked --offline --debug --path "$package" --root "$room/installed" --target-dir "$target" \
    --no-default-features --features cli

mkfifo address
installed/bin/okoshi preview --port 0 "$drawing" > address &
servers+=($!)
read -r url < address
curl -sSf "$url" -o page.html
curl -sSf "${url%/}/page.js" -o page.js
grep -q 'page\.js' page.html
grep -q 'three' page.js
[ "$(stat -c %s page.js)" -gt 500000 ]
echo "the page of $url: $(stat -c %s page.html) bytes, and its script $(stat -c %s page.js)"

mkfifo app-address
installed/bin/okoshi app --port 0 > app-address &
servers+=($!)
read -r url < app-address
(cd app && find . -type f) | while read -r name; do
  for how in "" --compressed; do
    # shellcheck disable=SC2086 # nothing stands for no option
    curl -sSf $how "$url${name#./}" | cmp - "app/$name"
  done
done
curl -sSf "$url" | cmp - app/index.html
echo "okoshi in the browser at $url: all files as they were put into the program"
