"""Thousands of damaged robots through every command, each told by its number.

python -m tests.fuzz --cases 20000 --seed 1
python -m tests.fuzz --seed 1 --only 4711      # that case again; its folder is kept
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import multiprocessing
import tempfile
import time
from collections import Counter, defaultdict
from pathlib import Path

from .case import run_case
from .commands import COMMANDS
from .robots import candidates

LIBRARIES = ("numpy", "scipy.spatial", "trimesh", "collada", "lxml.etree", "rich.table", "xacro")
LIBRARIES += ("coacd", "meshoptimizer", "mujoco", "PIL.Image")
MODULES = ("expand", "lint", "inertia_robot", "graph", "info", "diff", "export_sdf")
MODULES += ("export_mjcf", "collision_robot", "simulate_one", "view_picture")


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


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=20000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="the number of one case")
    parser.add_argument("--command", choices=list(COMMANDS))
    parser.add_argument("-j", "--jobs", type=int, default=multiprocessing.cpu_count())
    options = parser.parse_args()
    robots = candidates()
    numbers = range(options.first, options.first + options.cases)
    if options.only is not None:
        numbers = [options.only]
    folder = tempfile.mkdtemp(prefix="fuzz-")
    warm()
    jobs = [(options.seed, number, robots, folder, options.command) for number in numbers]
    outcomes = []
    start = time.monotonic()
    with multiprocessing.get_context("fork").Pool(options.jobs) as pool:
        for outcome in pool.imap_unordered(_work, jobs, chunksize=1):
            outcomes.append(outcome)
            for problem in outcome.problems:
                words = (f"case {outcome.number}", outcome.command, problem, outcome.robot)
                print(": ".join(words), flush=True)
            if len(outcomes) % 1000 == 0:
                print(f"{len(outcomes)} cases, {time.monotonic() - start:.0f} s", flush=True)
    print(f"\nseed {options.seed}, {len(outcomes)} cases, {sum(map(len, robots))} robots")
    for line in table(outcomes):
        print(line)
    bad = sum(bool(outcome.problems) for outcome in outcomes)
    print(f"{bad} cases with problems; their folders are in {folder}" if bad else "no problems")
    return 1 if bad else 0


def table(outcomes):
    """By command: cases, exit codes, the slowest, problems; as Markdown."""
    by_command = defaultdict(list)
    for outcome in outcomes:
        by_command[outcome.command].append(outcome)
    yield "| command | cases | exit 0 | 1 | 2 | other | median s | slowest s | problems |"
    yield "|---|---:|---:|---:|---:|---:|---:|---:|---:|"
    for name in COMMANDS:
        found = by_command[name]
        if found:
            codes = Counter(o.code for o in found)
            times = sorted(o.seconds for o in found)
            other = len(found) - codes[0] - codes[1] - codes[2]
            problems = sum(bool(o.problems) for o in found)
            yield (
                f"| `{name}` | {len(found)} | {codes[0]} | {codes[1]} | {codes[2]} | {other} | "
                f"{times[len(times) // 2]:.2f} | {times[-1]:.1f} | {problems} |"
            )


if __name__ == "__main__":
    raise SystemExit(main())
