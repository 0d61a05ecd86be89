#!/usr/bin/env bash
# Fuzzes a target: bash fuzz/run.sh string|drawing|motion [SECONDS]
#
# Takes Rust's nightly and `cargo install cargo-fuzz`. The corpus begins with the cases of the tests; what is found lies in
# fuzz/artifacts.
set -euo pipefail
cd "$(dirname "$0")"
target=${1:?string, drawing or motion}
corpus=corpus/$target
mkdir -p "$corpus"
for drawing in ../tests/cases/*/drawing.svg $(find ../examples -name "*.svg"); do
  name=$(basename "$(dirname "$drawing")")-$(basename "$drawing")
  case $target in
    drawing) cp "$drawing" "$corpus/$name" ;;
    string) sed -n 's/.*<\(text\|tspan\|desc\)[^>]*>\([^<]\{1,\}\)<.*/\2/p' "$drawing" > "$corpus/$name" ;;
  esac
done
case $target in
  motion) cp ../examples/motion/*.bvh ../tests/motion/data/*.bvh "$corpus" ;;
esac
cargo +nightly fuzz run "$target" "$corpus" -- -max_total_time="${2:-60}" -timeout=20 -rss_limit_mb=4096
