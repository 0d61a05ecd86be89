-- Language support for drawings with okoshi strings, in Neovim 0.7 and newer. Requires the program `okoshi` on the PATH.
-- Add this folder to the runtime path: `vim.opt.runtimepath:append('…/editors/neovim')`.

if vim.g.loaded_okoshi then
  return
end
vim.g.loaded_okoshi = true

local group = vim.api.nvim_create_augroup('okoshi', {})

local function is_okoshi(client)
  return client and client.name == 'okoshi'
end

-- Sends the cursor to the preview, which highlights the part of the string under it.
local function send_cursor(client)
  local params = vim.lsp.util.make_position_params(0, client.offset_encoding)
  if vim.fn.has('nvim-0.11') == 1 then
    client:notify('okoshi/preview/cursor', params)
  else
    client.notify('okoshi/preview/cursor', params)
  end
end

-- Opens a live preview of the buffer.
local function preview(client, buffer)
  local params = { command = 'okoshi.preview', arguments = { vim.uri_from_bufnr(buffer) } }
  local function handle_answer(problem)
    if problem then
      vim.notify(problem.message, vim.log.levels.ERROR)
    end
  end
  vim.api.nvim_clear_autocmds({ group = group, buffer = buffer, event = 'CursorMoved' })
  vim.api.nvim_create_autocmd('CursorMoved', {
    group = group,
    buffer = buffer,
    callback = function()
      send_cursor(client)
    end,
  })
  if vim.fn.has('nvim-0.11') == 1 then
    client:request('workspace/executeCommand', params, handle_answer, buffer)
  else
    client.request('workspace/executeCommand', params, handle_answer, buffer)
  end
end

local function on_attach(client, buffer)
  -- The code lens "Preview in 3D" above the drawing; `vim.lsp.codelens.run()` runs it.
  local function show_lens()
    vim.api.nvim_buf_call(buffer, function()
      vim.lsp.codelens.refresh(vim.fn.has('nvim-0.10') == 1 and { bufnr = buffer } or nil)
    end)
  end
  local events = { 'BufEnter', 'InsertLeave', 'BufWritePost' }
  vim.api.nvim_clear_autocmds({ group = group, buffer = buffer, event = events })
  vim.api.nvim_create_autocmd(events, { group = group, buffer = buffer, callback = show_lens })
  show_lens()
  vim.api.nvim_buf_create_user_command(buffer, 'OkoshiPreview', function()
    preview(client, buffer)
  end, { desc = 'Open a live 3D preview of the drawing' })
  if vim.fn.has('nvim-0.8') == 0 then
    vim.bo[buffer].omnifunc = 'v:lua.vim.lsp.omnifunc'
    vim.bo[buffer].tagfunc = 'v:lua.vim.lsp.tagfunc'
  end
end

-- Starts the server in Neovim before 0.11, which has no `vim.lsp.config`.
local function start(buffer)
  local file = vim.api.nvim_get_runtime_file('lsp/okoshi.lua', false)[1]
  local config = vim.tbl_deep_extend('force', dofile(file), vim.g.okoshi or {}, { name = 'okoshi' })
  config.root_dir(buffer, function(root)
    config.root_dir = root
    if vim.lsp.start then
      vim.lsp.start(config, { bufnr = buffer })
      return
    end
    for _, client in pairs(vim.lsp.get_active_clients()) do
      if is_okoshi(client) and client.config.root_dir == root and not client.is_stopped() then
        vim.lsp.buf_attach_client(buffer, client.id)
        return
      end
    end
    config.on_attach = on_attach
    local id = vim.lsp.start_client(config)
    if id then
      vim.lsp.buf_attach_client(buffer, id)
    end
  end)
end

if vim.fn.has('nvim-0.8') == 1 then
  vim.api.nvim_create_autocmd('LspAttach', {
    group = group,
    callback = function(event)
      local client = vim.lsp.get_client_by_id(event.data.client_id)
      if is_okoshi(client) then
        on_attach(client, event.buf)
      end
    end,
  })
end

if vim.lsp.config then
  vim.lsp.enable('okoshi')
else
  vim.api.nvim_create_autocmd('FileType', {
    group = group,
    pattern = { 'svg', 'xml' },
    callback = function(event)
      start(event.buf)
    end,
  })
end
