"""``python -m measure.benchmarks.simulate_robots``: verdicts on robots of others.

Reads the robots of ``pybullet_data`` and ``example-robot-data``, as far as they are installed.
Writes a row for each robot into ``simulate_robots.tsv``, and prints what the page says of them.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from urdftool.api.simulate import run_trials as simulate
from urdftool.errors import UrdftoolError
from urdftool.model.load import load
from urdftool.report.simulate import describe_outcome
from urdftool.simulation.checks.interpenetration import precompute_overlaps
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge

ROWS = Path(__file__).with_suffix(".tsv")
REFUSED = "refused"
FAILED = ("stands, with model errors", "does not stand")
KIND = re.compile(r"(?:^|; )([a-z][a-z-]+): ")
"""The kinds of faults in the last column."""
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


def judge_robot(named: tuple[str, Path]) -> list[str]:
    """Return the row of a robot: its name, whether it stands, and the first fault of each kind."""
    name, path = named
    try:
        robot = load(path)
        (run,) = simulate(robot, Settings(), precompute=precompute_overlaps)
    except UrdftoolError as error:
        said = error.message.partition("; the file exists in")[0]  # a path
        return [name, REFUSED, said[:110]]
    verdict = judge(robot, run)
    first: dict[str, str] = {}
    for fault in verdict.faults:
        if fault.fails:
            first.setdefault(fault.code, fault.message[:110])
    why = "; ".join(f"{kind}: {message}" for kind, message in first.items())
    return [name, describe_outcome(verdict).partition(" by up to ")[0], why]


def summarize(rows: Sequence[Sequence[str]]) -> str:
    """Return the counts of verdicts, and a table of the kinds of errors."""
    verdicts = Counter(verdict for _, verdict, _ in rows)
    kinds = Counter(
        (verdict, kind)
        for _, verdict, why in rows
        if verdict != REFUSED
        for kind in set(KIND.findall(why))
    )
    names = {kind for verdict, kind in kinds if verdict in FAILED}
    order = sorted(names, key=lambda kind: (-sum(kinds[v, kind] for v in FAILED), kind))
    counts = ", ".join(f"{n} {word}" for word, n in verdicts.most_common())
    lines = [" | ".join([f"`{kind}`", *(str(kinds[v, kind]) for v in FAILED)]) for kind in order]
    head = f"{len(rows)} robots: {counts}.\n\n| error | {' | '.join(FAILED)} |\n|---|---|---|\n"
    return head + "\n".join(f"| {line} |" for line in lines)


def main() -> None:
    """Write the rows and print the summary."""
    with ThreadPoolExecutor(2) as pool:
        rows = list(pool.map(judge_robot, robots()))
    lines = ["\t".join(row) for row in [["robot", "verdict", "why"], *rows]]
    ROWS.write_text("\n".join(lines) + "\n", "utf-8")
    print(summarize(rows))


if __name__ == "__main__":
    main()
