"""Thousands of damaged robots through every command, each told by its number.

python -m measure.fuzz --cases 20000 --seed 1
python -m measure.fuzz --seed 1 --only 4711      # that case again; its folder is kept
python -m measure.fuzz --seed 1 --write   # and the table into docs/measurements/robustness.md
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import json
import multiprocessing
import tempfile
import time
from dataclasses import asdict
from pathlib import Path

from .case import Outcome, run_case
from .commands import COMMANDS
from .robots import candidates
from .table import table, write

LIBRARIES = ("numpy", "scipy.spatial", "trimesh", "lxml.etree", "xacro")
LIBRARIES += ("coacd", "mujoco", "PIL.Image")
MODULES = ("expand", "lint", "inertia_robot", "graph", "info", "diff", "export_sdf")
MODULES += ("export_mjcf", "collision_robot", "simulate_one", "view_picture")
MODULES += ("collision_mesh", "inertia_mesh", "simulate_fleet")


def warm():
    """Import what commands import, once, before the processes of the cases are forked."""
    for name in LIBRARIES:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    for name in MODULES:
        importlib.import_module(f"urdftool.commands.{name}")


def _work(job):
    seed, number, robots, folder, only = job
    return run_case(seed, number, robots, Path(folder) / str(number), only)


def read_log(path):
    """The outcomes that an earlier run kept."""
    if path is None or not path.exists():
        return []
    return [Outcome(**json.loads(line)) for line in path.read_text().splitlines()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=20000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="the number of one case")
    parser.add_argument("--command", choices=list(COMMANDS))
    parser.add_argument("--minutes", type=float, help="stop after so long, with what is done")
    parser.add_argument("--log", type=Path, help="keep outcomes there; go on with what it lacks")
    parser.add_argument("--write", action="store_true", help="write the table into the docs")
    parser.add_argument("-j", "--jobs", type=int, default=multiprocessing.cpu_count())
    options = parser.parse_args()
    robots = candidates()
    numbers = range(options.first, options.first + options.cases)
    if options.only is not None:
        numbers = [options.only]
    outcomes = read_log(options.log)
    done = {outcome.number for outcome in outcomes}
    numbers = [number for number in numbers if number not in done]
    folder = tempfile.mkdtemp(prefix="fuzz-")
    warm()
    jobs = [(options.seed, number, robots, folder, options.command) for number in numbers]
    start = time.monotonic()
    with multiprocessing.get_context("fork").Pool(options.jobs) as pool:
        for outcome in pool.imap_unordered(_work, jobs, chunksize=1):
            outcomes.append(outcome)
            if options.log:
                with options.log.open("a") as log:
                    log.write(json.dumps(asdict(outcome)) + "\n")
            for problem in outcome.problems:
                words = (f"case {outcome.number}", outcome.command, problem, outcome.robot)
                print(": ".join(words), flush=True)
            if len(outcomes) % 200 == 0:
                print(f"{len(outcomes)} cases, {time.monotonic() - start:.0f} s", flush=True)
            if options.minutes and time.monotonic() - start > 60 * options.minutes:
                break
    print(f"\nseed {options.seed}, {len(outcomes)} cases, {sum(map(len, robots))} robots")
    for line in table(outcomes):
        print(line)
    if options.write:
        write(outcomes, options.seed, sum(map(len, robots)))
    bad = sum(bool(outcome.problems) for outcome in outcomes)
    print(f"{bad} cases with problems; their folders are in {folder}" if bad else "no problems")
    return 1 if bad else 0


if __name__ == "__main__":
    raise SystemExit(main())
