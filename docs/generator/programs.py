"""Link the programs that every machine with Python, make and git has into one folder.

    python3 docs/generator/programs.py FOLDER

The output of tests and documentation must not depend on other installed programs: Gazebo's reader,
Graphviz, other shells, a compiler. They run with this folder as their PATH.
"""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

PROGRAMS = (
    *("sh", "bash", "env", "git", "make", "unshare"),
    # coreutils
    *("basename", "cat", "chmod", "cp", "cut", "date", "dd", "df", "dirname", "du", "echo", "expr"),
    *("false", "head", "id", "link", "ln", "ls", "mkdir", "mkfifo", "mktemp", "mv", "nice"),
    *("nproc", "od", "pwd", "printf", "readlink", "realpath", "rm", "rmdir", "seq", "sha256sum"),
    *("sleep", "sort", "stat", "stty", "tail", "tee", "test", "timeout", "touch", "tr", "true"),
    *("tty", "uname", "uniq", "wc"),
    # other essential packages of Debian
    *("awk", "cmp", "diff", "find", "grep", "gunzip", "gzip", "kill", "sed", "tar", "xargs"),
)


def link_programs(folder: Path) -> Path:
    """Link the programs that are installed into a folder, and ``python3`` as it runs now.

    Args:
        folder: Created if it does not exist.

    Returns:
        ``folder``.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for name in PROGRAMS:
        found = shutil.which(name)
        if found is not None and not (folder / name).exists():
            (folder / name).symlink_to(found)
    python = folder / "python3"
    if not python.exists():  # a script, since a link may belong to a manager of several Pythons
        python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n', "utf-8")
        python.chmod(0o755)
    return folder


def restrict_path(folder: Path, *before: Path) -> str:
    """Return a value of PATH: the folders, then the folder of programs; on Windows, PATH itself."""
    if os.name == "nt":
        return os.environ.get("PATH", "")
    return os.pathsep.join(map(str, (*before, link_programs(folder))))


if __name__ == "__main__":
    link_programs(Path(sys.argv[1]))
