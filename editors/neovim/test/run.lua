-- Drives the language server from a real Neovim, through the plugin that users install:
--   OKOSHI=target/debug/okoshi nvim --headless -u NONE -i NONE -n -c 'luafile editors/neovim/test/run.lua'
-- OKOSHI_ENCODING=utf-8 or utf-16 offers only that encoding; ONLY=words runs the tests whose names contain them.

local here = vim.fn.fnamemodify(debug.getinfo(1, 'S').source:sub(2), ':p:h')
package.path = here .. '/?.lua;' .. package.path

local only = os.getenv('ONLY')
local passed, failed, skipped = 0, 0, {}

local function say(words)
  io.stdout:write(words .. '\n')
end

local ok, problem = xpcall(function()
  local harness = require('harness')
  harness.install()
  for _, file in ipairs({ 'questions', 'changes', 'typing', 'life' }) do
    for _, test in ipairs(require(file)) do
      local name, run = test[1], test[2]
      local can = not test.needs or vim.fn.has(test.needs) == 1
      if not can then
        skipped[test.needs] = (skipped[test.needs] or 0) + 1
      elseif (not only or name:find(only, 1, true)) then
        local well, trouble = xpcall(run, debug.traceback)
        local ended, unrest = xpcall(harness.close, debug.traceback)
        if well and ended then
          passed = passed + 1
        else
          failed = failed + 1
          say('FAILED ' .. name .. '\n' .. tostring(well and unrest or trouble))
        end
      end
    end
  end
end, debug.traceback)

if not ok then
  say('FAILED before the end\n' .. problem)
  failed = failed + 1
end
local version = vim.version()
for needs, count in pairs(skipped) do
  say(('skipped: %d of the tests in Neovim %d.%d need %s'):format(count, version.major, version.minor, needs))
end
local encoding = os.getenv('OKOSHI_ENCODING') or 'default'
say(('Neovim %d.%d.%d, encoding %s: %d passed, %d failed'):format(
  version.major, version.minor, version.patch, encoding, passed, failed))
vim.cmd((failed > 0 or passed == 0) and 'cquit! 1' or 'qall!')
