/** Start of `urdftool server`, and the command that views a robot. */

import { execFile } from "node:child_process";
import * as vscode from "vscode";
import { LanguageClient, type LanguageClientOptions } from "vscode-languageclient/node";
import { findTool, readSurroundings } from "./find_tool";
import { selectRobots } from "./robots";

const INSTALL = "python3 -m pip install 'urdftool[all]'";
const PAGES = "https://urdftool.readthedocs.io/page/editors.html";
const PATTERN = "**/*.{urdf,xacro,srdf,sdf,mjcf,world}";

let client: LanguageClient | undefined;
let view: vscode.Terminal | undefined;

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  context.subscriptions.push(
    vscode.commands.registerCommand("urdftool.view", viewRobot),
    vscode.commands.registerCommand("urdftool.restart", restart),
    vscode.commands.registerCommand("urdftool.install", install),
    vscode.window.onDidCloseTerminal((closed) => {
      view = closed === view ? undefined : view;
    }),
    vscode.workspace.onDidGrantWorkspaceTrust(restart),
    vscode.workspace.onDidChangeConfiguration(async (event) => {
      if (event.affectsConfiguration("urdftool")) {
        await restart();
      }
    }),
  );
  await start();
}

export async function deactivate(): Promise<void> {
  await client?.stop();
}

async function restart(): Promise<void> {
  await client?.dispose();
  client = undefined;
  await start();
}

async function start(): Promise<void> {
  const tool = await requireTool();
  if (tool === undefined) {
    return;
  }
  const [command = "", ...words] = tool;
  const options: LanguageClientOptions = {
    documentSelector: [{ scheme: "file", pattern: PATTERN }],
    synchronize: {
      fileEvents: vscode.workspace.createFileSystemWatcher(
        "**/*.{urdf,xacro,srdf,sdf,mjcf,xml,yaml,yml,toml,stl,dae,obj,glb,launch,py,txt}",
      ),
    },
  };
  const settings = vscode.workspace.getConfiguration("urdftool");
  const server = { command, args: [...words, "server", ...settings.get("arguments", [])] };
  client = new LanguageClient("urdftool", "urdftool", server, options);
  try {
    await client.start();
  } catch (error) {
    const name = tool.join(" ");
    await explain(`urdftool: '${name} server' does not start (${error}); it may lack [server]`);
  }
}

/** Return the command that starts urdftool; without one, say how to install it. */
async function requireTool(): Promise<string[] | undefined> {
  const settings = vscode.workspace.getConfiguration("urdftool");
  const folders = vscode.workspace.isTrusted ? listFolders() : [];
  const tool = findTool(readSurroundings(settings.get("command", []), folders));
  if (tool === undefined) {
    await explain("urdftool is not installed, or not in .venv, venv, env or PATH.");
  }
  return tool;
}

async function explain(message: string): Promise<void> {
  const choices = ["Install in a terminal", "Set the command", "Help"] as const;
  const chosen = await vscode.window.showErrorMessage(message, ...choices);
  if (chosen === "Install in a terminal") {
    install();
  } else if (chosen === "Set the command") {
    await vscode.commands.executeCommand("workbench.action.openSettings", "urdftool.command");
  } else if (chosen === "Help") {
    await vscode.env.openExternal(vscode.Uri.parse(PAGES));
  }
}

/** Write the command that installs urdftool in a terminal; the user starts it. */
function install(): void {
  const terminal = vscode.window.createTerminal("urdftool");
  terminal.show();
  terminal.sendText(INSTALL, false);
}

/** View the robot of the active file, with the link under the cursor selected. */
async function viewRobot(): Promise<void> {
  const editor = vscode.window.activeTextEditor;
  const tool = await requireTool();
  if (editor === undefined || tool === undefined) {
    return;
  }
  await editor.document.save(); // the page reads files
  const file = editor.document.uri.fsPath;
  const robot = await chooseRobot(tool, file);
  if (robot === undefined) {
    return;
  }
  const [command, ...words] = tool;
  const place = `${file}:${editor.selection.active.line + 1}`;
  view?.dispose();
  view = vscode.window.createTerminal({
    name: "urdftool view",
    shellPath: command,
    shellArgs: [...words, "view", robot, "--at", place, "--open"],
  });
}

/** Return the robot to view for a file; the user chooses if there are several. */
async function chooseRobot(tool: readonly string[], file: string): Promise<string | undefined> {
  const folder = vscode.workspace.getWorkspaceFolder(vscode.Uri.file(file))?.uri.fsPath;
  if (folder === undefined || !file.endsWith(".xacro")) {
    return file;
  }
  const robots = selectRobots(await listRobots(tool, folder), file, folder);
  if (robots.length < 2 || robots.includes(file)) {
    return robots.includes(file) ? file : (robots[0] ?? file);
  }
  const title = "Robots that include this file";
  const items = robots.map((robot) => ({
    label: vscode.workspace.asRelativePath(robot),
    robot,
  }));
  return (await vscode.window.showQuickPick(items, { title }))?.robot;
}

function listRobots(tool: readonly string[], folder: string): Promise<string> {
  const [command = "", ...words] = tool;
  const line = [...words, "lint", folder, "--list"];
  return new Promise((resolve) => {
    execFile(command, line, { cwd: folder, timeout: 60_000 }, (_, output) => resolve(output));
  });
}

function listFolders(): string[] {
  return (vscode.workspace.workspaceFolders ?? []).map((folder) => folder.uri.fsPath);
}
