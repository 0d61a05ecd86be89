-- Typing: Neovim sends each change, and the server must end with the text in the buffer.

local h = require('harness')
local arm = 'Rarm@Ubody$Shape roundv -90 90'

-- The server's answers about the buffer.
local function idea()
  local report = h.ask('textDocument/diagnostic')
  return {
    diagnostics = vim.tbl_map(function(item)
      return { item.code, item.range, item.message }
    end, report.items),
    tokens = h.ask('textDocument/semanticTokens/full'),
    symbols = h.ask('textDocument/documentSymbol'),
  }
end

-- The same for a buffer that was never typed in.
local function fresh_idea()
  local text, format = h.text(), vim.bo.fileformat
  if format == 'dos' then
    text = text:gsub('\n', '\r\n')
  end
  h.open(text, 'fresh.svg')
  h.equal(vim.bo.fileformat, format)
  return idea()
end

local function same_as_fresh()
  local typed = idea()
  assert(#typed.tokens.data > 0, 'there are no tokens')
  h.equal(typed, fresh_idea(), 'what the server thinks of a text that was typed')
end

return {
  {
    'Japanese and emoji, before and inside a string',
    function()
      h.open(h.example('human.svg'))
      h.go('#Human Character')
      h.type('a日本語😀👩‍👩‍👧 <Esc>')
      h.go(arm)
      h.type('i😀右<Esc>')
      h.holds(h.text(), '>😀右' .. arm .. '<')
      h.equal(h.words(h.ask_at('textDocument/hover', '😀右Rarm', 1).range), '😀右Rarm')
      h.go('@Ubody$Shape roundv -90 90</', 6)
      h.type('i😀<Esc>')
      h.wait_for_codes({ 'H402', 'H402', 'E204' })
      h.equal(h.words(h.ask('textDocument/diagnostic').items[3].range), 'Ubody😀')
      h.type('x')
      h.wait('the fault is gone', function()
        return #h.ask('textDocument/diagnostic').items == 2
      end)
      same_as_fresh()
    end,
  },
  {
    'a string is typed letter by letter, with questions between them',
    function()
      h.open(h.with(h.example('human.svg'), arm, ''))
      h.go('y="176.0"></tspan>', 9)
      for _, key in ipairs({ 'R', 'a', 'r', 'm', '@', 'U', 'b', 'o', 'd', 'y', '$', 'S', 'h', 'a', 'p', 'e', ' ', 'r', 'o' }) do
        h.type('a' .. key .. '<Esc>')
        if key == '@' then
          local names = vim.tbl_map(function(item)
            return item.label
          end, h.ask_at('textDocument/completion', 'Rarm@', 5))
          h.equal(vim.tbl_contains(names, 'Ubody'), true, 'Ubody is proposed behind @')
        end
      end
      h.holds(h.text(), '>Rarm@Ubody$Shape ro<')
      local proposals = h.ask_at('textDocument/completion', '$Shape ro<', 9)
      local kind = vim.tbl_filter(function(item)
        return item.label == 'roundv'
      end, proposals)[1]
      -- Neovim supports snippets since 0.10.
      local written = vim.fn.has('nvim-0.10') == 1 and 'roundv ${1:-90} ${2:90}' or 'roundv'
      h.equal({ kind.textEdit.newText, h.words(kind.textEdit.range) }, { written, 'ro' })
      same_as_fresh()
    end,
  },
  {
    'two hundred changes of all sorts',
    function()
      h.open(h.example('robot-ja.svg'))
      -- The same on every machine: a Lehmer generator with the modulus 2^31 - 1.
      local state = 42
      local function random(most)
        state = (state * 48271) % 2147483647
        return state % most + 1
      end
      local scraps = { '頭＠胴', '😀', 'Ａ', 'x', '$Shape cone 1 2', '𠮷野家', '&amp;', ' ', 'e\204\129', '＄Ｃｏｌｏｒ　ｒｅｄ' }
      for step = 1, 200 do
        local line = random(vim.fn.line('$') - 2) + 1
        vim.api.nvim_win_set_cursor(0, { line, 0 })
        vim.cmd('normal! $')
        for _ = 1, random(20) do
          vim.cmd('normal! h')
        end
        local sort = random(8)
        if sort <= 3 then
          h.type('i' .. scraps[random(#scraps)] .. '<Esc>')
        elseif sort == 4 then
          h.type('x')
        elseif sort == 5 then
          h.type('o<!-- ' .. scraps[random(#scraps)]:gsub('&amp;', '') .. ' --><Esc>')
        elseif sort == 6 then
          h.type('yyp')
        elseif sort == 7 then
          h.type('J')
        else
          vim.cmd('silent undo')
        end
        if step % 50 == 0 then
          h.settle()
        end
      end
      -- Wherever it ended, the XML errors are gone after undoing everything, except for one string.
      vim.cmd('silent undo 0')
      h.equal(h.text(), h.example('robot-ja.svg'))
      h.go('頭＠胴')
      h.type('i😀<Esc>')
      local all = h.tokens(h.ask('textDocument/semanticTokens/full'))
      h.equal(all[1], '😀頭 class!')
      same_as_fresh()
    end,
  },
  {
    'changes that leave the text half-done are seen alike',
    function()
      h.open(h.example('human.svg'))
      for _, change in ipairs({
        { 'id="path104"', 'dd' },
        { arm, 'yypyyp' },
        { 'Head@Ubody', 'J' },
        { '>Lbody<', 'x' },
        { 'Scale 0.5', 'rＳ' },
        { '*Unuse', 'i😀<Esc>' },
      }) do
        h.go(change[1])
        h.type(change[2])
        local report = h.ask('textDocument/diagnostic')
        local buffer, path, uri = h.buffer, h.path, h.uri
        h.open(h.text(), 'fresh.svg')
        local fresh = h.ask('textDocument/diagnostic')
        h.equal(vim.tbl_map(function(item)
          return { item.code, item.range, item.message }
        end, report.items), vim.tbl_map(function(item)
          return { item.code, item.range, item.message }
        end, fresh.items), 'after ' .. change[2] .. ' at ' .. change[1])
        vim.cmd('buffer ' .. buffer)
        h.buffer, h.path, h.uri = buffer, path, uri
      end
    end,
  },
  {
    'files with CRLF',
    function()
      h.open((h.example('human.svg'):gsub('\n', '\r\n')))
      h.equal(vim.bo.fileformat, 'dos')
      h.wait_for_codes({ 'H402', 'H402' })
      h.equal(h.words(h.ask_at('textDocument/hover', arm, 18).range), 'roundv')
      h.go(arm, 9)
      h.type('ii😀<Esc>')
      h.wait_for_codes({ 'H402', 'H402', 'E204' })
      vim.cmd('silent undo')
      h.wait_for_codes({ 'H402', 'H402' })
      h.apply(h.ask_at('textDocument/rename', arm, 6, { newName = '胴' }))
      vim.cmd('silent write')
      local written = h.read(h.path)
      h.holds(written, '>Rarm@胴$Shape roundv -90 90</tspan></text>\r\n')
      h.equal(select(2, written:gsub('\n', '')), select(2, written:gsub('\r\n', '')), 'line ends')
      same_as_fresh()
    end,
  },
  {
    'a text that is not well-formed for a moment is still answered',
    function()
      h.open(h.example('human.svg'))
      h.wait_for_codes({ 'H402', 'H402' })
      h.go('id="path102"')
      h.type('O<g <Esc>')
      h.wait('the fault of the XML is told', function()
        return #h.codes() == 1 and h.codes()[1]:sub(1, 1) == 'E'
      end)
      local hover = h.ask_at('textDocument/hover', arm, 6)
      h.equal(h.words(hover.range), 'Ubody')
      h.holds(hover.contents.value, '**Ubody**')
      h.equal(#h.ask('textDocument/documentSymbol'), 2, 'symbols')
      h.equal(#h.tokens(h.ask('textDocument/semanticTokens/full')), 68, 'tokens')
      h.type('dd')
      h.wait_for_codes({ 'H402', 'H402' })
    end,
  },
}
