/** Search of the program: setting, environments of the workspace, PATH, usual folders. */

import * as fs from "node:fs";
import * as os from "node:os";
import * as path from "node:path";

const WINDOWS = process.platform === "win32";
const ENVIRONMENTS = [".venv", "venv", "env"];

export interface Surroundings {
  /** The setting `urdftool.command`; empty without one. */
  configured: readonly string[];
  /** Folders of the workspace; empty if it is not trusted. */
  folders: readonly string[];
  /** Value of PATH. */
  searched: string;
  home: string;
}

/** Return the command that starts urdftool; undefined if it is not found. */
export function findTool(around: Surroundings): string[] | undefined {
  if (around.configured.length > 0) {
    return [...around.configured];
  }
  const program = listCandidates(around).find(isProgram);
  return program === undefined ? undefined : [program];
}

/** Return the paths at which the program may be, in the order of the search. */
export function listCandidates(around: Surroundings): string[] {
  const name = WINDOWS ? "urdftool.exe" : "urdftool";
  const scripts = WINDOWS ? "Scripts" : "bin";
  const own = around.folders.flatMap((folder) =>
    ENVIRONMENTS.map((environment) => path.join(folder, environment, scripts, name)),
  );
  const found = around.searched
    .split(path.delimiter)
    .filter((folder) => path.isAbsolute(folder))
    .map((folder) => path.join(folder, name));
  return [...own, ...found, path.join(around.home, ".local", "bin", name)];
}

/** Return the surroundings of this process. */
export function readSurroundings(
  configured: readonly string[],
  folders: readonly string[],
): Surroundings {
  return { configured, folders, searched: process.env["PATH"] ?? "", home: os.homedir() };
}

function isProgram(file: string): boolean {
  try {
    fs.accessSync(file, fs.constants.X_OK);
    return fs.statSync(file).isFile();
  } catch {
    return false;
  }
}
