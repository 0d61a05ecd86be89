-- Shared by the tests: drawings in temporary folders, each with a server of its own, and requests to it.
--
-- Positions are given by the words at them. Offsets are counted here and not with Neovim's functions, so that errors in counting
-- show.

local M = { exits = {}, buffer = nil, uri = nil }

local here = vim.fn.fnamemodify(debug.getinfo(1, 'S').source:sub(2), ':p:h')
local root = vim.fn.fnamemodify(here, ':h:h:h')
local okoshi = assert(os.getenv('OKOSHI'), 'OKOSHI names the program to test')
-- `default` is Neovim's default encoding: UTF-16 up to 0.10, then UTF-8.
M.wanted_encoding = os.getenv('OKOSHI_ENCODING') or 'default'

local is_new = vim.fn.has('nvim-0.11') == 1

function M.equal(actual, expected, about)
  if not vim.deep_equal(actual, expected) then
    error(('%s\n  expected %s\n  found    %s'):format(about or 'not alike', vim.inspect(expected), vim.inspect(actual)), 2)
  end
end

function M.holds(text, piece)
  if type(text) ~= 'string' or not text:find(piece, 1, true) then
    error(('`%s` is not in\n%s'):format(piece, vim.inspect(text)), 2)
  end
end

-- The limit of every wait, in milliseconds: it only ends a test that hangs.
M.patience = 60000

function M.wait(about, condition)
  if not vim.wait(M.patience, condition, 10) then
    error('waited in vain until ' .. about, 2)
  end
end

-- Puts the plugin on the runtime path, like a user, and configures how to start the server.
function M.install()
  local config = {
    cmd = { okoshi, 'lsp' },
    on_exit = function(code, signal)
      table.insert(M.exits, { code, signal })
    end,
  }
  if M.wanted_encoding ~= 'default' then
    config.capabilities = { general = { positionEncodings = { M.wanted_encoding } } }
    if not is_new then
      config.capabilities = vim.tbl_deep_extend('force', vim.lsp.protocol.make_client_capabilities(), config.capabilities)
      -- Older versions ignore the server's answer; they leave it to this function.
      config.on_init = function(client, answer)
        client.offset_encoding = answer.capabilities.positionEncoding
      end
    end
  end
  if is_new then
    vim.lsp.config('okoshi', config)
  else
    vim.g.okoshi = config
  end
  vim.opt.runtimepath:append(root .. '/editors/neovim')
  vim.cmd('runtime plugin/okoshi.lua')
  vim.cmd('filetype on')
end

local function clients()
  return (vim.lsp.get_clients or vim.lsp.get_active_clients)()
end

function M.client()
  for _, client in pairs(clients()) do
    if client.name == 'okoshi' and vim.lsp.buf_is_attached(M.buffer, client.id) then
      return client
    end
  end
end

function M.read(path)
  local file = assert(io.open(path, 'rb'))
  local text = file:read('*a')
  file:close()
  return text
end

function M.write(path, text)
  local file = assert(io.open(path, 'wb'))
  file:write(text)
  file:close()
end

function M.example(name)
  return M.read(root .. '/examples/' .. name)
end

-- A drawing's text with `old` replaced.
function M.with(text, old, new)
  local start, stop = text:find(old, 1, true)
  assert(start, old .. ' is not in the drawing')
  return text:sub(1, start - 1) .. new .. text:sub(stop + 1)
end

-- Opens a drawing in a new folder.
function M.open(text, name)
  local folder = vim.loop.fs_realpath(vim.fn.fnamemodify(vim.fn.tempname(), ':h')) .. '/' .. vim.loop.hrtime()
  vim.fn.mkdir(folder, 'p')
  M.folder = folder
  M.path = folder .. '/' .. (name or 'drawing.svg')
  M.write(M.path, text)
  vim.cmd('edit! ' .. vim.fn.fnameescape(M.path))
  M.buffer = vim.api.nvim_get_current_buf()
  M.uri = vim.uri_from_bufnr(M.buffer)
  M.wait('a server is attached', M.client)
  M.wait('the server has introduced itself', function()
    return M.client().server_capabilities and M.client().initialized ~= false
  end)
end

-- Closes everything; the servers must exit by themselves, without error messages.
function M.close()
  local before, running = #M.exits, 0
  for _, client in pairs(clients()) do
    running = running + 1
    vim.lsp.stop_client(client.id)
  end
  M.wait('the server has ended', function()
    -- A client may stay in the list for a moment after its server has exited.
    return #M.exits == before + running and vim.tbl_isempty(clients())
  end)
  for index = before + 1, #M.exits do
    M.equal(M.exits[index], { 0, 0 }, 'exit code and signal of the server')
  end
  vim.cmd('silent! %bwipeout!')
end

-- Sends a request; returns the answer or an error.
function M.try(method, params)
  params = params or {}
  params.textDocument = params.textDocument or { uri = M.uri }
  local client, answer = M.client(), nil
  local function answered(problem, result)
    answer = { result = result, problem = problem }
  end
  if is_new then
    client:request(method, params, answered, M.buffer)
  else
    client.request(method, params, answered, M.buffer)
  end
  M.wait(method .. ' is answered', function()
    return answer
  end)
  return answer.result, answer.problem
end

function M.ask(method, params)
  local result, problem = M.try(method, params)
  assert(not problem, vim.inspect(problem))
  return result
end

-- Lets all servers of the buffer answer what was asked before, and Neovim do what it has scheduled.
function M.settle()
  for _, client in pairs(clients()) do
    local answered
    local params = { textDocument = { uri = M.uri } }
    local function answer()
      vim.schedule(function()
        answered = true
      end)
    end
    if is_new then
      client:request('textDocument/documentSymbol', params, answer, M.buffer)
    else
      client.request('textDocument/documentSymbol', params, answer, M.buffer)
    end
    M.wait(client.name .. ' has settled', function()
      return answered
    end)
  end
end

-- The length of a text in the negotiated encoding.
local function units(text)
  if M.client().offset_encoding == 'utf-8' then
    return #text
  end
  local count = 0
  for index = 1, #text do
    local byte = text:byte(index)
    if byte < 0x80 or byte >= 0xC0 then
      count = count + (byte >= 0xF0 and 2 or 1)
    end
  end
  return count
end

function M.lines()
  return vim.api.nvim_buf_get_lines(M.buffer, 0, -1, false)
end

-- The position `bytes` after the start of `words`, which occur once in the buffer or for the `nth` time.
function M.at(words, bytes, nth)
  local left = nth or 1
  for number, line in ipairs(M.lines()) do
    local start = line:find(words, 1, true)
    if start then
      left = left - 1
      if left == 0 then
        return { line = number - 1, character = units(line:sub(1, start - 1 + (bytes or 0))) }
      end
    end
  end
  error('`' .. words .. '` is not in the buffer', 2)
end

function M.range(words, bytes, length, nth)
  return { start = M.at(words, bytes, nth), ['end'] = M.at(words, bytes + length, nth) }
end

-- Sends a request about a position.
function M.ask_at(method, words, bytes, more)
  return M.ask(method, vim.tbl_extend('force', { position = M.at(words, bytes) }, more or {}))
end

local function byte_of(line, wanted)
  for bytes = 0, #line do
    local next_byte = line:byte(bytes + 1)
    local is_start = not next_byte or next_byte < 0x80 or next_byte >= 0xC0
    if is_start and units(line:sub(1, bytes)) == wanted then
      return bytes
    end
  end
  error(('column %d is within a character of\n%s'):format(wanted, line))
end

-- The words in a range within one line.
function M.words(range)
  M.equal(range.start.line, range['end'].line, 'a range of one line')
  local line = M.lines()[range.start.line + 1]
  return line:sub(byte_of(line, range.start.character) + 1, byte_of(line, range['end'].character))
end

-- The tokens as `word kind`, in order.
function M.tokens(answer)
  local legend = M.client().server_capabilities.semanticTokensProvider.legend
  local out, line, column = {}, 0, 0
  local data = answer.data
  M.equal(#data % 5, 0, 'numbers of tokens')
  for index = 1, #data, 5 do
    column = data[index] == 0 and column + data[index + 1] or data[index + 1]
    line = line + data[index]
    local range = {
      start = { line = line, character = column },
      ['end'] = { line = line, character = column + data[index + 2] },
    }
    local defines = data[index + 4] == 1 and '!' or ''
    table.insert(out, M.words(range) .. ' ' .. legend.tokenTypes[data[index + 3] + 1] .. defines)
  end
  return out
end

-- The diagnostics that Neovim shows, except for a code that does not matter here.
function M.shown(without)
  local found = vim.tbl_filter(function(diagnostic)
    return diagnostic.code ~= without
  end, vim.diagnostic.get(M.buffer))
  table.sort(found, function(a, b)
    return a.lnum < b.lnum or (a.lnum == b.lnum and a.col < b.col)
  end)
  return found
end

function M.codes()
  return vim.tbl_map(function(diagnostic)
    return diagnostic.code
  end, M.shown())
end

-- Waits for exactly these codes, in the order of the text.
function M.wait_for_codes(expected)
  local ok = vim.wait(M.patience, function()
    return vim.deep_equal(M.codes(), expected)
  end, 10)
  if not ok then
    M.equal(M.codes(), expected, 'diagnostics shown')
  end
end

-- Types keys, like a user.
function M.type(keys)
  vim.api.nvim_feedkeys(vim.api.nvim_replace_termcodes(keys, true, false, true), 'xt', false)
end

-- Moves the cursor to `bytes` after the start of `words`.
function M.go(words, bytes)
  for number, line in ipairs(M.lines()) do
    local start = line:find(words, 1, true)
    if start then
      vim.api.nvim_win_set_cursor(0, { number, start - 1 + (bytes or 0) })
      return
    end
  end
  error('`' .. words .. '` is not in the buffer', 2)
end

function M.apply(edit)
  vim.lsp.util.apply_workspace_edit(edit, M.client().offset_encoding)
end

function M.text()
  return table.concat(M.lines(), '\n') .. '\n'
end

return M
