"use strict";

const assert = require("node:assert");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const test = require("node:test");
const { findTool } = require("../dist-test/find_tool.js");

const NAME = process.platform === "win32" ? "urdftool.exe" : "urdftool";
const SCRIPTS = process.platform === "win32" ? "Scripts" : "bin";

function put(folder) {
  fs.mkdirSync(folder, { recursive: true });
  const file = path.join(folder, NAME);
  fs.writeFileSync(file, "", { mode: 0o755 });
  return file;
}

function around(folder, changes) {
  return { configured: [], folders: [], searched: "", home: path.join(folder, "home"), ...changes };
}

test("the setting comes first, then the workspace, PATH and ~/.local", () => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "urdftool-"));
  const work = path.join(folder, "work");
  const onPath = path.join(folder, "path");
  assert.strictEqual(findTool(around(folder, { folders: [work], searched: onPath })), undefined);
  const local = put(path.join(folder, "home", ".local", "bin"));
  assert.deepStrictEqual(findTool(around(folder, { folders: [work] })), [local]);
  const searched = put(onPath);
  assert.deepStrictEqual(findTool(around(folder, { searched: onPath })), [searched]);
  const own = put(path.join(work, ".venv", SCRIPTS));
  assert.deepStrictEqual(findTool(around(folder, { folders: [work], searched: onPath })), [own]);
  const configured = ["uvx", "urdftool"];
  assert.deepStrictEqual(findTool(around(folder, { configured, folders: [work] })), configured);
});

test("a folder of PATH that is relative is not searched", () => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "urdftool-"));
  put(path.join(folder, "bin"));
  const before = process.cwd();
  process.chdir(folder);
  try {
    assert.strictEqual(findTool(around(folder, { searched: "bin" })), undefined);
  } finally {
    process.chdir(before);
  }
});
