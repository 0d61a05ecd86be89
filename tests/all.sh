#!/usr/bin/env bash
# Runs everything that tells whether okoshi is in order: bash tests/all.sh [--quick]
#
# Works from a clean clone on Debian or Ubuntu with Rust and Node. Chromium, Firefox, Blender, Inkscape, Pillow, Neovim, Emacs, ffmpeg and clip
# art are installed if they are missing and that is allowed (as root, or with sudo that asks for no password); what cannot run is skipped,
# and the summary counts that and says why. --quick leaves Blender out, and installs nothing. Exit status 1 if anything failed. All of cargo's
# work is done in one profile. The output of each step is also in target/all/STEP.log.
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
# What only a next build would need takes time and a third of the disk. Where somebody works with it, it stays.
[ -d "$target/debug/incremental" ] || export CARGO_INCREMENTAL=${CARGO_INCREMENTAL:-0}
# Laws try the same random cases in every run of this script, so that a change is judged by what it changes; `cargo test` by itself tries
# others each time.
export PROPTEST_RNG_SEED=${PROPTEST_RNG_SEED:-1}

# ---- Steps. Each is a function; a failing command ends it; `skip REASON` leaves it. What a step leaves out it says in a line that begins
# with `skipped:`.

logs=$target/all
rm -rf "$logs"
mkdir -p "$logs"
skip() { echo "skipped: $1"; exit 77; }
need() { command -v "$1" > /dev/null || skip "$1 is not installed"; }

# What a step left out, one reason a line: also tests that node's runner skips.
skips() { # LOG
  sed -nE 's/^skipped: //p; s/^ *﹣ .* # (.*)$/\1/p' "$1"
}

# The closing lines of the test runners in the output of a step. Those of cargo's many programs, and of node's counts, are put together.
closing() { # LOG
  awk '
    /^test result:/ { programs++; passed += $4; failed += $6; ignored += $8 }
    /^ℹ (tests|pass|fail|cancelled|skipped) / { counts = counts (counts == "" ? "" : ", ") $2 " " $3 }
    /^ℹ duration_ms / { print counts; counts = "" }
    /^Ran [0-9]+ tests/ { ran = $0; if (/results/) print ran; next }
    /^(OK|FAILED)( |$)/ && ran != "" { print ran ": " $0; ran = "" }
    /^Neovim .* passed, / { print }
    END { if (programs) printf "%d test programs: %d passed, %d failed, %d ignored\n", programs, passed, failed, ignored }
  ' "$1"
}

# What failed in a step, so that the summary tells it: tests' names, and the places and first lines of panics.
faults() { # LOG
  awk '
    left > 0 { print "  " $0; left-- }
    /^test .* \.\.\. FAILED$/ || /^FAILED / || /^ *✖ / { print }
    / panicked at / { print; left = 3 }
  ' "$1" | awk '!seen[$0]++' | cut -c 1-240 | head -n 40
}

isolated() { (set -e; exec >&3 2>&1 3>&-; "$1"); }

# Runs a step. Its output goes to its log too, and what became of it, with its time and that of all its processors, into a file beside that.
run() { # NAME FUNCTION
  local began=$SECONDS log=$logs/$1.log showing status TIMEFORMAT='%U %S'
  exec 3> >(tee "$log")
  showing=$!
  # Not in a condition: there `set -e` would not hold.
  set +e
  { time isolated "$2"; } 2> "$logs/$1.time"
  status=$?
  set -e
  exec 3>&-
  # All output is shown; what a step may have left running is not waited for.
  timeout 10 tail -s 0.1 -f --pid="$showing" /dev/null || true
  echo "$status $((SECONDS - began)) $(awk '{ printf "%d", $1 + $2 }' "$logs/$1.time")" > "$logs/$1.result"
}

summary=()
failed=0
skipped=0
# Says what became of a step.
conclude() { # NAME
  local log=$logs/$1.log status seconds processor verdict left_out line
  read -r status seconds processor < "$logs/$1.result"
  left_out=$(skips "$log" | sort | uniq -c | sed -E 's/^ *1 /skipped: /; s/^ *([0-9]+) /skipped \1 times: /')
  case $status in
    0) verdict=ok ;;
    77) verdict=skipped ;;
    *) verdict="FAILED (status $status)"; failed=1 ;;
  esac
  skipped=$((skipped + $(skips "$log" | wc -l)))
  printf -- '---- %s: %s, %d s\n' "$1" "$verdict" "$seconds"
  summary+=("$(printf '%-12s %4d s, CPU %4d s  %s' "$1" "$seconds" "$processor" "$verdict")")
  while IFS= read -r line; do
    [ -z "$line" ] || summary+=("                       $line")
  done < <(closing "$log"; case $status in 0 | 77) ;; *) faults "$log" ;; esac; echo "$left_out")
}

step() { # NAME FUNCTION
  printf '\n==== %s\n' "$1"
  run "$1" "$2"
  conclude "$1"
}

# Begins steps in the background, one after the other, and shows them once all are done.
aside=()
row=
begin_aside() { # NAME:FUNCTION…
  local each
  aside=("$@")
  printf '\n==== beside what follows, shown at the end:%s\n' "$(printf ' %s' "${aside[@]%%:*}")"
  # In a group of processes of its own, which can be ended.
  set -m
  (for each in "${aside[@]}"; do run "${each%:*}" "${each#*:}"; done) > /dev/null 2>&1 &
  row=$!
  set +m
  trap 'kill -- "-$row" 2> /dev/null || true' EXIT
}
end_aside() {
  local each name
  wait "$row" || true
  trap - EXIT
  for each in "${aside[@]}"; do
    name=${each%:*}
    printf '\n==== %s\n' "$name"
    # A row that was ended leaves steps out.
    [ -e "$logs/$name.result" ] || { echo "did not end" > "$logs/$name.log"; echo 1 0 0 > "$logs/$name.result"; }
    cat "$logs/$name.log"
    conclude "$name"
  done
}

formatting() { cargo fmt --check; }
lints() { cargo clippy --locked --all-targets -- -D warnings; }
# With the tests, for what is built alone has other features of some libraries, and all would be built once more.
program() { cargo build --locked --bins --tests; }
# The same, unless it has been done. Other steps may have cargo's lock meanwhile.
use_program() { [ -n "${is_built:-}" ] || program; }
# The tests of videos need ffmpeg. Of the output of tests that pass, what they skip is shown.
tests() {
  if [ $quick = no ] && ! command -v ffmpeg > /dev/null; then (install ffmpeg ffmpeg) || [ $? = 77 ] || exit 1; fi
  cargo test --locked --no-fail-fast -- --show-output | awk '
    /^(failures:|test result:)/ { passes = 0 }
    /^successes:$/ { passes = 1 }
    !passes || /^skipped: / { print; fflush() }
  '
}
manual() {
  rm -rf "$target/doc/okoshi"
  RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps --lib
  need node
  node $tools/public_items.mjs "$target/doc/okoshi" 250
}

# The core alone; each feature alone, for all together are the default; and a program that embeds the core, which runs. The core's tests have
# run with all features, so that here it is enough that they compile.
features() {
  local feature packages
  # The module for browsers is built with `protocol` alone.
  local -a alone=(disk render tracking page preview lsp)
  [ -e "$target/module/okoshi_web.js" ] || alone+=(protocol)
  OKOSHI_NO_PAGE=1 cargo check --locked --no-default-features --lib --profile test
  # `watch` is `disk` and one module, which comes with `preview`.
  for feature in "${alone[@]}"; do
    OKOSHI_NO_PAGE=1 cargo check --locked --no-default-features --features "$feature"
  done
  # The versions of the libraries are those of the program.
  cp Cargo.lock tests/embedding/Cargo.lock
  cargo run --offline --manifest-path tests/embedding/Cargo.toml --target-dir "$target"
  packages=$(cargo tree --offline --manifest-path tests/embedding/Cargo.toml -e normal --prefix none --no-dedupe | sort -u | wc -l)
  echo "$packages packages in the tree of a program that embeds the core"
  [ "$packages" -lt 130 ]
}

# okoshi as a module for browsers.
wasm() {
  need node
  local has_target=no
  if rustup target list --installed 2> /dev/null | grep -qx wasm32-unknown-unknown; then has_target=yes; fi
  if [ $has_target = no ] \
    && { ! [ -d /usr/lib/rustlib/src/rust/library ] || ! command -v wasm-ld-22 > /dev/null; }; then
    [ $quick = no ] || skip "--quick, and there is no compiler for WebAssembly"
    install "A compiler for WebAssembly" rustc-web cargo-web rust-web-src lld-22
  fi
  rm -rf "$target/module"
  if [ -z "${FULL_MODULE:-}" ]; then
    # Less optimised than a module that is handed on, which takes several times as long to build.
    # With the language server, so that there is one module for the page and for the extension of VS Code.
    WASM_FEATURES=editor WASM_PROFILE=quick CARGO_TARGET_DIR=$target bash editors/web/wasm/build.sh "$target/module"
    echo "skipped: the size of the module, which FULL_MODULE=yes checks"
    return
  fi
  CARGO_TARGET_DIR=$target bash editors/web/wasm/build.sh "$target/module"
  # In MB with Brotli, as Debian's compiler makes it: docs/speed.md says how it comes about.
  if [ $has_target = no ]; then node editors/web/scripts/size.mjs "$target/module/okoshi_web_bg.wasm" 2.5
  else echo "skipped: the size of the module, which is checked as Debian's compiler makes it"; fi
}

# Tests of the page, which several steps run at the same time: each has a folder of its own, and only the installing and bundling is done
# one at a time.
page_tests() { # FOLDER [WRAPPER…] -- NAMES…
  local OKOSHI_OUT=test/out/$1 wrapper=()
  export OKOSHI_OUT
  shift
  while [ "$1" != -- ]; do wrapper+=("$1"); shift; done
  shift
  with_web npm test --prefix editors/web -- --bundle "$@"
  "${wrapper[@]}" npm test --prefix editors/web -- --run
}

# The page that has the module, in Chromium. The program serves it, too.
app() {
  need npm
  use_module
  use_program
  OKOSHI=$(realpath "$okoshi") OKOSHI_MODULE=$(realpath "$target/module") page_tests app -- app. worker. bytes. sharing. strings. welcome. lessons.
}

# Drawings that are edited by the page with the module instead of the program.
page_worker() {
  need npm
  use_module
  use_chromium
  use_program
  OKOSHI_HOST=worker OKOSHI=$(realpath "$okoshi") OKOSHI_MODULE=$(realpath "$target/module") page_tests worker -- drawing. editing-clips. editing-handles. editing-quick. editing-sheet. editing.test. keep-pose. part-menu.
}

# The module, which the other row of steps builds.
use_module() {
  until [ -e "$logs/wasm.result" ]; do sleep 1; done
  [ -e "$target/module/okoshi_web.js" ] || skip "there is no module"
}

# Whether there is a module with the language server.
has_editor_module() { grep -qs '^export class Server' "$target/module/okoshi_web.js"; }

# The extension of VS Code for the Web, which has the module; in a real workbench if that is installed.
web_extension() {
  need npm
  has_editor_module || skip "there is no module with the language server"
  use_program
  export OKOSHI_MODULE=$(realpath "$target/module") OKOSHI=$(realpath "$okoshi")
  with_web npm test --prefix editors/vscode -- web vsix
  if [ $quick = no ] && { [ -n "${CODE_SERVER:-}" ] || [ -e "$target/workbench/code-server/done" ]; }; then
    ONLY="in the browser" with_web npm run workbench --prefix editors/vscode
  else echo "skipped: the workbench, which npm run workbench --prefix editors/vscode installs"; fi
}

# Installs Firefox and a screen for it, or leaves the step.
use_firefox() {
  if { [ -n "${FIREFOX:-}" ] || [ -x /usr/bin/firefox-esr ] || [ -x /usr/bin/firefox ]; } && command -v xvfb-run > /dev/null; then return; fi
  [ $quick = no ] || skip "--quick, and Firefox or Xvfb is not installed"
  install "Firefox or Xvfb" firefox-esr xvfb xauth libgl1-mesa-dri
}

# The page that has the module, in Firefox.
firefox_tests() { # FOLDER NAMES…
  need npm
  use_module
  use_firefox
  use_program
  BROWSER=firefox OKOSHI=$(realpath "$okoshi") OKOSHI_MODULE=$(realpath "$target/module") page_tests "$1" xvfb-run -a -- "${@:2}"
}
# What runs in the same way in Chromium, strings and lessons, is left to who changes it.
firefox() { firefox_tests firefox app. sharing. welcome.; }
firefox_worker() { OKOSHI_HOST=worker firefox_tests firefox-worker editing.test.; }

# What a package holds is enough: installed from it without npm, the program serves the page.
package() {
  need npm
  need curl
  with_web node -e 'import("./editors/web/scripts/install.mjs").then(({ install }) => install())'
  with_web npm run build --prefix editors/web
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
  use_program
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

# Does what installs or builds in editors/web, one at a time.
with_web() { flock "$target/web.lock" "$@"; }

# Installs the packages of the tools, once.
with_tools() {
  (
    flock 4
    [ $tools/node_modules/.package-lock.json -nt $tools/package-lock.json ] || (cd $tools && npm ci --no-audit --no-fund)
  ) 4> "$target/tools.lock"
}

validator() {
  need npm
  built
  with_tools
  built_models | xargs node $tools/validate.mjs
}

# What is printed for programs follows the schemas in docs.
schemas() {
  need npm
  built
  with_tools
  local drawing report
  # The examples' reports are there; the cases add what no example has.
  for drawing in tests/cases/*/drawing.svg; do
    report=$models/cases/$(basename "$(dirname "$drawing")").json
    mkdir -p "$(dirname "$report")"
    "$okoshi" inspect -q "$drawing" --json > "$report" 2> /dev/null || true
    [ -s "$report" ] || rm "$report"
  done
  find "$models" -name '*.json' -print0 | xargs -0 node $tools/schemas.mjs docs/okoshi-inspect.schema.json
  "$okoshi" check --look --format json examples/*.svg tests/cases/*/drawing.svg > "$target/check.json" || true
  node $tools/schemas.mjs docs/okoshi-check.schema.json "$target/check.json"
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
  # One at a time.
  (
    flock 4
    $sudo apt-get update -q
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -yq --no-install-recommends "$@"
  ) 4> "$target/apt.lock"
}

# Models of clip art by others, beside the drawings.
clip_art() {
  [ $quick = no ] || skip "--quick"
  need npm
  local art=/usr/share/openclipart/svg
  [ -d $art ] || (install "the Open Clip Art Library" openclipart-svg) || [ $? = 77 ] || exit 1
  with_tools
  rm -rf "$target/clip-art"
  if [ -d $art ]; then
    node $tools/clip_art.mjs "$target/clip-art" $art
  else
    node $tools/clip_art.mjs "$target/clip-art"
  fi
  export LOOK_DIR
  LOOK_DIR=$(realpath "$target/clip-art")
  cargo test --locked --test as_drawn -- --ignored --nocapture survey
  cargo test --locked --lib -- --ignored --nocapture limbs_of_clip_art
}

# Emoji with names alone, from all sides; the names that are found without any; and the changes that are refused then. The pictures to look
# at are in the folder's index.html.
sides() {
  [ $quick = no ] || skip "--quick"
  need npm
  with_tools
  use_program
  rm -rf "$target/sides"
  OKOSHI=$(realpath "$okoshi") node $tools/sides.mjs "$target/sides"
  OKOSHI=$(realpath "$okoshi") node $tools/annotate.mjs all "$target/annotated"
  OKOSHI=$(realpath "$okoshi") node $tools/refused.mjs
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
  # All in one Blender: its start takes longer than most models.
  plain | sed 's/\(.*\)\.glb$/\1.glb \1.skin.glb/' | xargs blender -b --factory-startup --python-exit-code 1 \
    --python $tools/blender_skin.py --
}

# Light on landscapes without textures.
blender_light() {
  [ $quick = no ] || skip "--quick"
  built
  command -v blender > /dev/null || install Blender blender python3-numpy
  plain | grep -E '/(island|terrain/[a-z]+)\.glb$' | xargs blender -b --factory-startup --python-exit-code 1 \
    --python $tools/blender_light.py --
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

# Makes the pictures of README and docs again, and compares them with the committed ones.
gallery() {
  [ $quick = no ] || skip "--quick"
  command -v inkscape > /dev/null || install Inkscape inkscape
  need python3
  with_pillow
  use_program
  rm -rf "$target/gallery"
  local OKOSHI OUT script
  export OKOSHI OUT
  OKOSHI=$(realpath "$okoshi")
  OUT=$(realpath "$target")/gallery
  for script in gallery tutorial lessons motion_pictures puppet_picture tracking_picture; do bash $tools/$script.sh; done
  OUT=$OUT/starters.png bash $tools/starters.sh
  python3 $tools/moving_picture.py "$OUT/girl.webp"
  # Editors take programs that are not installed for this; the map is as Tiled shows it.
  local elsewhere=("editors/*" tiled-map.png)
  # Those of the page were made by its tests. They are full of text, which looks different in another font.
  local without=
  if ! [ -d editors/web/test/out/page/manual ]; then
    without="which its tests in a browser make"
  elif [ "$(fc-match -f '%{family}' system-ui 2> /dev/null)" != "DejaVu Sans" ]; then
    without="whose font is not DejaVu Sans here"
  fi
  if [ -z "$without" ]; then
    cp -r editors/web/test/out/page/manual/. "$OUT"
  else
    echo "skipped: pictures of the page are not compared, $without"
    elsewhere+=("preview*.png" "without-strings/*")
  fi
  python3 $tools/same_pictures.py "$OUT" docs "${elsewhere[@]}"
}

site() {
  local status=0
  need python3
  need npm
  python3 -c 'import ensurepip' 2> /dev/null || install "Python's venv" python3-venv
  use_program
  OKOSHI=$(realpath "$okoshi") SCRATCH=$target/site-tools bash $tools/site.sh "$target/site" || status=$?
  [ $status != 77 ] || skip "the site's generator or its viewer of models cannot be fetched"
  return $status
}

packages() {
  local tool
  for tool in python3 npm objdump strip dpkg-deb curl; do need $tool; done
  python3 -c 'import ensurepip' 2> /dev/null || install "Python's venv" python3-venv
  use_program
  # With the package for VS Code for the Web, if there is a module for it.
  ! has_editor_module || export OKOSHI_MODULE=$(realpath "$target/module")
  OKOSHI=$(realpath "$okoshi") with_web python3 $tools/release.py "$target/packages"
}

readme() {
  [ -f README.md ] || skip "there is no README.md"
  use_program
  bash tests/readme.sh "$(realpath "$okoshi")"
}

extension() {
  need npm
  use_program
  OKOSHI=$(realpath "$okoshi") with_web npm test --prefix editors/vscode
}

# What is edited by mouse in the panel of a real workbench. To install that takes minutes, which is left to who works on the extension.
workbench() {
  [ $quick = no ] || skip "--quick"
  need npm
  [ -n "${CODE_SERVER:-}" ] || [ -e "$target/workbench/code-server/done" ] ||
    skip "code-server is not installed; npm run workbench --prefix editors/vscode does that"
  ONLY="edited by mouse,undo in the panel,save by another" OKOSHI=$(realpath "$okoshi") with_web npm run workbench --prefix editors/vscode
}

has_chromium() {
  local name
  [ -z "${CHROMIUM:-}" ] || return 0
  for name in chromium chromium-browser google-chrome; do [ ! -x "/usr/bin/$name" ] || return 0; done
  return 1
}

# Installs Chromium, if that may be done. Without a browser, what needs none is tested.
use_chromium() {
  if [ $quick = no ] && ! has_chromium; then (install Chromium chromium) || [ $? = 77 ] || exit 1; fi
}

page() {
  need npm
  use_chromium
  use_program
  OKOSHI=$(realpath "$okoshi") page_tests page --
}

# Eglot is a package of its own before Emacs 29.
has_eglot() { emacs -q --batch -l eglot > /dev/null 2>&1; }

editors() {
  if ! command -v nvim > /dev/null || ! command -v python3 > /dev/null || ! has_eglot; then
    [ $quick = no ] || skip "--quick, and Neovim, Emacs or its Eglot is not installed"
    install "Neovim, Emacs or its Eglot" neovim emacs-nox python3-venv
    has_eglot || install "Emacs' Eglot" elpa-eglot
  fi
  use_program
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
  use_program
  local status=0
  OKOSHI=$(realpath "$okoshi") SCRATCH=$target/inkscape bash $tools/inkscape.sh || status=$?
  [ $status != 77 ] || skip "Inkscape cannot run its extensions here"
  return $status
}

step format formatting
step clippy lints
# Each of the two rows takes about one core: what needs cargo, and what needs the program.
if program; then is_built=yes; fi
begin_aside examples:examples validator:validator schemas:schemas extension:extension workbench:workbench page:page editors:editors inkscape:inkscape_extension \
  blender:blender_import blender-light:blender_light sides:sides gallery:gallery readme:readme firefox:firefox app:app
step package package
step wasm wasm
step test tests
step clip-art clip_art
step doc manual
step features features
step licences licences
step site site
step packages packages
step page-worker page_worker
step firefox-worker firefox_worker
end_aside
# Not beside the other tests of the extension, which are built in the same folder.
step web-extension web_extension

printf '\n==== summary, %d s\n' $SECONDS
printf '%s\n' "${summary[@]}"
echo "$skipped skipped"
if [ $failed = 0 ]; then echo "all well"; else echo "SOMETHING FAILED"; fi
exit $failed
