-- A session in Neovim 0.7 or newer: findings, definition, a fix and a rename; each is recorded.
local tool, robot = vim.env.URDFTOOL, vim.env.ROBOT
local out = io.open(vim.env.RECORD, "w")
local function say(text) out:write(text, "\n") out:flush() end
local function await(what, ready)
  if not vim.wait(120000, ready, 50) then say("no " .. what) vim.cmd("cquit") end
end
vim.cmd("edit " .. vim.fn.fnameescape(robot))
local buffer = vim.api.nvim_get_current_buf()
local words = vim.split(tool, " ")
table.insert(words, "server")
local id = vim.lsp.start_client({ cmd = words, root_dir = vim.fn.fnamemodify(robot, ":h") })
vim.lsp.buf_attach_client(buffer, id)
local client = vim.lsp.get_client_by_id(id)
local function show()
  local found = vim.diagnostic.get(buffer)
  table.sort(found, function(a, b) return a.lnum < b.lnum end)
  for _, one in ipairs(found) do
    say(("  %d:%d %s [%s]"):format(one.lnum + 1, one.col + 1, one.message, one.code))
  end
end
local function place(text, offset)
  local lines = vim.api.nvim_buf_get_lines(buffer, 0, -1, true)
  for number, line in ipairs(lines) do
    local column = line:find(text, 1, true)
    if column then
      return { textDocument = vim.lsp.util.make_text_document_params(buffer),
               position = { line = number - 1, character = column - 1 + (offset or 0) } }
    end
  end
end
local function ask(method, params)
  local answer
  client.request(method, params, function(err, result) answer = { err, result } end, buffer)
  await("answer to " .. method, function() return answer ~= nil end)
  if answer[1] then say("  error: " .. answer[1].message) end
  return answer[2]
end
local function short(uri) return vim.fn.fnamemodify(vim.uri_to_fname(uri), ":t") end

await("findings", function() return #vim.diagnostic.get(buffer) > 0 end)
say("open: findings") show()

local jump = ask("textDocument/definition", place(vim.env.JUMP, tonumber(vim.env.JUMP_OFFSET)))
for _, to in ipairs(vim.tbl_islist(jump or {}) and jump or { jump }) do
  local range = to.targetSelectionRange or to.range
  say(("definition of %s: %s:%d"):format(vim.env.JUMP, short(to.targetUri or to.uri), range.start.line + 1))
end

local first = vim.diagnostic.get(buffer)[1]
for _, one in ipairs(vim.diagnostic.get(buffer)) do
  if one.code == vim.env.FIX then first = one end
end
local range = { start = { line = first.lnum, character = first.col }, ["end"] = { line = first.end_lnum, character = first.end_col } }
local actions = ask("textDocument/codeAction", {
  textDocument = vim.lsp.util.make_text_document_params(buffer), range = range,
  context = { diagnostics = { first.user_data.lsp and vim.tbl_extend("force", {
    range = range, message = first.message, code = first.code, source = first.source, severity = first.severity }, first.user_data.lsp) } } })
for _, action in ipairs(actions or {}) do say("action: " .. action.title) end
local chosen = actions[1]
if not chosen.edit then chosen = ask("codeAction/resolve", chosen) end
vim.lsp.util.apply_workspace_edit(chosen.edit, client.offset_encoding)
await("other findings", function()
  for _, one in ipairs(vim.diagnostic.get(buffer)) do
    if one.code == first.code then return false end
  end
  return true
end)
say("after '" .. chosen.title .. "': findings") show()

local params = place(vim.env.RENAME, tonumber(vim.env.RENAME_OFFSET))
params.newName = vim.env.NEW_NAME
local edit = ask("textDocument/rename", params)
if edit then
  vim.lsp.util.apply_workspace_edit(edit, client.offset_encoding)
  say("renamed to " .. vim.env.NEW_NAME)
  for _, one in ipairs(vim.api.nvim_list_bufs()) do
    local name = vim.fn.fnamemodify(vim.api.nvim_buf_get_name(one), ":t")
    for number, line in ipairs(vim.api.nvim_buf_get_lines(one, 0, -1, false)) do
      if line:find(vim.env.NEW_NAME, 1, true) then
        say(("  %s:%d: %s"):format(name, number, vim.trim(line)))
      end
    end
  end
end
vim.lsp.stop_client(id)
vim.cmd("qall!")
