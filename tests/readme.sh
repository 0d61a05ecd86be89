#!/usr/bin/env bash
# Runs the commands that README.md shows: bash tests/readme.sh PATH/OF/okoshi
#
# Taken are the lines of its ```sh blocks that begin with `okoshi` or with `cargo run --release --`, which both become the
# given binary. They run in order, in a copy of what lies in the repository, so that one may use what another made. Not
# run: commands that stay (watch, preview, app, lsp) and lines with `…` or capitals for the reader to fill in.
set -euo pipefail
okoshi=$1
cd "$(dirname "$0")/.."

room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
cp -r examples README.md "$room" 2> /dev/null || cp README.md "$room"
cd "$room"
mkdir bin
ln -s "$okoshi" bin/okoshi
export PATH="$room/bin:$PATH"

ran=0
bad=0
while IFS= read -r line; do
  command=${line#\$ }
  command=${command/#cargo run --release -- /okoshi }
  command=${command/#cargo run --release --quiet -- /okoshi }
  case $command in
    "okoshi watch"* | "okoshi preview"* | "okoshi app"* | "okoshi lsp"*) echo "not run, it stays: $line"; continue ;;
    *…* | *...*) echo "not run, to be filled in: $line"; continue ;;
    "okoshi "*) ;;
    *) echo "not run, another program: $line"; continue ;;
  esac
  if [[ $command =~ [[:space:]][A-Z]+([[:space:].]|$) ]]; then
    echo "not run, to be filled in: $line"
    continue
  fi
  echo "\$ $command"
  ran=$((ran + 1))
  bash -c "set -euo pipefail; $command" < /dev/null || { echo "BAD, status $?: $line"; bad=$((bad + 1)); continue; }
  if [[ $command =~ \ -o\ ([^ ]+) && ${BASH_REMATCH[1]} != - && ! -e ${BASH_REMATCH[1]} ]]; then
    echo "BAD, ${BASH_REMATCH[1]} was not made: $line"
    bad=$((bad + 1))
  fi
done < <(awk '/^```/ { inside = ($0 == "```sh"); next } inside && NF && !/^#/' README.md | sed 's/[[:space:]]\+#.*$//')
echo "$ran commands of the README ran, $bad went wrong"
[ "$bad" = 0 ]
