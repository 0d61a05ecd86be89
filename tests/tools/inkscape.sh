#!/usr/bin/env bash
# Drives the extension from the real Inkscape: OKOSHI=/path/to/okoshi SCRATCH=folder bash tests/tools/inkscape.sh
#
# Tests installation; models from the command line, which must be byte for byte those of `okoshi build`; errors in a drawing; and in
# a window on a virtual screen (Xvfb, openbox, xdotool) the menu entries, clicks on findings, which select objects, names that are
# suggested, changes of the page that are taken in, saving while the preview or `okoshi watch` runs, and Save As. Screenshots go to
# SCRATCH/shots; OKOSHI_REWRITE=pictures also replaces those of the manual.
# Without OKOSHI the program is taken from target/. Exits with status 77 and a reason if something is not installed.
set -euo pipefail
cd "$(dirname "$0")/../.."
project=$PWD
if [ -z "${OKOSHI:-}" ]; then
  for built in target/debug/okoshi target/release/okoshi; do [ ! -x $built ] || OKOSHI=$built; done
fi
: "${OKOSHI:?names the program to test}"
: "${SCRATCH:?names a folder for what is not kept}"
program=$(realpath "$OKOSHI")
unset OKOSHI DISPLAY WAYLAND_DISPLAY
for tool in inkscape Xvfb openbox xdotool import curl dbus-daemon gdbus; do
  command -v $tool > /dev/null || { echo "skipped: $tool is not installed"; exit 77; }
done
rm -rf "$SCRATCH"
mkdir -p "$SCRATCH/shots"
SCRATCH=$(realpath "$SCRATCH")

# Independent of the user's configuration, and without changes to it.
export INKSCAPE_PROFILE_DIR=$SCRATCH/profile XDG_CONFIG_HOME=$SCRATCH/config XDG_DATA_HOME=$SCRATCH/data \
  XDG_CACHE_HOME=$SCRATCH/cache PYTHONDONTWRITEBYTECODE=1
mkdir -p "$INKSCAPE_PROFILE_DIR" "$XDG_CONFIG_HOME" "$XDG_DATA_HOME" "$XDG_CACHE_HOME"

python=/usr/bin/python3
[ -x $python ] || python=python3
inkex=$(inkscape --system-data-directory 2> /dev/null | tail -n 1)/extensions
PYTHONPATH=$inkex $python -c 'import inkex' 2> /dev/null \
  || { echo "skipped: Inkscape's inkex does not load (python3-cssselect, python3-lxml, python3-numpy)"; exit 77; }
$python -c 'import gi; gi.require_version("Gtk", "3.0"); from gi.repository import Gtk' 2> /dev/null \
  || { echo "skipped: Python has no GTK 3 (python3-gi, gir1.2-gtk-3.0)"; exit 77; }

started=()
cleanup() {
  # Previews are stopped by the extension itself.
  env PYTHONPATH="$inkex" $python "$project/editors/inkscape/extension/okoshi_stop.py" > /dev/null 2>&1 || true
  local one
  for one in "${started[@]}"; do kill "$one" 2> /dev/null || true; done
}
trap cleanup EXIT

fail() { echo "FAILED: $*" >&2; exit 1; }
has() { grep -qF -- "$2" "$1" || { cat "$1" >&2; fail "$1 lacks: $2"; }; } # FILE TEXT
# Waits until a command succeeds; the limit only ends a test that hangs.
await() { # COMMAND…
  local end=$((SECONDS + 180))
  until "$@" > /dev/null 2>&1; do
    [ $SECONDS -lt $end ] || { shot in-vain || true; cat "${log:-/dev/null}"; fail "in vain: $*"; }
    sleep 0.1
  done
}

echo "-- without Inkscape"
PYTHONPATH=$inkex $python -m unittest discover -q editors/inkscape/test

echo "-- installing"
install=editors/inkscape/install.sh
place=$INKSCAPE_PROFILE_DIR/extensions/okoshi
if env PATH=/usr/bin:/bin HOME="$SCRATCH" bash $install > "$SCRATCH/log" 2>&1; then fail "installed without a program"; fi
has "$SCRATCH/log" "pip install okoshi-*.whl"
if bash $install --okoshi /bin/true > "$SCRATCH/log" 2>&1; then fail "accepted another program as okoshi"; fi
has "$SCRATCH/log" "is not okoshi"
if bash $install --nonsense > "$SCRATCH/log" 2>&1; then fail "accepted an unknown option"; fi
has "$SCRATCH/log" "--uninstall"
bash $install --okoshi "$program" > "$SCRATCH/log"
has "$SCRATCH/log" "installed: $place"
[ -e "$INKSCAPE_PROFILE_DIR/templates/okoshi/dragon.svg" ] || fail "no templates"
(cd "$place" && sha256sum ./*) > "$SCRATCH/first"
touch "$place/okoshi_left_by_an_older_version.inx"
bash $install --okoshi "$program" > "$SCRATCH/log"
(cd "$place" && sha256sum ./*) | diff "$SCRATCH/first" -
bash $install --uninstall > "$SCRATCH/log"
[ ! -e "$place" ] || fail "still there: $place"
bash $install --uninstall > "$SCRATCH/log"
has "$SCRATCH/log" "nothing to remove"
bash $install --okoshi "$program" --link > "$SCRATCH/log"
inkscape examples/human.svg --export-filename="$SCRATCH/linked.glb" > "$SCRATCH/log" 2>&1 || { cat "$SCRATCH/log"; fail "links"; }
[ -s "$SCRATCH/linked.glb" ] || fail "links do not work"
# From here on Inkscape finds the program only by the installed path.
bash $install --okoshi "$program" --folder "$INKSCAPE_PROFILE_DIR/extensions" > "$SCRATCH/log"

echo "-- models from the command line"
here="$SCRATCH/zwei Öhrchen"
mkdir "$here"
cp examples/human.svg examples/looks.svg examples/*.png examples/shapes/model.svg examples/shapes/biscuit.glb "$here/"
# A picture in a subfolder, with a percent-encoded link.
mkdir "$here/Bil der"
cp "$here/gull.png" "$here/Bil der/Möwe & Co.png"
sed 's|href="gull.png"|href="Bil%20der/M%C3%B6we%20\&amp;%20Co.png"|' "$here/looks.svg" > "$here/möwe.svg"
cmp -s "$here/looks.svg" "$here/möwe.svg" && fail "möwe.svg has its old link"
cd /
for name in human looks model möwe; do
  for ending in glb gltf; do
    "$program" build -q "$here/$name.svg" -o "$SCRATCH/expected.$ending"
    inkscape "$here/$name.svg" --export-filename="$SCRATCH/$name.$ending" > "$SCRATCH/log" 2>&1 || { cat "$SCRATCH/log"; fail "$name.$ending"; }
    cmp "$SCRATCH/$name.$ending" "$SCRATCH/expected.$ending"
  done
done

echo "-- a drawing with a fault"
sed 's/@Ubody/@Ubdoy/' "$here/human.svg" > "$here/fault.svg"
echo "as before" > "$SCRATCH/fault.glb"
# Inkscape 1.2 crashes if an extension writes nothing.
if inkscape "$here/fault.svg" --export-filename="$SCRATCH/fault.glb" 2>&1 | cat > "$SCRATCH/log"; then fail "the error was ignored"; fi
has "$SCRATCH/log" 'error[E204]: there is no part named `Ubdoy`; write `Ubody`'
grep -qE '^fault\.svg:[0-9]+:[0-9]+, ' "$SCRATCH/log" || fail "the error names no place"
[ "$(cat "$SCRATCH/fault.glb")" = "as before" ] || fail "the previous file was overwritten"
rm "$SCRATCH/fault.glb"
! inkscape "$here/fault.svg" --export-filename="$SCRATCH/fault.glb" > /dev/null 2> "$SCRATCH/log" || fail "the error was ignored"
has "$SCRATCH/log" 'error[E204]: there is no part named `Ubdoy`'
[ ! -e "$SCRATCH/fault.glb" ] || fail "a file was written in spite of errors"
cp "$here/looks.svg" "$SCRATCH/alone.svg"
! inkscape "$SCRATCH/alone.svg" --export-filename="$SCRATCH/fault.glb" 2>&1 | cat > "$SCRATCH/log"
has "$SCRATCH/log" 'error[E006]: the link `gull.png` is not there'

echo "-- a screen"
Xvfb -displayfd 3 -screen 0 1280x900x24 -nolisten tcp 3> "$SCRATCH/display" > "$SCRATCH/xvfb.log" 2>&1 &
started+=($!)
await test -s "$SCRATCH/display"
DISPLAY=:$(cat "$SCRATCH/display")
export DISPLAY
log=$SCRATCH/inkscape.log
# The form of a part lies beside the drawing from the start: Inkscape, which waits for it, does not draw what a window uncovers that is moved.
mkdir "$XDG_CONFIG_HOME/openbox"
beside='<application title="* in form.svg: Okoshi"><position force="yes"><x>715</x><y>190</y></position></application>'
sed "s|</applications>|$beside</applications>|" /etc/xdg/openbox/rc.xml > "$XDG_CONFIG_HOME/openbox/rc.xml"
openbox > "$SCRATCH/openbox.log" 2>&1 &
started+=($!)
shot() { import -window root "$SCRATCH/shots/$1.png"; }
# Waits until some pictures of the screen in turn are alike: what was typed and clicked is shown then.
settle() {
  alike=0
  rm -f "$SCRATCH/before.rgb"
  await is_still
}
is_still() {
  import -window root "$SCRATCH/screen.rgb"
  if cmp -s "$SCRATCH/screen.rgb" "$SCRATCH/before.rgb"; then alike=$((alike + 1)); else alike=0; fi
  mv "$SCRATCH/screen.rgb" "$SCRATCH/before.rgb"
  [ $alike -ge 4 ]
}
gone() { ! kill -0 "$1"; }
window() { xdotool search --onlyvisible --name "$1"; }
# Message windows have no title.
message() {
  local active name
  active=$(xdotool getactivewindow) && name=$(xdotool getwindowname "$active") && [ -z "$name" ]
}
begin() { # ARGUMENTS…
  : > "$log"
  inkscape "$@" >> "$log" 2>&1 &
  inkscape=$!
  started+=("$inkscape")
}
entry() { # DRAWING ID TEXT: calls an entry of the menu, and waits for its message, in which the text must be
  begin --batch-process "$1" --actions="org.okoshi.$2.noprefs"
  await grep -qF -- "$3" "$log"
  await message
  settle
  shot "$2-$(basename "$1" .svg)"
  xdotool key Escape
  await gone "$inkscape"
}
inkscape --action-list 2> /dev/null > "$SCRATCH/actions"
for id in check explain part preview stop suggest take-in; do has "$SCRATCH/actions" "org.okoshi.$id.noprefs:"; done

echo "-- entries of the menu"
cp "$here/human.svg" "$here/fault.svg" "$SCRATCH/"
report() { # NAME FIELD: a field of the report on the drawing of this name
  $python - "$XDG_CACHE_HOME/okoshi/inkscape" "$1" "$2" << 'END'
import glob, json, sys
for path in glob.glob(sys.argv[1] + "/*/report.json"):
    report = json.load(open(path))
    if report["name"] == sys.argv[2]:
        print(report[sys.argv[3]])
END
}
check() { # DRAWING HEADLINE DETAIL: the check's window has these lines
  local name
  name=$(basename "$1")
  begin --batch-process "$1" --actions="org.okoshi.check.noprefs"
  await window "^$name: Okoshi"
  await gone "$inkscape"
  settle
  shot "check-$(basename "$1" .svg)"
  [ "$(report "$name" headline)" = "$2" ] || fail "the headline is $(report "$name" headline)"
  [ "$(report "$name" detail)" = "$3" ] || fail "the detail is $(report "$name" detail)"
}
close() { # NAME: closes the window on a drawing
  xdotool windowactivate --sync "$(window "^$1: Okoshi")" key Escape
  await none "^$1: Okoshi"
}
none() { ! window "$1"; }
check "$here/human.svg" "2 hints in human.svg" "7 parts, 12 strings"
close human.svg
check "$here/looks.svg" "No problems in looks.svg" "9 parts, 10 strings"
close looks.svg

echo "-- findings that are clicked"
# Inkscape's actions are on the session's message bus, which Inkscape otherwise does without here.
dbus-daemon --session --nofork --print-address > "$SCRATCH/bus" 2> "$SCRATCH/bus.log" &
started+=($!)
await test -s "$SCRATCH/bus"
bus=$(cat "$SCRATCH/bus")
action() { # NAME [ARGUMENT]: calls an action of the running Inkscape
  DBUS_SESSION_BUS_ADDRESS=$bus gdbus call --session --dest org.inkscape.Inkscape --object-path /org/inkscape/Inkscape \
    --method org.gtk.Actions.Activate "$1" "[${2:+<'$2'>}]" '{}' > /dev/null
}
selected() { action select-list; grep "^$1 " "$log"; } # ID
DBUS_SESSION_BUS_ADDRESS=$bus begin "$here/fault.svg"
await window "fault.svg - Inkscape"
xdotool windowactivate --sync "$(window "fault.svg - Inkscape" | tail -n 1)"
settle
# The page fills the window.
xdotool key 5
action org.okoshi.check.noprefs
await window "^fault.svg: Okoshi"
settle
shot check-fault
[ "$(report fault.svg headline)" = "3 errors, 2 hints in fault.svg" ] || fail "the headline is $(report fault.svg headline)"
findings=$(window "^fault.svg: Okoshi")
# Beside the drawing.
xdotool windowmove --sync "$findings" 740 420
eval "$(xdotool getwindowgeometry --shell "$findings")"
xdotool windowactivate --sync "$findings" mousemove $((X + 100)) $((Y + 100)) click 1
await selected text150
# The keyboard does it too.
xdotool windowactivate --sync "$findings" key Down Return
await selected text154
settle
shot check-selected
manual() { # SHOT NAME: puts a screenshot into the manual, if pictures are to be rewritten
  case ",${OKOSHI_REWRITE:-}," in
    *,pictures,*) convert "$SCRATCH/shots/$1.png" +dither -colors 128 "$project/docs/editors/$2.png" ;;
  esac
}
manual check-selected inkscape
# Another check shows its result in the same window.
action delete-selection
action org.okoshi.check.noprefs
fewer() { [ "$(report fault.svg headline)" = "2 errors, 3 hints in fault.svg" ]; }
await fewer
settle
[ "$(window "^fault.svg: Okoshi")" = "$findings" ] || fail "there is a second window"
shot check-again
close fault.svg
kill "$inkscape"
await gone "$inkscape"
entry "$here/human.svg" explain '- `Shape`: how the flat outline becomes a solid'
cmp "$here/human.svg" "$SCRATCH/human.svg"
cmp "$here/fault.svg" "$SCRATCH/fault.svg"

echo "-- names that are suggested"
entry "$here/looks.svg" suggest "every part has a name already"
cp "$project/tests/binding/art/fl_cow.svg" "$here/cow.svg"
DBUS_SESSION_BUS_ADDRESS=$bus begin "$here/cow.svg"
await window "cow.svg - Inkscape"
xdotool windowactivate --sync "$(window "cow.svg - Inkscape" | tail -n 1)"
settle
action select-by-id s5
saved_copy() { # NAME: what Inkscape would save
  action export-filename "$SCRATCH/$1.svg"
  action export-do
  await test -s "$SCRATCH/$1.svg"
}
labels() { saved_copy "$1"; grep -c 'inkscape:label=' "$SCRATCH/$1.svg" || true; } # NAME
undo() { xdotool windowactivate --sync "$(window "$1 - Inkscape" | tail -n 1)" key ctrl+z; } # NAME
[ "$(labels cow-before)" = 0 ] || fail "the cow has labels"
action org.okoshi.suggest.noprefs
await window "^cow.svg: Okoshi"
# Beside the drawing.
xdotool windowmove --sync "$(window "^cow.svg: Okoshi")" 740 420
settle
shot suggest
manual suggest inkscape-names
[ "$(report cow.svg headline)" = "6 names in cow.svg" ] || fail "the headline is $(report cow.svg headline)"
selected s5
[ "$(labels cow-named)" = 6 ] || fail "the cow has not got its labels"
"$program" annotate -q "$here/cow.svg" -o "$SCRATCH/cow-expected.svg"
for drawing in cow-named cow-expected; do "$program" inspect -q "$SCRATCH/$drawing.svg" | sed 1d > "$SCRATCH/$drawing.txt"; done
cmp "$SCRATCH/cow-named.txt" "$SCRATCH/cow-expected.txt"
close cow.svg
undo cow.svg
undone() { [ "$(labels "$1")" = 0 ]; }
await undone cow-undone
diff <(sed '/<path/,$!d' "$SCRATCH/cow-before.svg") <(sed '/<path/,$!d' "$SCRATCH/cow-undone.svg") || fail "one step does not undo it"
kill "$inkscape"
await gone "$inkscape"
cmp "$here/cow.svg" "$project/tests/binding/art/fl_cow.svg"

echo "-- the form of a part"
cp "$project/examples/human.svg" "$here/form.svg"
DBUS_SESSION_BUS_ADDRESS=$bus begin "$here/form.svg"
await window "form.svg - Inkscape"
xdotool windowactivate --sync "$(window "form.svg - Inkscape" | tail -n 1)"
settle
xdotool key 5
part() { # TITLE OBJECT…: opens the form of selected objects; Inkscape answers when it is closed
  local title=$1 object
  shift
  action select-clear
  for object in "$@"; do action select-by-id "$object"; done
  action org.okoshi.part.noprefs &
  await window "^$title in form.svg: Okoshi"
  xdotool windowactivate --sync "$(window "^$title in form.svg: Okoshi")"
  settle
}
# Inkscape listens while it waits for the form, but takes no other extension then.
ready() { await is_ready && settle; }
is_ready() { ! pgrep -f "$place/okoshi_part" && action select-list; }
says() { saved_copy "$1" && grep -qF -- "$2" "$SCRATCH/$1.svg"; } # NAME TEXT
part Rarm text154
shot part
manual part inkscape-part
# The name has the focus; Return applies.
xdotool type --delay 30 -- Rhand
settle
xdotool key Return
ready
await says formed '>Rhand@Ubody$Shape roundv -90 90<'
selected text154
undo form.svg
# One step takes it back.
await says unformed '>Rarm@Ubody$Shape roundv -90 90<'
# A shape whose colour is that of a legend: that is asked.
part U-1 path106
xdotool key --delay 100 Tab Tab Tab ctrl+a
xdotool type --delay 30 -- '#ff0000'
xdotool key Return
settle
shot part-refused
xdotool key Return
ready
await says legend '>$Shape roundv -90 90 Color #ff0000<'
# Two parts get the same colour, which a legend of both says.
part "Rarm, Larm" path114 path116
xdotool key --delay 100 Tab Tab ctrl+a
xdotool type --delay 30 -- '#00ff00'
xdotool key Return
settle
shot part-several
xdotool key Return
ready
await says several '>$Shape default -15 15 Color #00ff00<'
# Nothing is changed by a form that is closed, or without a selection.
part U-1 path106
xdotool key Escape
ready
action select-clear
action org.okoshi.part.noprefs &
await window "^form.svg: Okoshi"
settle
shot part-nothing
xdotool key Escape
ready
saved_copy same
cmp "$SCRATCH/several.svg" "$SCRATCH/same.svg"
kill "$inkscape"
await gone "$inkscape"

echo "-- the preview"
mkdir "$SCRATCH/bin"
for opener in xdg-open www-browser; do
  printf '#!/bin/sh\necho "$@" >> "%s"\n' "$SCRATCH/opened" > "$SCRATCH/bin/$opener"
  chmod +x "$SCRATCH/bin/$opener"
done
export BROWSER="$SCRATCH/bin/xdg-open"
preview() {
  begin --batch-process "$1" --actions="org.okoshi.preview.noprefs"
  await gone "$inkscape"
}
opened() { [ "$(grep -c . "$SCRATCH/opened")" = "$1" ]; } # NUMBER
# Of the server that is running.
states() { find "$XDG_CACHE_HOME/okoshi/inkscape" -name server.json -exec grep -L '"ended"' {} +; }
field() { $python -c 'import json, sys; print(json.load(open(sys.argv[1]))[sys.argv[2]])' "$(states)" "$1"; }
preview "$here/looks.svg"
await opened 1
page=$(head -n 1 "$SCRATCH/opened")
serves() { curl -sf -o "$SCRATCH/page" "$page"; }
await serves
pid=$(field pid)
preview "$here/looks.svg"
await opened 2
[ "$(sort -u "$SCRATCH/opened")" = "$page" ] || fail "two pages of one drawing: $(cat "$SCRATCH/opened")"
[ "$(field pid)" = "$pid" ] || fail "a second server was started"
# The server shows a copy of the canvas, with the links of the drawing; then what is saved, at once.
copy=$(field copy)
has "$copy" 'xlink:href="gull.png"'
shown() { grep -q " $1 parts" "$(dirname "$copy")/log.txt"; } # NUMBER
await shown 9
sed 's/Sail@Mast[^<]*/*/' "$here/looks.svg" > "$SCRATCH/new.svg"
cat "$SCRATCH/new.svg" > "$here/looks.svg"
await shown 8
entry "$here/looks.svg" stop "1 preview stopped"
[ ! -e "$copy" ] || fail "the copy was left"
if serves; then fail "the page is served on"; fi

echo "-- changes that the page makes"
cp "$project/examples/human.svg" "$here/mine.svg"
: > "$SCRATCH/opened"
DBUS_SESSION_BUS_ADDRESS=$bus begin "$here/mine.svg"
await window "mine.svg - Inkscape"
xdotool windowactivate --sync "$(window "mine.svg - Inkscape" | tail -n 1)"
settle
action org.okoshi.preview.noprefs
await opened 1
page=$(head -n 1 "$SCRATCH/opened")
await serves
copy=$(field copy)
# As the page writes it, which the tests of the program show.
change() { sed "s/$2/$3/" "$1" > "$SCRATCH/new.svg" && ! cmp -s "$1" "$SCRATCH/new.svg" && cat "$SCRATCH/new.svg" > "$1"; } # FILE OLD NEW
change "$copy" '>Rarm@Ubody' '>Rhand@Ubody'
# Meanwhile something is moved in Inkscape, and saved.
action select-by-id path110
action transform-translate 3,0
await window "^\*mine.svg"
xdotool windowactivate --sync "$(window "^\*mine.svg" | tail -n 1)" key ctrl+s
moved() { ! cmp -s "$here/mine.svg" "$project/examples/human.svg"; }
await moved
has "$here/mine.svg" 'Rarm@Ubody'
# The copy has both then.
drawn() { grep -oE ' (d|transform|x)="[^"]*"' "$1"; } # FILE
both() { grep -qF 'Rhand@Ubody' "$copy" && cmp -s <(drawn "$copy") <(drawn "$here/mine.svg"); }
await both
action org.okoshi.take-in.noprefs
await window "^mine.svg: Okoshi"
settle
shot take-in
[ "$(report mine.svg headline)" = "1 change taken into mine.svg" ] || fail "the headline is $(report mine.svg headline)"
close mine.svg
selected path110
saved_copy taken
has "$SCRATCH/taken.svg" 'Rhand@Ubody'
undo mine.svg
taken_back() { saved_copy taken-back && grep -qF 'Rarm@Ubody' "$SCRATCH/taken-back.svg"; }
await taken_back
# One step: what was moved before stays so.
diff <(drawn "$SCRATCH/taken-back.svg") <(drawn "$here/mine.svg") || fail "more was undone"
# Another program changes the file itself.
change "$here/mine.svg" '>Larm@Ubody' '>Lhand@Ubody'
action org.okoshi.take-in.noprefs
await window "^mine.svg: Okoshi"
settle
close mine.svg
saved_copy taken-again
has "$SCRATCH/taken-again.svg" 'Lhand@Ubody'
has "$SCRATCH/taken-again.svg" 'Rarm@Ubody'
kill "$inkscape"
await gone "$inkscape"
entry "$here/mine.svg" take-in "There is nothing to take in"
entry "$here/mine.svg" stop "1 preview stopped"

echo "-- saves while okoshi watches"
watched=$SCRATCH/watched
mkdir "$watched"
cp "$project/examples/human.svg" "$watched/a.svg"
(cd "$watched" && exec "$program" watch a.svg) > "$SCRATCH/watch.log" 2>&1 &
started+=($!)
built() { [ "$(grep -c 'a.glb in' "$SCRATCH/watch.log")" = "$1" ]; } # TIMES
await built 1
for save in $(seq 2 21); do
  inkscape "$watched/a.svg" --actions="select-by-id:path110;transform-translate:1,0;export-type:svg;export-filename:$watched/a.svg;export-overwrite;export-do" \
    > "$SCRATCH/log" 2>&1
  await built "$save"
  cp "$watched/a.glb" "$watched/$save.glb"
done
begin --with-gui --actions="select-by-id:path110" "$watched/a.svg"
await window "a.svg - Inkscape"
xdotool windowactivate --sync "$(window "a.svg - Inkscape" | tail -n 1)"
settle
# A click gives the canvas the focus, here on the selected object, beside its string.
xdotool mousemove 614 503 click 1
settle
for save in $(seq 22 41); do
  xdotool key Right
  await window "^\*a.svg"
  xdotool key ctrl+s
  await built "$save"
  cp "$watched/a.glb" "$watched/$save.glb"
done
shot saved
kill "$inkscape"
if grep -q 'error' "$SCRATCH/watch.log"; then cat "$SCRATCH/watch.log"; fail "a save was taken for an error"; fi
# Saves are built in their order: when this one is refused, no build of another one is to come.
echo "<svg" > "$watched/a.svg"
await grep -q 'error' "$SCRATCH/watch.log"
built 41 || fail "more builds than saves"
[ "$(sha256sum "$watched"/*.glb | cut -d' ' -f1 | sort -u | wc -l)" = 40 ] || fail "builds that are alike"
"$program" render "$watched/41.glb" -q -o "$SCRATCH/shots/saved-41.png"

echo "-- Save As and Save a Copy"
save() { # KEYS NAME
  xdotool key "$1"
  await window "Select file to save"
  xdotool windowactivate --sync "$(window "Select file to save" | tail -n 1)" key ctrl+a
  xdotool type --delay 30 -- "$2"
  settle
  shot "save-as-$(basename "$2")"
  xdotool key Return
}
begin "$here/möwe.svg"
await window "möwe.svg - Inkscape"
xdotool windowactivate --sync "$(window "möwe.svg - Inkscape" | tail -n 1)"
settle
# A screenshot of the menu: Okoshi is the tenth entry from the end.
xdotool key 5 alt+n
settle
xdotool key --delay 50 Up Up Up Up Up Up Up Up Up Right
settle
shot menu
xdotool key --delay 100 Escape Escape Escape
mkdir "$SCRATCH/elsewhere"
save ctrl+shift+alt+s "$SCRATCH/elsewhere/copy.glb"
await cmp -s "$SCRATCH/elsewhere/copy.glb" "$SCRATCH/expected.glb"
save ctrl+shift+s beside.gltf
await cmp -s "$here/beside.gltf" "$SCRATCH/expected.gltf"
await window "beside.gltf - Inkscape"
# For Save As, Inkscape reports the path of the model, not that of the drawing.
save ctrl+shift+s "$SCRATCH/elsewhere/lost.glb"
await grep -qF 'File → Save a Copy' "$log"
await message
settle
shot save-as-elsewhere
has "$log" 'canvas.png` is not there'
[ ! -e "$SCRATCH/elsewhere/lost.glb" ] || fail "a file was written in spite of errors"
kill "$inkscape"
echo "all of Inkscape is well; pictures are in $SCRATCH/shots"
