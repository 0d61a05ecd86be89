#!/usr/bin/env bash
# Makes a folder of files that is okoshi as a program in the browser, for any static host: bash app.sh [FOLDER].
# OKOSHI_MODULE names the folder of a module that is built already; without it, wasm/build.sh builds one.
set -euo pipefail

folder=$(realpath -m "${1:-okoshi-app}")
module=${OKOSHI_MODULE:-}
if [ -n "$module" ]; then module=$(realpath "$module"); fi
cd "$(dirname "$0")"
if [ -z "$module" ]; then
  module=$(mktemp -d)
  trap 'rm -r "$module"' EXIT
  bash wasm/build.sh "$module"
  node scripts/crates.mjs wasm/Cargo.toml > "$module/module-licences.txt"
fi
node -e 'import("./scripts/install.mjs").then(({ install }) => install())'
node scripts/app.mjs "$folder" "$module"
echo "To see it: okoshi app '$folder' --open; or python3 -m http.server --directory '$folder', then http://localhost:8000"
