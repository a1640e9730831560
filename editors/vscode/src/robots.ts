/** The robots that a file belongs to, as `urdftool lint --list` prints them. */

import * as path from "node:path";

/** Return the robots in the output of `urdftool lint FOLDER --list` that are or include a file. */
export function selectRobots(listing: string, file: string, folder: string): string[] {
  const robots: string[] = [];
  let robot = "";
  for (const line of listing.split(/\r?\n/)) {
    const included = /^  includes (.+)$/.exec(line);
    if (included?.[1] !== undefined) {
      if (isSame(included[1], file, folder)) {
        robots.push(robot);
      }
      continue;
    }
    const named = /^(\S.*?)(?:  \(.*\))?$/.exec(line);
    if (named?.[1] !== undefined && !line.endsWith("(no robot includes it)")) {
      robot = path.resolve(folder, named[1]);
      if (isSame(named[1], file, folder)) {
        robots.push(robot);
      }
    }
  }
  return [...new Set(robots)];
}

function isSame(shown: string, file: string, folder: string): boolean {
  return path.resolve(folder, shown) === path.resolve(file);
}
