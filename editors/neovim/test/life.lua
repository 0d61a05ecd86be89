-- Everything outside of the text: linked files, commands, keys, and how a server exits.

local h = require('harness')
local arm = 'Rarm@Ubody$Shape roundv -90 90'
local textured = h.with(h.example('human.svg'), '$Color 0.85 0.3 0.25', '$Texture "canvas.png"')

local function lives(pid)
  return vim.loop.kill(pid, 0) == 0
end

-- A second Neovim, controlled like by a user interface, with the plugin and an open drawing.
local function other()
  local job = vim.fn.jobstart({ vim.v.progpath, '--headless', '--embed', '-u', 'NONE', '-i', 'NONE', '-n' }, { rpc = true })
  assert(job > 0, 'Neovim cannot be started')
  local function lua(code, ...)
    return vim.rpcrequest(job, 'nvim_exec_lua', code, { ... })
  end
  local harness = debug.getinfo(1, 'S').source:sub(2)
  lua([[
    package.path = ... .. '/?.lua;' .. package.path
    _G.h = require('harness')
    h.install()
    vim.o.completeopt = 'menuone,noselect'
  ]], vim.fn.fnamemodify(harness, ':p:h'))
  return job, lua
end

local function close(job)
  vim.fn.jobstop(job)
  h.equal(vim.fn.jobwait({ job }, h.patience)[1] ~= -1, true, 'the other Neovim has ended')
end

return {
  {
    'a linked file that appears takes its fault away, without an edit',
    function()
      h.open(textured)
      h.wait_for_codes({ 'H402', 'H402', 'E006' })
      local fault = h.shown('H402')[1]
      h.equal({ fault.lnum, fault.col, fault.end_col }, { 237, 20, 40 }, 'place of E006')
      local version = vim.lsp.util.buf_versions[h.buffer]
      h.write(h.folder .. '/canvas.png', h.example('canvas.png'))
      h.wait_for_codes({ 'H402', 'H402' })
      h.equal(vim.lsp.util.buf_versions[h.buffer], version, 'version of the text')
      os.remove(h.folder .. '/canvas.png')
      h.wait_for_codes({ 'H402', 'H402', 'E006' })
    end,
  },
  {
    'the files of the folder are proposed, and a link leads to its file',
    function()
      h.open(textured)
      h.write(h.folder .. '/canvas.png', h.example('canvas.png'))
      local proposals = h.ask_at('textDocument/completion', 'canvas.png', 0)
      h.equal(vim.tbl_map(function(item)
        return item.label
      end, proposals.items or proposals), { 'canvas.png' })
      local target = h.ask_at('textDocument/definition', 'canvas.png', 2)[1]
      h.equal(target.targetUri or target.uri, vim.uri_from_fname(h.folder .. '/canvas.png'))
    end,
  },
  {
    'the line above the drawing, followed, leads to a page with the model',
    function()
      h.open(h.example('human.svg'), 'seen.svg')
      local lenses
      h.wait('the line is there', function()
        lenses = vim.lsp.codelens.get(h.buffer)
        return #lenses == 1
      end)
      h.equal(lenses[1].command.title, 'Preview in 3D')
      h.equal({ lenses[1].command.command, lenses[1].command.arguments }, { 'okoshi.preview', { h.uri } })
      h.equal(lenses[1].range.start, { line = 1, character = 0 })

      -- The message to the user, or the page if a browser can be started.
      local told = {}
      local notify, message = vim.notify, vim.lsp.handlers['window/showMessage']
      vim.notify = function(words)
        table.insert(told, words)
      end
      vim.lsp.handlers['window/showMessage'] = function(_, params)
        table.insert(told, params.message)
      end
      local open = vim.ui.open
      if open then
        vim.ui.open = function(address)
          table.insert(told, 'the preview is at ' .. address)
          return {
            is_closing = function()
              return false
            end,
          }
        end
      end
      for _, follow in ipairs({ vim.lsp.codelens.run, function() vim.cmd('OkoshiPreview') end }) do
        told = {}
        vim.api.nvim_win_set_cursor(0, { 2, 0 })
        follow()
        h.wait('the page is there', function()
          return #told > 0
        end)
        h.equal(#told, 1, 'times that the person is told')
        local address = told[1]:match('^the preview is at (http://127%.0%.0%.1:%d+/)#.*seen%.svg$')
        assert(address, told[1])
        local get = 'import sys, urllib.request; print(urllib.request.urlopen(sys.argv[1]).read().decode())'
        h.holds(vim.fn.system({ 'python3', '-c', get, address }), '<title>okoshi preview</title>')
      end
      vim.notify, vim.lsp.handlers['window/showMessage'] = notify, message
      vim.ui.open = open
    end,
  },
  {
    'where no browser opens, the address of the page is told',
    function()
      h.open(h.example('human.svg'))
      local told, address = {}, nil
      local notify, path = vim.notify, vim.env.PATH
      vim.notify = function(words)
        table.insert(told, words)
      end
      local folder = vim.fn.tempname()
      vim.fn.mkdir(folder, 'p')
      vim.env.PATH = folder .. ':' .. path
      for _, status in ipairs({ 0, 3 }) do
        local opener, opened = folder .. '/xdg-open', folder .. '/opened-' .. status
        vim.fn.writefile({ '#!/bin/sh', 'sleep 0.2', 'echo "$1" > ' .. opened, 'exit ' .. status }, opener)
        vim.fn.setfperm(opener, 'rwxr-xr-x')
        vim.cmd('OkoshiPreview')
        h.wait('the opener was called', function()
          return vim.fn.filereadable(opened) == 1 and #vim.fn.readfile(opened) == 1
        end)
        address = vim.fn.readfile(opened)[1]
      end
      -- Once, after the second opener failed: nothing was told when the first one had opened a browser.
      h.wait('the address is told', function()
        return #told > 0
      end)
      h.equal(told, { 'the preview is at ' .. address })
      vim.notify, vim.env.PATH = notify, path
    end,
    needs = 'nvim-0.10',
  },
  {
    'a command that there is not is refused',
    function()
      h.open(h.example('human.svg'))
      local _, problem = h.try('workspace/executeCommand', { command = 'okoshi.print', arguments = { h.uri } })
      h.holds(problem.message, 'okoshi.print')
    end,
  },
  {
    'completion by keys',
    function()
      local job, lua = other()
      lua([[h.open(h.with(h.example('human.svg'), ..., 'Rarm@Ub$Shape roundv')) h.go('Rarm@Ub$', 6)]], arm)
      vim.rpcrequest(job, 'nvim_input', 'a<C-x><C-o>')
      h.wait('the menu is open', function()
        return lua('return vim.fn.pumvisible()') == 1
      end)
      local words = vim.tbl_map(function(item)
        return item.word
      end, lua('return vim.fn.complete_info({ "items" }).items'))
      h.equal(vim.tbl_contains(words, 'Ubody'), true, 'Ubody is in the menu')
      -- After one more letter only one completion is left.
      vim.rpcrequest(job, 'nvim_input', 'o<C-n><C-y><Esc>')
      h.wait('the word is written', function()
        return lua('return h.text()'):find('>Rarm@Ubody$Shape roundv<', 1, true) ~= nil
      end)
      close(job)
    end,
  },
  {
    'a server serves all drawings of a folder, and each folder has its own',
    function()
      h.open(h.example('human.svg'))
      local first = h.client().id
      h.write(h.folder .. '/second.svg', h.example('lady.svg'))
      vim.cmd('edit ' .. h.folder .. '/second.svg')
      h.wait('the second drawing is attached', function()
        return vim.lsp.buf_is_attached(0, first)
      end)
      h.open(h.example('car.svg'))
      h.equal(h.client().id ~= first, true, 'another folder has another server')
    end,
  },
  {
    'a drawing that is closed has no diagnostics left',
    function()
      local told = {}
      local publish = vim.lsp.handlers['textDocument/publishDiagnostics']
      vim.lsp.handlers['textDocument/publishDiagnostics'] = function(problem, params, ...)
        told[params.uri] = #params.diagnostics
        return publish(problem, params, ...)
      end
      h.open(h.example('human.svg'))
      h.wait_for_codes({ 'H402', 'H402' })
      h.equal(told[h.uri], 2, 'diagnostics sent')
      vim.cmd('silent bdelete')
      h.wait('they are taken back', function()
        return told[h.uri] == 0
      end)
      vim.lsp.handlers['textDocument/publishDiagnostics'] = publish
    end,
  },
  {
    'a server ends when its client is killed',
    function()
      local job, lua = other()
      lua([[h.open(h.example('human.svg')) h.wait_for_codes({ 'H402', 'H402' })]])
      local pid = lua('return vim.fn.getpid()')
      local children = vim.api.nvim_get_proc_children(pid)
      h.equal(#children, 1, 'processes of the other Neovim')
      h.equal(lives(children[1]), true, 'the server lives')
      vim.loop.kill(pid, 'sigkill')
      h.wait('the server has gone', function()
        return not lives(children[1])
      end)
      vim.fn.jobwait({ job }, h.patience)
    end,
  },
}
