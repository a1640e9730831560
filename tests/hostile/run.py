"""Run commands on hostile files: ``python -m tests.hostile.run [--only WORD] [--out FILE]``.

Prints a line for each run: category, file, command, exit code, processor time, memory and verdict.
Exits with 1 if a run is above a limit, shows a traceback or a secret, or does not end.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import local

from tests.hostile.matrix import Run, execute, list_runs
from tests.hostile.place import Place
from tests.hostile.zygote import Zygote


class Runner:
    """Runs in several places at once, each with a process that forks for it."""

    def __init__(self, folder: Path, *, fresh: bool) -> None:
        """Set the folder of the places; with ``fresh``, each run starts a Python."""
        self._folder = folder
        self._fresh = fresh
        self._own = local()
        self._count = 0

    def __call__(self, run: Run) -> tuple[str, bool, float, float]:
        """Make a run; gives its line, whether it is good, and what it used."""
        if not hasattr(self._own, "place"):
            self._count += 1
            self._own.place = Place(self._folder / f"place{id(self._own)}-{self._count}")
            self._own.start = Zygote(fresh=self._fresh).run
        outcome, problems = execute(run, self._own.place, self._own.start)
        verdict = "; ".join(problems) or "good"
        used = f"{outcome.code!s:>4} {outcome.seconds:6.1f} s {outcome.megabytes:5.0f} MB"
        line = f"{run.case.category} | {run.case.name[:60]} | {run.command} | {used} | {verdict}"
        return line, not problems, outcome.seconds, outcome.megabytes


def main(arguments: list[str]) -> int:
    """Print the table; 1 where something is wrong."""
    parser = argparse.ArgumentParser(prog="python -m tests.hostile.run", description=__doc__)
    parser.add_argument("--only", default="", help="Part of the line of a run.")
    parser.add_argument("--every", action="store_true", help="Every command on every file.")
    parser.add_argument("--fork", action="store_true", help="Fork instead of starting a Python.")
    parser.add_argument("--jobs", type=int, default=2, help="Runs at once.")
    parser.add_argument("--from", type=int, default=0, dest="first", help="Number of the first.")
    parser.add_argument("--out", help="Also write the table to a file.")
    given = parser.parse_args(arguments)
    runs = [
        run
        for run in list_runs(every=given.every)
        if given.only in f"{run.case.category} | {run.case.name} | {run.command}"
    ][given.first :]
    bad, seconds, megabytes = 0, 0.0, 0.0
    kinds: Counter[str] = Counter()
    with (
        tempfile.TemporaryDirectory() as folder,
        ThreadPoolExecutor(given.jobs) as pool,
        open(given.out or "/dev/null", "w", encoding="utf-8") as table,
    ):
        runner = Runner(Path(folder), fresh=not given.fork)
        for number, (line, good, used, memory) in enumerate(pool.map(runner, runs), given.first):
            shown = f"{number} | {line}".encode("utf-8", "backslashreplace").decode()
            print(shown, flush=True)
            print(shown, file=table, flush=True)
            bad += not good
            seconds, megabytes = max(seconds, used), max(megabytes, memory)
            kinds[line.partition(" |")[0]] += 1
    print(
        f"{len(runs)} runs of {len(kinds)} kinds: {bad} bad; at most {seconds:.1f} s of processor "
        f"time and {megabytes:.0f} MB"
    )
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
