-- Requests that change a drawing, checked by the buffer's text afterwards.

local h = require('harness')
local arm = 'Rarm@Ubody$Shape roundv -90 90'

local function actions_at(words, bytes)
  local place = h.at(words, bytes)
  return h.ask('textDocument/codeAction', {
    range = { start = place, ['end'] = place },
    context = { diagnostics = {} },
  }) or {}
end

local function titles(actions)
  return vim.tbl_map(function(action)
    return action.title
  end, actions)
end

local function count(text, piece)
  return select(2, text:gsub(vim.pesc(piece), ''))
end

return {
  {
    'a part is renamed in all strings, and back again to the same bytes',
    function()
      h.open(h.example('human.svg'))
      local before = h.text()
      local prepared = h.ask_at('textDocument/prepareRename', arm, 6)
      h.equal({ prepared.placeholder, h.words(prepared.range) }, { 'Ubody', 'Ubody' })
      h.apply(h.ask_at('textDocument/rename', arm, 6, { newName = '上半身' }))
      local after = h.text()
      h.equal({ count(after, 'Ubody'), count(after, '上半身') }, { 0, 4 })
      h.holds(after, '>Rarm@上半身$Shape roundv -90 90<')
      h.wait_for_codes({ 'H402', 'H402' })
      h.apply(h.ask_at('textDocument/rename', '上半身', 0, { newName = 'Ubody' }))
      h.equal(h.text(), before)
    end,
  },
  {
    'a name with signs is quoted and escaped',
    function()
      h.open(h.example('human.svg'))
      h.apply(h.ask_at('textDocument/rename', arm, 6, { newName = 'a<b & c' }))
      h.holds(h.text(), '>Rarm@"a&lt;b &amp; c"$Shape roundv -90 90<')
      h.wait_for_codes({ 'H402', 'H402' })
    end,
  },
  {
    'renaming is refused where there is no name, and where the name is taken',
    function()
      h.open(h.example('human.svg'))
      h.equal(h.ask_at('textDocument/prepareRename', arm, 18), nil)
      local _, problem = h.try('textDocument/rename', { position = h.at(arm, 6), newName = 'Head' })
      h.equal(problem.code, -32803)
      h.holds(problem.message, 'Head')
    end,
  },
  {
    'a fix that is applied takes its diagnostic away',
    function()
      h.open(h.with(h.example('human.svg'), arm, 'Rarm@Ubodi$Shape roundv -90 90'))
      h.wait_for_codes({ 'H402', 'H402', 'E204' })
      local fixes = actions_at('Ubodi', 2)
      h.equal(titles(fixes)[1], 'Write `Ubody`')
      h.equal({ fixes[1].kind, fixes[1].isPreferred, fixes[1].diagnostics[1].code }, { 'quickfix', true, 'E204' })
      h.apply(fixes[1].edit)
      h.holds(h.text(), '>' .. arm .. '<')
      h.wait_for_codes({ 'H402', 'H402' })
    end,
  },
  {
    'all full-width signs become ASCII by their fixes',
    function()
      h.open(h.example('robot-ja.svg'))
      h.wait('the hints are there', function()
        return #h.shown() == 12
      end)
      for left = 11, 0, -1 do
        local first = h.shown()[1]
        h.equal(first.code, 'H405')
        local range = first.user_data.lsp.range or {
          start = { line = first.lnum, character = 0 },
          ['end'] = { line = first.lnum, character = 999 },
        }
        local fix = h.ask('textDocument/codeAction', { range = range, context = { diagnostics = {}, only = { 'quickfix' } } })[1]
        h.equal(fix.title, 'Write full-width characters as ASCII')
        h.apply(fix.edit)
        h.wait('its hint is gone', function()
          return #h.shown() == left
        end)
      end
      h.holds(h.text(), '>右腕@胴</tspan>')
      h.holds(h.text(), '>-90 90</tspan>')
    end,
  },
  {
    'a shape is given a string, beside it and as its description',
    function()
      for index, expected in ipairs({
        '<text x="133.482" y="329.741" font-size="3.462" text-anchor="middle">path106@Lbody</text>',
        '<desc>path106@Lbody</desc></path>',
      }) do
        h.open(h.example('human.svg'))
        h.wait_for_codes({ 'H402', 'H402' })
        local line = h.at('id="path106"').line - 2
        local place = { line = line, character = 6 }
        local found = h.ask('textDocument/codeAction', {
          range = { start = place, ['end'] = place },
          context = { diagnostics = {} },
        })
        h.equal(titles(found), {
          'Write `path106@Lbody` beside this shape',
          'Give this shape the description `path106@Lbody`',
        })
        h.apply(found[index].edit)
        h.holds(h.text(), expected)
        h.wait_for_codes({ 'H402' })
        h.equal(h.words(h.ask_at('textDocument/hover', 'path106@Lbody').range), 'path106')
      end
    end,
  },
  {
    'attributes move to a legend',
    function()
      h.open(h.with(h.example('human.svg'), '$Shape default -15 15 Color 1.0', '$Color 1.0'))
      local found = actions_at(arm, 12)
      h.equal(titles(found), { 'Move these attributes to the legend of all 3 parts that are painted like it' })
      h.equal(found[1].kind, 'refactor.rewrite')
      h.apply(found[1].edit)
      h.holds(h.text(), '>Rarm@Ubody<')
      h.holds(h.text(), '>$Color 1.0 0.8 0.6 Shape roundv -90 90<')
      h.holds(h.ask_at('textDocument/hover', '>Rarm', 2).contents.value, '`roundv -90 90`, from the legend of its paint')
    end,
  },
  {
    'formatting touches strings alone',
    function()
      h.open(h.with(h.example('human.svg'), arm, 'Rarm  @ Ubody$Shape   roundv -90   90'))
      local options = { tabSize = 2, insertSpaces = true }
      local edits = h.ask('textDocument/formatting', { options = options })
      vim.lsp.util.apply_text_edits(edits, h.buffer, h.client().offset_encoding)
      h.equal(h.text(), h.example('human.svg'))
      h.equal(h.ask('textDocument/formatting', { options = options }), {})
    end,
  },
  {
    'formatting by Neovim\'s own command',
    function()
      h.open(h.with(h.example('human.svg'), arm, 'Rarm@Ubody$Shape   roundv -90   90'))
      if vim.lsp.buf.format then
        vim.lsp.buf.format({ timeout_ms = h.patience })
      else
        vim.lsp.buf.formatting_sync({}, h.patience)
      end
      h.equal(h.text(), h.example('human.svg'))
    end,
  },
  {
    'a colour that is picked is written',
    function()
      h.open(h.example('human.svg'))
      local colours = h.ask('textDocument/documentColor')
      local form = h.ask('textDocument/colorPresentation', {
        color = { red = 0, green = 0.5, blue = 1, alpha = 1 },
        range = colours[4].range,
      })[1]
      vim.lsp.util.apply_text_edits({ form.textEdit }, h.buffer, h.client().offset_encoding)
      h.holds(h.text(), '>$Color 0 0.5 1<')
    end,
  },
}
