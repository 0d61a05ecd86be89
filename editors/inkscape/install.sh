#!/usr/bin/env bash
# Installs okoshi's extension into Inkscape for the current user: bash install.sh
#
#   --okoshi PATH   the program, if it is not on the PATH or in ~/.cargo/bin; or set the variable OKOSHI
#   --folder DIR    Inkscape's folder of user extensions, if Inkscape does not report it (see Edit → Preferences → System)
#   --link          links instead of copies, for work on the extension
#   --uninstall     removes the extension
#
# Set the variable INKSCAPE to the program if it is not on the PATH. Run this again to update.
set -euo pipefail

usage() { sed -n '2,9s/^# \{0,1\}//p' "$0"; }
fail() { printf '%s\n' "$@" >&2; exit 1; }

here=$(cd "$(dirname "$0")" && pwd)
okoshi=${OKOSHI:-} folder='' link=no uninstall=no
while [ $# -gt 0 ]; do
  case $1 in
    --okoshi | --folder)
      [ $# -gt 1 ] || { echo "$1 needs a path" >&2; exit 2; }
      if [ "$1" = --okoshi ]; then okoshi=$2; else folder=$2; fi
      shift ;;
    --link) link=yes ;;
    --uninstall) uninstall=yes ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done

# ---- Inkscape and its folder

inkscape=${INKSCAPE:-}
if [ -z "$inkscape" ]; then
  for place in inkscape /Applications/Inkscape.app/Contents/MacOS/inkscape "$HOME/Applications/Inkscape.app/Contents/MacOS/inkscape"; do
    if command -v "$place" > /dev/null; then inkscape=$place; break; fi
  done
fi
if [ -n "$inkscape" ]; then
  command -v "$inkscape" > /dev/null || fail "INKSCAPE is set to $inkscape, which is not a program."
  said=$("$inkscape" --version 2> /dev/null | sed -n 's/^Inkscape \([0-9][0-9.]*\).*/\1/p' | head -n 1)
  case $said in
    '') fail "$inkscape does not report its version." ;;
    0.*) fail "This is Inkscape $said; the extension needs 1.0 or newer." ;;
  esac
  echo "Inkscape $said: $(command -v "$inkscape")"
  [ -n "$folder" ] || folder=$("$inkscape" --user-data-directory 2> /dev/null | tail -n 1)/extensions
elif [ -z "$folder" ]; then
  fail "Inkscape was not found. Install it, or set the variable INKSCAPE to its path, or pass its folder of extensions with --folder:" \
    "Edit → Preferences → System shows it as User extensions."
fi
target=$folder/okoshi
# Starter drawings, which Inkscape offers under New from Template.
templates=$(dirname "$folder")/templates/okoshi

# ---- Uninstall

if [ $uninstall = yes ]; then
  if [ -d "$target" ]; then
    rm -rf -- "$target" "$templates"
    echo "removed: $target"
  else
    echo "nothing to remove: there is no $target"
  fi
  exit 0
fi

# ---- The program

if [ -z "$okoshi" ]; then
  for place in okoshi "$HOME/.cargo/bin/okoshi"; do
    if command -v "$place" > /dev/null; then okoshi=$place; break; fi
  done
fi
[ -n "$okoshi" ] || fail "The program okoshi was not found on the PATH or in ~/.cargo/bin. Install one of its packages" \
  "(pip install okoshi-*.whl, for instance), or pass its path: bash install.sh --okoshi /path/to/okoshi"
okoshi=$(command -v "$okoshi") || fail "$okoshi is not a program."
okoshi=$(cd "$(dirname "$okoshi")" && pwd)/$(basename "$okoshi")
said=$("$okoshi" --version) || fail "$okoshi does not run."
case $said in okoshi\ *) ;; *) fail "$okoshi is not okoshi: its version is \"$said\"." ;; esac
echo "$said: $okoshi"
"$okoshi" preview --help > /dev/null 2>&1 || echo "note: this okoshi is too old for Preview in 3D"

# ---- The files

# The folder is only ours; files of older versions are removed.
rm -rf -- "$target"
mkdir -p "$target"
for file in "$here"/extension/*.inx "$here"/extension/*.py; do
  if [ $link = yes ]; then ln -s "$file" "$target/"; else cp "$file" "$target/"; fi
done
printf '%s\n' "$okoshi" > "$target/okoshi.path"
echo "installed: $target"
# An older program has no list.
if "$okoshi" new --list > /dev/null 2>&1; then
  rm -rf -- "$templates"
  mkdir -p "$templates"
  while read -r name _; do
    "$okoshi" new --quiet "$templates/$name" --template "$name"
  done < <("$okoshi" new --list)
  echo "installed: $templates"
fi

# Debian's Inkscape lacks modules that its extensions need. Other builds contain a Python of their own.
if [ -n "$inkscape" ] && system=$("$inkscape" --system-data-directory 2> /dev/null | tail -n 1) && [ -d "$system/extensions/inkex" ]; then
  case $system in
    /usr/*)
      if [ -x /usr/bin/python3 ] && ! PYTHONPATH=$system/extensions /usr/bin/python3 -c 'import inkex' 2> /dev/null; then
        echo "note: Inkscape's own module inkex does not load; on Debian and Ubuntu this helps:"
        echo "  sudo apt-get install python3-lxml python3-numpy python3-cssselect"
      fi
      if [ -x /usr/bin/python3 ] && ! /usr/bin/python3 -c 'import gi; gi.require_version("Gtk", "3.0")' 2> /dev/null; then
        echo "note: for findings in a window of their own, in which a click selects the object:"
        echo "  sudo apt-get install python3-gi gir1.2-gtk-3.0"
      fi ;;
  esac
fi
echo "Restart Inkscape. Then File → Save As offers glTF, and the menu Extensions has Okoshi; File → New from Template offers the starter drawings."
