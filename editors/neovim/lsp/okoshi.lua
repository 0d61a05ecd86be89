-- The configuration of okoshi's language server. Neovim 0.11 and newer finds this file as `lsp/okoshi.lua` on the runtime path;
-- `vim.lsp.config('okoshi', { … })` overrides it. plugin/okoshi.lua loads it in older versions.

-- Opens the preview page in the browser, and tells its address if none opens.
local function open_page(address)
  local function tell()
    vim.notify('the preview is at ' .. address)
  end
  local opener = vim.ui.open and vim.ui.open(address)
  if not opener then
    return tell()
  end
  -- Without a browser, programs such as xdg-open fail after a moment. Those that open one may run as long as it does.
  local looks = 0
  local function look()
    looks = looks + 1
    if not opener:is_closing() then
      if looks < 100 then
        vim.defer_fn(look, 50)
      end
    elseif opener:wait().code ~= 0 then
      tell()
    end
  end
  look()
end

-- Opens the preview page in the browser, and the strings of parts picked on it in Neovim.
local function show_document(problem, params, context, config)
  if params.uri:match('^http://') then
    open_page(params.uri)
    return { success = true }
  end
  local default = vim.lsp.handlers['window/showDocument']
  return default and default(problem, params, context, config) or { success = false }
end

-- Neovim 0.11 pulls diagnostics after edits, but does not support the refresh request that is needed when a linked file changes.
-- Disabling pull makes the server push them, as it does for older versions.
local known = vim.lsp.protocol.make_client_capabilities()
local pulls = (known.textDocument or {}).diagnostic ~= nil
local refreshes = ((known.workspace or {}).diagnostics or {}).refreshSupport
local capabilities = pulls and not refreshes and { textDocument = { diagnostic = vim.NIL } } or nil

return {
  cmd = { 'okoshi', 'lsp' },
  filetypes = { 'svg', 'xml' },
  -- Only for drawings, not for other XML. Drawings of the same repository or folder share a server.
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
