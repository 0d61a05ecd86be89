#!/usr/bin/env bash
# Fuzzes one target or all of them, one after the other: bash fuzz/run.sh all|TARGET [SECONDS EACH]
#
# Takes Rust's nightly and `cargo install cargo-fuzz`. The targets are the laws in tests/fuzzing. A search begins with the cases
# of the tests and goes on from what earlier ones found (fuzz/corpus). It goes on after a finding, too: inputs that break the law,
# take 20 seconds or need 2 GiB are in fuzz/artifacts/TARGET, beside the log. The last lines sum it up.
set -euo pipefail
cd "$(dirname "$0")"
usage="bash fuzz/run.sh all|TARGET [SECONDS EACH]"
all=$(sed -n 's/^name = "\([a-z]*\)"$/\1/p' Cargo.toml)
targets=${1:?$usage}
seconds=${2:-60}
[ "$targets" = all ] && targets=$all
for target in $targets; do
  if ! grep -qx "$target" <<<"$all"; then
    echo "there is no target \`$target\`; choose one of: all" $all >&2
    exit 2
  fi
done

# The preview's page takes npm, and is not fuzzed.
export OKOSHI_NO_PAGE=1
# Without AddressSanitizer: okoshi has no unsafe code, and several times as many inputs are tried.
cargo +nightly fuzz build --sanitizer none

summary=()
broken=0
for target in $targets; do
  corpus=corpus/$target
  artifacts=artifacts/$target
  log=$artifacts/log
  started=$artifacts/log-started
  mkdir -p "$corpus" "$artifacts"
  touch "$started"
  OKOSHI_FUZZ_SEEDS=$corpus cargo +nightly fuzz run --sanitizer none "$target" > "$log" 2>&1
  for regression in ../tests/regressions/fuzzed/"$target"/*; do
    [ -f "$regression" ] && cp "$regression" "$corpus"
  done
  # In a process of its own, an input that ends it does not end the search.
  cargo +nightly fuzz run --sanitizer none "$target" "$corpus" -- -max_total_time="$seconds" -max_len=16384 -timeout=20 \
    -rss_limit_mb=2048 -fork=1 -ignore_crashes=1 -ignore_timeouts=1 -ignore_ooms=1 2>&1 | tee "$log" || true
  # The last line of statistics: #RUNS: cov: …
  runs=$(sed -n 's/^#\([0-9]*\): cov: .*/\1/p' "$log" | tail -1)
  # Its count of findings leaves out those among the first inputs.
  found=$(find "$artifacts" -type f -newer "$started" ! -name 'log*' | wc -l)
  summary+=("$target: ${runs:-no} runs, $(find "$corpus" -type f | wc -l) inputs in the corpus, $found findings")
  [ "$found" -eq 0 ] || broken=1
done
printf '%s\n' "${summary[@]}"
exit $broken
