-- Requests about a drawing that does not change.

local h = require('harness')
local arm = 'Rarm@Ubody$Shape roundv -90 90'
local fault = h.with(h.example('human.svg'), 'Larm@Ubody', 'Rarm@Ubodi')

local function words_of(places, key)
  return vim.tbl_map(function(place)
    return h.words(place[key or 'range'])
  end, places)
end

local function labels(items)
  return vim.tbl_map(function(item)
    return item.label
  end, items)
end

-- The text before the line break of the first line where a range starts.
local function line_at(range)
  return vim.trim(h.lines()[range.start.line + 1])
end

local function complete(words, bytes)
  local answer = h.ask_at('textDocument/completion', words, bytes)
  return answer.items or answer
end

local function tree(symbols)
  local out = {}
  for _, symbol in ipairs(symbols) do
    table.insert(out, symbol.children and { symbol.name, tree(symbol.children) } or { symbol.name })
  end
  return out
end

return {
  {
    'the agreed encoding is the one that was asked for',
    function()
      h.open(h.example('human.svg'))
      local expected = h.wanted_encoding
      if expected == 'default' then
        expected = vim.fn.has('nvim-0.11') == 1 and 'utf-8' or 'utf-16'
      end
      h.equal(h.client().offset_encoding, expected, 'encoding of the client')
      h.equal(h.client().server_capabilities.positionEncoding, expected, 'encoding of the server')
    end,
  },
  {
    'diagnostics have text, code, place and related places',
    function()
      h.open(fault)
      h.wait_for_codes({ 'H402', 'H402', 'E203', 'E204' })
      local found = h.shown('H402')
      local twice, unknown = found[1], found[2]
      h.equal(twice.message, 'two parts are named `Rarm`: the second one\nrename one of them')
      h.equal({ twice.lnum, twice.col, twice.end_lnum, twice.end_col }, { 176, 19, 176, 23 }, 'place of E203')
      h.equal({ twice.severity, twice.source }, { vim.diagnostic.severity.ERROR, 'okoshi' })
      local related = twice.user_data.lsp.relatedInformation
      h.equal(#related, 1, 'related places')
      h.equal(related[1].message, 'the first one')
      h.equal(related[1].location, { uri = h.uri, range = h.range(arm, 0, 4) })
      h.holds(unknown.message, 'there is no part named `Ubodi`: did you mean `Ubody`?')
      h.equal({ unknown.lnum, unknown.col, unknown.end_col }, { 176, 24, 29 }, 'place of E204')
      h.equal(h.shown('E203')[1].severity, vim.diagnostic.severity.HINT)
    end,
  },
  {
    'diagnostics that are fetched are those that are sent',
    function()
      h.open(fault)
      h.wait_for_codes({ 'H402', 'H402', 'E203', 'E204' })
      local report = h.ask('textDocument/diagnostic')
      h.equal(report.kind, 'full')
      h.equal(vim.tbl_map(function(item)
        return item.code
      end, report.items), { 'H402', 'H402', 'E203', 'E204' })
      h.equal(h.words(report.items[4].range), 'Ubodi')
      local again = h.ask('textDocument/diagnostic', { previousResultId = report.resultId })
      h.equal(again, { kind = 'unchanged', resultId = report.resultId })
    end,
  },
  {
    'a client that can fetch diagnostics sees each of them once',
    needs = 'nvim-0.11',
    function()
      h.open(fault)
      -- A second server for the same buffer, which gets all capabilities of this Neovim.
      local config = h.client().config
      vim.lsp.start({ name = 'second', cmd = config.cmd, on_exit = config.on_exit })
      local function codes()
        local found = {}
        for name, space in pairs(vim.api.nvim_get_namespaces()) do
          if name:find('second', 1, true) then
            vim.list_extend(found, vim.diagnostic.get(h.buffer, { namespace = space }))
          end
        end
        return vim.tbl_map(function(diagnostic)
          return diagnostic.code
        end, found)
      end
      for _, case in ipairs({
        { '', { 'H402', 'H402', 'E203', 'E204' } },
        { 'ry', { 'H402', 'H402', 'E203' } },
      }) do
        h.go('Rarm@Ubodi', 9)
        h.type(case[1])
        -- The other server may answer later.
        h.wait('both servers have told the faults', function()
          return vim.deep_equal(codes(), case[2]) and #vim.diagnostic.get(h.buffer) == 2 * #case[2]
        end)
        -- Late answers must not be added.
        h.settle()
        h.equal(codes(), case[2])
        h.equal(#vim.diagnostic.get(h.buffer), 2 * #case[2], 'diagnostics of both servers')
      end
    end,
  },
  {
    'hover on a string, a keyword, a kind, a number and a tag',
    function()
      h.open(h.example('human.svg'))
      for _, case in ipairs({
        { 0, 'Rarm', '**Rarm**\n\nRoot › Ubody › **Rarm**' },
        { 0, 'Rarm', '- Shape `roundv -90 90`, from its own string' },
        { 6, 'Ubody', 'Attached parts: `Rarm`, `Larm`, `Head`.' },
        { 12, 'Shape', '**Shape**\n\nHow the flat outline becomes a solid.' },
        { 18, 'roundv', '**Shape roundv**' },
        { 25, '-90', '`a0` of `roundv`: where the rounding begins' },
      }) do
        local hover = h.ask_at('textDocument/hover', arm, case[1])
        h.equal(hover.contents.kind, 'markdown')
        h.equal(h.words(hover.range), case[2])
        h.holds(hover.contents.value, case[3])
      end
      local line = h.at('id="path116"').line - 2
      local hover = h.ask('textDocument/hover', { position = { line = line, character = 6 } })
      h.equal(h.words(hover.range), '<path')
      h.holds(hover.contents.value, '**Larm**\n\nRoot › Ubody › **Larm**')
      h.equal(h.ask_at('textDocument/hover', 'viewBox', 2), nil, 'hover outside of strings')
    end,
  },
  {
    'completion behind @, $ and Shape, and what is told of a proposal',
    function()
      h.open(h.example('human.svg'))
      h.equal(labels(complete(arm, 5)), { 'Lbody', 'Larm', 'Ubody', 'Head', 'U-1', 'U-2' })
      local keywords = complete(arm, 11)
      h.equal(vim.list_slice(labels(keywords), 1, 4), { 'Color', 'Offset', 'Stack', 'Origin' })
      local kinds = complete(arm, 17)
      h.equal(vim.list_slice(labels(kinds), 1, 6), { '-s', '-c', '-d', 'default', 'roundv', 'roundh' })
      h.equal(kinds[5].detail, 'rounded about the part\'s axis: an arm, a leg, a trunk')
      local resolved = h.ask('completionItem/resolve', kinds[5])
      h.holds(resolved.documentation.value, '**Shape roundv**')
      h.equal(h.ask_at('textDocument/completion', 'viewBox', 2), nil, 'completion outside of strings')
    end,
  },
  {
    'signature help follows the parameters',
    function()
      h.open(h.example('human.svg'))
      for _, case in ipairs({ { 24, 0 }, { 28, 1 } }) do
        local help = h.ask_at('textDocument/signatureHelp', arm, case[1])
        h.equal({ help.activeSignature, help.activeParameter }, { 0, case[2] })
        h.equal(help.signatures[1].label, 'Shape roundv [a0 a1]')
        h.equal(labels(help.signatures[1].parameters), { 'a0', 'a1' })
      end
    end,
  },
  {
    'definition: of a parent, of a string, of an attribute of a legend',
    function()
      h.open(h.example('human.svg'))
      local function target(words, bytes)
        local found = h.ask_at('textDocument/definition', words, bytes)
        h.equal(#found, 1, 'definitions')
        h.equal(found[1].targetUri or found[1].uri, h.uri)
        return found[1].targetSelectionRange or found[1].range
      end
      h.equal(target(arm, 6), h.range('>Ubody<', 1, 5))
      h.equal(target(arm, 1).start.line, h.at('id="path114"').line - 2, 'line of the shape that a string is bound to')
      -- With its key, through `tagfunc`.
      h.go(arm, 6)
      h.type('<C-]>')
      h.equal({ vim.fn.line('.'), vim.fn.col('.') }, { 137, 20 }, 'where the cursor is after CTRL-]')
    end,
  },
  {
    'references and highlights of a part',
    function()
      h.open(h.example('human.svg'))
      local all = h.ask_at('textDocument/references', arm, 6, { context = { includeDeclaration = true } })
      h.equal(words_of(all), { 'Ubody', 'Ubody', 'Ubody', 'Ubody' })
      h.equal(all[1].range, h.range('>Ubody<', 1, 5))
      local uses = h.ask_at('textDocument/references', arm, 6, { context = { includeDeclaration = false } })
      h.equal(vim.tbl_map(line_at, { uses[1].range, uses[2].range, uses[3].range }), {
        'y="62.0">Head@Ubody</tspan></text>',
        'y="176.0">' .. arm .. '</tspan></text>',
        'y="176.0">Larm@Ubody$Shape roundv -90 90</tspan></text>',
      })
      local marks = h.ask_at('textDocument/documentHighlight', arm, 6)
      h.equal(vim.tbl_map(function(mark)
        return mark.kind
      end, marks), { 3, 2, 2, 2 })
      h.equal(marks[3].range, h.range(arm, 5, 5))
    end,
  },
  {
    'symbols are the hierarchy',
    function()
      h.open(h.example('human.svg'))
      local symbols = h.ask('textDocument/documentSymbol')
      h.equal(tree(symbols), {
        { 'Ubody', { { 'Head' }, { 'Rarm' }, { 'Larm' } } },
        { 'Lbody', { { 'U-1' }, { 'U-2' } } },
      })
      h.equal(symbols[1].detail, 'default -20 20')
      h.equal(h.words(symbols[1].children[2].selectionRange), 'Rarm')
    end,
  },
  {
    'symbols of the folder: of drawings that are not open, too',
    function()
      h.open(h.example('human.svg'))
      h.write(h.folder .. '/lady.svg', h.example('lady.svg'))
      local found = h.ask('workspace/symbol', { query = 'rfarm' })
      local names = vim.tbl_map(function(symbol)
        return { symbol.name, symbol.containerName, vim.fn.fnamemodify(symbol.location.uri, ':t') }
      end, found)
      h.equal(names, {
        { 'RForearm', 'RArm', 'lady.svg' },
      })
    end,
  },
  {
    'folding and selection ranges',
    function()
      h.open(h.example('human.svg'))
      local folds = h.ask('textDocument/foldingRange')
      h.equal(#folds, 12, 'folds')
      h.equal({ folds[6].startLine, folds[6].endLine }, { h.at('id="text154"').line - 5, h.at(arm).line })
      local nested = h.ask('textDocument/selectionRange', { positions = { h.at(arm, 25) } })[1]
      local inner = {}
      while nested.parent do
        table.insert(inner, h.words(nested.range))
        nested = nested.parent
      end
      h.equal(inner, { '-90', 'Shape roundv -90 90', arm })
      h.holds(line_at(nested.range), '<text')
    end,
  },
  {
    'semantic tokens of the whole and of a range',
    function()
      h.open(h.example('human.svg'))
      local of_arm = {
        'Rarm class!', '@ operator', 'Ubody class', '$ operator', 'Shape keyword', 'roundv enumMember', '-90 number', '90 number',
      }
      local all = h.tokens(h.ask('textDocument/semanticTokens/full'))
      h.equal(#all, 68, 'tokens')
      h.equal(vim.list_slice(all, 1, 3), { '# operator', 'Human Character comment', '% operator' })
      h.equal(vim.list_slice(all, 19, 26), of_arm)
      local part = h.ask('textDocument/semanticTokens/range', { range = h.range(arm, 0, #arm) })
      h.equal(h.tokens(part), of_arm)
    end,
  },
  {
    'semantic tokens of full-width strings',
    function()
      h.open(h.example('robot-ja.svg'))
      local all = h.tokens(h.ask('textDocument/semanticTokens/full'))
      h.equal(vim.list_slice(all, 1, 9), {
        '頭 class!', '＠ operator', '胴 class', '角 class!', '＠ operator', '頭 class', '＄ operator', 'Ｓｈａｐｅ keyword',
        'ｒｏｕｎｄｖ enumMember',
      })
      h.equal(h.ask_at('textDocument/hover', '角＠頭', 6).range, h.range('角＠頭', 6, 3))
    end,
  },
  {
    'inlay hints: names that were given, and what is inherited',
    function()
      h.open(h.example('human.svg'))
      local whole = { start = { line = 0, character = 0 }, ['end'] = { line = #h.lines(), character = 0 } }
      local hints = vim.tbl_map(function(hint)
        local label = table.concat(vim.tbl_map(function(piece)
          return piece.value
        end, hint.label))
        return { hint.position.line + 1, label }
      end, h.ask('textDocument/inlayHint', { range = whole }))
      h.equal(hints, {
        { 38, 'U-1@Lbody' },
        { 42, 'U-2@Lbody' },
        { 137, 'Color 0.85 0.3 0.25 Shape default -20 20' },
        { 147, 'Color 1 1 0 Shape default -20 20' },
        { 157, 'Color 1 0.8 0.6 Shape default -15 15' },
        { 167, 'Color 1 0.8 0.6' },
        { 177, 'Color 1 0.8 0.6' },
      })
    end,
  },
  {
    'colours, and how else they can be written',
    function()
      h.open(h.example('human.svg'))
      local colours = h.ask('textDocument/documentColor')
      h.equal(words_of(colours), { '1.0 1.0 0.0', '1.0 0.8 0.6', '0.0 0.0 1.0', '0.85 0.3 0.25', '0.2 0.3 0.7' })
      h.equal(colours[1].color, { red = 1, green = 1, blue = 0, alpha = 1 })
      local forms = h.ask('textDocument/colorPresentation', {
        color = { red = 1, green = 0.5, blue = 0, alpha = 1 },
        range = colours[4].range,
      })
      h.equal(labels(forms), { '1 0.5 0', '#ff8000' })
      h.equal(forms[2].textEdit, { newText = '#ff8000', range = colours[4].range })
    end,
  },
  {
    'drawings without strings and other XML are left alone',
    function()
      h.open('<svg xmlns="http://www.w3.org/2000/svg"><path d="M 0,0 H 9 V 9 z"/></svg>\n')
      h.equal(h.ask('textDocument/documentSymbol'), nil)
      h.equal(h.ask('textDocument/codeLens'), nil)
      h.equal(h.ask('textDocument/semanticTokens/full'), nil)
      h.equal(h.shown(), {})
      local path = h.folder .. '/notes.xml'
      h.write(path, '<notes>Rarm@Ubody$Shape roundv</notes>\n')
      vim.cmd('edit ' .. path)
      h.equal(vim.bo.filetype, 'xml')
      h.settle()
      h.equal(vim.lsp.buf_is_attached(0, h.client().id), false, 'a server for other XML')
    end,
  },
}
