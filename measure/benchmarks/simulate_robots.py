"""``python -m measure.benchmarks.simulate_robots``: verdicts on robots of others, as a table.

Reads the robots of ``pybullet_data`` and ``example-robot-data``, as far as they are installed.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from urdftool.api.simulate import run_trials as simulate
from urdftool.errors import UrdftoolError
from urdftool.model.load import load
from urdftool.report.simulate import describe_outcome
from urdftool.simulation.checks.interpenetration import precompute_overlaps
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge

SKIPPED = ("plane", "random_urdfs", "lego", "block", "marble", "sphere", "cube", "testdata", "toys")


def robots() -> Iterator[tuple[str, Path]]:
    """Names and files."""
    try:
        import pybullet_data
    except ImportError:
        pass
    else:
        root = Path(pybullet_data.getDataPath())
        for path in sorted([*root.glob("*.urdf"), *root.glob("*/*.urdf")]):
            name = path.relative_to(root).as_posix()
            if not any(word in name for word in SKIPPED):
                yield name, path
    for folder in map(Path, sys.path):
        for root in folder.glob("cmeel.prefix/share/example-robot-data/robots"):
            for path in sorted([*root.glob("*/robots/*.urdf"), *root.glob("*/urdf/*.urdf")]):
                yield path.relative_to(root).as_posix(), path


def row(named: tuple[str, Path]) -> str:
    """One robot: stands or not, and why."""
    name, path = named
    try:
        robot = load(path)
        (run,) = simulate(robot, Settings(), precompute=precompute_overlaps)
    except UrdftoolError as error:
        said = error.message.partition("; the file exists in")[0]  # a path
        return f"| {name} | refused | {said[:110]} |"
    verdict = judge(robot, run)
    first: dict[str, str] = {}
    for fault in verdict.faults:
        if fault.fails:
            first.setdefault(fault.code, fault.message[:110])
    why = "; ".join(f"{kind}: {message}" for kind, message in first.items())
    return f"| {name} | {describe_outcome(verdict)} | {why} |"


def main() -> None:
    """Print the counts and the table."""
    with ThreadPoolExecutor(2) as pool:
        lines = list(pool.map(row, robots()))
    counts = Counter(line.split(" | ")[1] for line in lines)
    print(f"{len(lines)} robots: {', '.join(f'{n} {word}' for word, n in counts.most_common())}.\n")
    print("| robot | verdict | why |\n|---|---|---|", *lines, sep="\n")


if __name__ == "__main__":
    main()
