#!/usr/bin/env bash
# Runs everything that tells whether okoshi is in order: bash tests/all.sh [--quick]
#
# Works from a clean clone on Debian or Ubuntu with Rust and Node. Blender, Inkscape, Pillow, Neovim, Emacs, ffmpeg and clip art are installed if
# they are missing and that is allowed (as root, or with sudo that asks for no password); what cannot run is skipped, and the summary says why.
# --quick leaves Blender out, and installs nothing. Exit status 1 if anything failed. All of cargo's work is done in one profile.
set -euo pipefail
cd "$(dirname "$0")/.."

quick=no
for argument in "$@"; do
  case $argument in
    --quick) quick=yes ;;
    *) echo "usage: bash tests/all.sh [--quick]" >&2; exit 2 ;;
  esac
done

tools=tests/tools
target=${CARGO_TARGET_DIR:-target}
okoshi=$target/debug/okoshi
models=$target/examples
export CARGO_TERM_PROGRESS_WHEN=never
# Laws try the same random cases in every run of this script, so that a change is judged by what it changes; `cargo test` by itself tries
# others each time.
export PROPTEST_RNG_SEED=${PROPTEST_RNG_SEED:-1}

# ---- Steps. Each is a function; a failing command ends it; `skip REASON` leaves it.

reason=$(mktemp)
trap 'rm -f "$reason"' EXIT
skip() { echo "skipped: $1"; echo "$1" > "$reason"; exit 77; }
need() { command -v "$1" > /dev/null || skip "$1 is not installed"; }

summary=()
failed=0
step() { # NAME FUNCTION
  local began=$SECONDS status verdict
  printf '\n==== %s\n' "$1"
  : > "$reason"
  # Not in a condition: there `set -e` would not hold.
  set +e
  (set -e; "$2")
  status=$?
  set -e
  case $status in
    0) verdict=ok ;;
    77) verdict="skipped: $(cat "$reason")" ;;
    *) verdict="FAILED (status $status)"; failed=1 ;;
  esac
  printf -- '---- %s: %s, %d s\n' "$1" "$verdict" $((SECONDS - began))
  summary+=("$(printf '%-12s %4d s  %s' "$1" $((SECONDS - began)) "$verdict")")
}

formatting() { cargo fmt --check; }
lints() { cargo clippy --locked --all-targets -- -D warnings; }
# With the tests, for what is built alone has other features of some libraries, and all would be built once more.
program() { cargo build --locked --bins --tests; }
tests() { cargo test --locked --no-fail-fast; }
manual() { RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps; }

# The core alone, with its tests; each feature alone, for all together are the default; and a program that embeds the core.
features() {
  local feature packages
  cargo test --locked --no-default-features --lib --test layers --test models
  for feature in disk watch render tracking preview lsp; do
    OKOSHI_NO_PAGE=1 cargo check --locked --no-default-features --features "$feature"
  done
  # The versions of the libraries are those of the program.
  cp Cargo.lock tests/embedding/Cargo.lock
  cargo run --offline --manifest-path tests/embedding/Cargo.toml --target-dir "$target"
  packages=$(cargo tree --offline --manifest-path tests/embedding/Cargo.toml -e normal --prefix none --no-dedupe | sort -u | wc -l)
  echo "$packages packages in the tree of a program that embeds the core"
  [ "$packages" -lt 130 ]
}

# The core for a browser. rustup's toolchain, if it has that target; otherwise Debian's, whose standard library is compiled first.
wasm() {
  local target_triple=wasm32-unknown-unknown check
  check=(check --locked --lib --no-default-features --target $target_triple)
  if rustup target list --installed 2> /dev/null | grep -qx $target_triple; then
    cargo "${check[@]}"
    return
  fi
  if ! [ -d /usr/lib/rustlib/src/rust/library ]; then
    [ $quick = no ] || skip "--quick, and there is no compiler for WebAssembly"
    install "A compiler for WebAssembly" rustc-web cargo-web rust-web-src
  fi
  # Sources of the standard library are built by the compiler that they came with.
  RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 /usr/bin/cargo "${check[@]}" -Z build-std=std,panic_abort --target-dir "$target/wasm"
}

# What a package holds is enough: installed from it without npm, the program serves the page.
package() {
  need npm
  need curl
  node -e 'import("./editors/web/scripts/install.mjs").then(({ install }) => install())'
  npm run build --prefix editors/web
  cargo package --locked --no-verify --allow-dirty
  rm -rf "$target"/package/okoshi-*/
  tar -xzf "$target"/package/okoshi-*.crate -C "$target/package"
  bash $tools/installed.sh "$(realpath "$target"/package/okoshi-*/)" "$(realpath "$target")"
}

licences() {
  need node
  local host
  host=$(rustc -vV | sed -n 's/^host: //p')
  cargo metadata --format-version 1 --locked --offline --filter-platform "$host" > "$target/metadata.json"
  node $tools/licences.mjs $tools/package-lock.json < "$target/metadata.json"
}

examples() {
  program
  rm -rf "$models"
  mkdir -p "$models"
  local drawing name
  while IFS= read -r drawing; do
    name=${drawing#examples/}
    name=${name%.svg}
    mkdir -p "$models/$(dirname "$name")"
    "$okoshi" build "$drawing" -o "$models/$name.glb"
    "$okoshi" build "$drawing" -o "$models/$name.again.glb"
    cmp "$models/$name.glb" "$models/$name.again.glb"
    rm "$models/$name.again.glb"
    "$okoshi" build "$drawing" --skin -q -o "$models/$name.skin.glb"
    "$okoshi" inspect "$drawing" --json > "$models/$name.json"
    echo "built $drawing: $(stat -c %s "$models/$name.glb") bytes"
  done < <(find examples -name '*.svg' | sort)
  built
}

# The models of the examples, skinned ones too, in the order of their names; and those without a skin.
built_models() { find "$models" -name '*.glb' 2> /dev/null | sort; }
plain() { built_models | grep -v '\.skin\.glb$'; }

built() { [ -n "$(built_models)" ] || skip "there are no built examples"; }

validator() {
  need npm
  built
  (cd $tools && npm ci --no-audit --no-fund)
  built_models | xargs node $tools/validate.mjs
}

# Installs Debian packages that WHAT needs, or leaves the step.
install() { # WHAT PACKAGES…
  local what=$1 sudo=
  shift
  command -v apt-get > /dev/null || skip "$what is not installed, and there is no apt-get"
  if [ "$(id -u)" != 0 ]; then
    sudo -n true 2> /dev/null || skip "$what is not installed, and installing it takes root or sudo without password"
    sudo="sudo -n"
  fi
  $sudo apt-get update -q
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -yq --no-install-recommends "$@"
}

# The tests of videos run with all others too, but say there only that they skip what needs ffmpeg.
videos() {
  if ! command -v ffmpeg > /dev/null; then
    [ $quick = no ] || skip "--quick, and ffmpeg is not installed"
    install ffmpeg ffmpeg
  fi
  cargo test --locked --test videos
}

# Models of clip art by others, beside the drawings.
clip_art() {
  [ $quick = no ] || skip "--quick"
  need npm
  local art=/usr/share/openclipart/svg
  [ -d $art ] || (install "the Open Clip Art Library" openclipart-svg) || [ $? = 77 ] || exit 1
  (cd $tools && npm ci --no-audit --no-fund)
  rm -rf "$target/clip-art"
  if [ -d $art ]; then
    node $tools/clip_art.mjs "$target/clip-art" $art
  else
    echo "without the Open Clip Art Library: $(cat "$reason")"
    node $tools/clip_art.mjs "$target/clip-art"
  fi
  LOOK_DIR=$(realpath "$target/clip-art") cargo test --locked --test as_drawn -- --ignored --nocapture survey
}

blender_import() {
  [ $quick = no ] || skip "--quick"
  need node
  built
  command -v blender > /dev/null || install Blender blender python3-numpy
  plain | xargs blender -b --factory-startup --python-exit-code 1 --python $tools/blender_tree.py -- \
    -o "$target/trees.json"
  node $tools/same_tree.mjs "$target/trees.json"
  built_models | xargs blender -b --factory-startup --python-exit-code 1 --python $tools/blender_clips.py --
  local model
  for model in $(plain); do
    echo "skin of $model"
    blender -b --factory-startup --python-exit-code 1 --python $tools/blender_skin.py -- "$model" "${model%.glb}.skin.glb"
  done
}

# Gives Python Pillow, which puts pictures together, in an environment of its own.
with_pillow() {
  local own=$target/pillow
  if ! python3 -c 'import PIL' 2> /dev/null; then
    if ! "$own/bin/python3" -c 'import PIL' 2> /dev/null; then
      # Debian's Python makes such environments with a package more.
      python3 -m venv --clear "$own" || { install "Python's venv" python3-venv; python3 -m venv --clear "$own"; }
      "$own/bin/pip" install -q Pillow || skip "Pillow, which puts the pictures together, cannot be installed"
    fi
    PATH=$(realpath "$own/bin"):$PATH
  fi
}

gallery() {
  [ $quick = no ] || skip "--quick"
  command -v inkscape > /dev/null || install Inkscape inkscape
  need python3
  with_pillow
  cargo build --locked --release
  OKOSHI=$(realpath "$target/release/okoshi") OUT="$target/gallery" bash $tools/gallery.sh
}

readme() {
  [ -f README.md ] || skip "there is no README.md"
  program
  bash tests/readme.sh "$(realpath "$okoshi")"
}

extension() {
  need npm
  program
  OKOSHI=$(realpath "$okoshi") npm test --prefix editors/vscode
}

page() {
  need npm
  program
  OKOSHI=$(realpath "$okoshi") npm test --prefix editors/web
}

# Eglot is a package of its own before Emacs 29.
has_eglot() { emacs -q --batch -l eglot > /dev/null 2>&1; }

editors() {
  if ! command -v nvim > /dev/null || ! command -v python3 > /dev/null || ! has_eglot; then
    [ $quick = no ] || skip "--quick, and Neovim, Emacs or its Eglot is not installed"
    install "Neovim, Emacs or its Eglot" neovim emacs-nox python3-venv
    has_eglot || install "Emacs' Eglot" elpa-eglot
  fi
  program
  OKOSHI=$(realpath "$okoshi") SCRATCH=$target/editors bash $tools/editors.sh
}

inkscape_extension() {
  if ! command -v inkscape > /dev/null || ! command -v Xvfb > /dev/null || ! command -v xdotool > /dev/null \
    || ! command -v openbox > /dev/null || ! command -v import > /dev/null || ! command -v dbus-daemon > /dev/null \
    || ! command -v gdbus > /dev/null || ! /usr/bin/python3 -c 'import gi' 2> /dev/null; then
    [ $quick = no ] || skip "--quick, and Inkscape or the tools that drive it are not installed"
    install "Inkscape or the tools that drive it" inkscape python3-cssselect python3-lxml python3-numpy xvfb openbox xdotool \
      imagemagick curl dbus libglib2.0-bin python3-gi gir1.2-gtk-3.0
  fi
  program
  local status=0
  OKOSHI=$(realpath "$okoshi") SCRATCH=$target/inkscape bash $tools/inkscape.sh || status=$?
  [ $status != 77 ] || skip "Inkscape cannot run its extensions here"
  return $status
}

step format formatting
step clippy lints
step test tests
step videos videos
step doc manual
step features features
step wasm wasm
step package package
step licences licences
step examples examples
step validator validator
step clip-art clip_art
step blender blender_import
step gallery gallery
step readme readme
step extension extension
step page page
step editors editors
step inkscape inkscape_extension

printf '\n==== summary, %d s\n' $SECONDS
printf '%s\n' "${summary[@]}"
if [ $failed = 0 ]; then echo "all well"; else echo "SOMETHING FAILED"; fi
exit $failed
