#!/usr/bin/env bash
# Installs okoshi from an unpacked package into an empty folder, without npm and without network, and asks its preview for the page:
# bash tests/tools/installed.sh PACKAGE TARGET
set -euo pipefail
package=$1
target=$2
drawing=$PWD/examples/human.svg

room=$(mktemp -d)
server=
trap '[ -z "$server" ] || kill "$server"; rm -rf "$room"' EXIT
cd "$room"
mkdir without
printf '#!/bin/sh\necho "npm is not to be run" >&2\nexit 1\n' > without/npm
chmod +x without/npm
# With the default features, but named: cargo would take what it builds for that of the repository, which has the same folder, and then
# build the repository once more.
# Without optimization, which takes longer than what it saves here.
env -u OKOSHI_NO_PAGE CARGO_PROFILE_DEV_OPT_LEVEL=0 PATH="$room/without:$PATH" \
  cargo install --locked --offline --debug --path "$package" --root "$room/installed" --target-dir "$target" \
    --no-default-features --features cli

mkfifo address
installed/bin/okoshi preview --port 0 "$drawing" > address &
server=$!
read -r url < address
curl -sSf "$url" -o page.html
curl -sSf "${url%/}/page.js" -o page.js
grep -q 'page\.js' page.html
grep -q 'three' page.js
[ "$(stat -c %s page.js)" -gt 500000 ]
echo "the page of $url: $(stat -c %s page.html) bytes, and its script $(stat -c %s page.js)"
