-- How Neovim starts okoshi's language server. Neovim 0.11 and newer finds this file by itself as `lsp/okoshi.lua` on the
-- runtime path; `vim.lsp.config('okoshi', { … })` changes what is said here. plugin/okoshi.lua uses it in older ones.

-- Shows the preview's page in the browser, and places that were picked on it in Neovim.
local function show_document(problem, params, context, config)
  if params.uri:match('^http://') then
    local opened = vim.ui.open and vim.ui.open(params.uri)
    if not opened then
      vim.notify('the preview is at ' .. params.uri)
    end
    return { success = true }
  end
  local shows = vim.lsp.handlers['window/showDocument']
  return shows and shows(problem, params, context, config) or { success = false }
end

-- Neovim 0.11 fetches diagnostics after edits, but does not know how to be asked to fetch them again when a linked file
-- changes. It is sent them instead, as older versions are.
local known = vim.lsp.protocol.make_client_capabilities()
local fetches = (known.textDocument or {}).diagnostic ~= nil
local fetches_again = ((known.workspace or {}).diagnostics or {}).refreshSupport
local capabilities = fetches and not fetches_again and { textDocument = { diagnostic = vim.NIL } } or nil

return {
  cmd = { 'okoshi', 'lsp' },
  filetypes = { 'svg', 'xml' },
  -- Other XML than drawings is none of its business. Files beside each other share a server.
  root_dir = function(buffer, start)
    local file = vim.api.nvim_buf_get_name(buffer)
    if not file:lower():match('%.svg$') then
      return
    end
    local git = vim.fn.finddir('.git', vim.fn.escape(vim.fn.fnamemodify(file, ':p:h'), ' ,;') .. ';')
    local root = git ~= '' and vim.fn.fnamemodify(git, ':p:h:h') or vim.fn.fnamemodify(file, ':p:h')
    start(root)
  end,
  capabilities = capabilities,
  handlers = { ['window/showDocument'] = show_document },
}
