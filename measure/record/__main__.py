"""Record what commands print and write, and compare two records."""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

from ..benchmarks.robots import FIXTURES, ROOT
from .commands import Command, commands
from .comparison import compare


def record(command: Command, folder: Path, program: Path) -> str:
    """Run one command line in an empty folder and store what comes of it.

    Args:
        command: The command line.
        folder: Where the record is; the folder of the command in it is replaced.
        program: The checkout whose ``urdftool`` runs.

    Returns:
        The name of the command, and its exit code.
    """
    target = folder / command.name
    shutil.rmtree(target, ignore_errors=True)
    target.mkdir(parents=True)
    arguments = [
        word.replace(str(FIXTURES), str(program / "fixtures")) for word in command.arguments
    ]
    with tempfile.TemporaryDirectory() as work:
        environment = {**os.environ, "PYTHONPATH": str(program), "COLUMNS": "100"}
        environment |= {"XDG_CACHE_HOME": f"{work}/cache", "NO_COLOR": "1", "PYTHONHASHSEED": "0"}
        files = target / "files"
        files.mkdir()
        done = subprocess.run(
            [sys.executable, "-m", "urdftool", *arguments],
            cwd=files,
            env=environment,
            capture_output=True,
            check=False,
        )
    (target / "stdout").write_bytes(done.stdout)
    (target / "stderr").write_bytes(done.stderr)
    for path in filter(Path.is_file, target.rglob("*")):
        data = path.read_bytes()
        for root, sign in ((program, b"ROOT"), (files.resolve(), b"FILES")):
            data = data.replace(str(root).encode(), sign)
        path.write_bytes(data)
    words = ["urdftool", *(word.replace(str(program), "ROOT") for word in arguments)]
    facts = {"command": words, "exit": done.returncode}
    (target / "run.json").write_text(json.dumps(facts, indent=1), "utf-8")
    return f"{command.name}: {done.returncode}"


def main() -> int:
    """Read the command line."""
    parser = argparse.ArgumentParser(prog="python -m measure.record", description=__doc__)
    steps = parser.add_subparsers(dest="step", required=True)
    recording = steps.add_parser("record", help="run the commands and store what comes of them")
    recording.add_argument("folder", type=Path)
    recording.add_argument("--program", type=Path, default=ROOT, help="checkout whose code runs")
    recording.add_argument("--jobs", type=int, default=os.cpu_count())
    comparing = steps.add_parser("compare", help="list what differs in two records")
    comparing.add_argument("old", type=Path)
    comparing.add_argument("new", type=Path)
    comparing.add_argument("--lines", type=int, default=12, help="lines shown of each difference")
    for step in (recording, comparing):
        step.add_argument("--only", default="", help="commands whose name holds this word")
    given = parser.parse_args()
    if given.step == "compare":
        return compare(given.old, given.new, given.only, given.lines)
    wanted = [command for command in commands() if given.only in command.name]
    names = [command.name for command in wanted]
    if twice := {name for name in names if names.count(name) > 1}:
        parser.error(f"commands of one name: {', '.join(sorted(twice))}")
    run = partial(record, folder=given.folder.resolve(), program=given.program.resolve())
    with ThreadPoolExecutor(given.jobs) as pool:
        for line in pool.map(run, wanted):
            print(line, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
