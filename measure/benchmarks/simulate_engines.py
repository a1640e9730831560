"""``python -m measure.benchmarks.simulate_engines``: two engines on robots of others, as a table.

Reads the robots of ``pybullet_data`` and ``example-robot-data``, as far as they are installed.
"""

from __future__ import annotations

from measure.benchmarks.simulate_robots import robots
from urdftool.commands.simulate_one import simulate_and_judge
from urdftool.errors import UrdftoolError
from urdftool.model.load import load
from urdftool.simulation.checks.thresholds import Thresholds
from urdftool.simulation.fleet import Row, make_row, run_in_parallel
from urdftool.simulation.settings import Settings

FILES = {str(path): name for name, path in robots()}


def work(path: str, notes: list[str]) -> Row:
    """One robot in both engines."""
    robot = load(path)
    verdicts, comparison = simulate_and_judge(
        robot, Settings(), ("pybullet", "mujoco"), Thresholds()
    )
    differ = comparison.report_faults(robot) if comparison is not None else []
    row = make_row(path, robot.name, [verdict for some in verdicts for verdict in some], differ)
    ends = []
    for (verdict,) in verdicts:
        pose = verdict.run.recording.poses[-1, 0]
        rest = "moves" if verdict.rest.settled is None else f"{verdict.rest.settled:.1f} s"
        ends.append(f"{rest}, {1000 * pose[2]:.1f} mm")
    row.engine = " | ".join(ends)
    return row


def line(row: Row) -> str:
    """A robot: where each engine leaves it, in how much they differ, and why."""
    name = FILES[row.path]
    if row.error is not None:
        return f"| {name} | refused | | {row.error.message[:100]} |"
    apart = [fault for fault in row.faults if fault.code == "engines-differ"]
    if not apart:
        return f"| {name} | {row.engine} | agree |"
    said = apart[0].message.partition(": ")[2]
    more = f" (and {len(apart) - 1} more)" if len(apart) > 1 else ""
    return f"| {name} | {row.engine} | {said}{more}: {apart[0].cause} |"


def main() -> None:
    """Print the table, and how many agree."""
    print("| robot | PyBullet: at rest, height | MuJoCo | difference |\n|---|---|---|---|")
    ran = []
    for row in run_in_parallel(list(FILES), work, jobs=2, limit=300.0):
        print(line(row), flush=True)  # as they are done; sort them for a page
        if row.error is None:
            ran.append(row)
    agree = sum(not any(f.code == "engines-differ" for f in row.faults) for row in ran)
    print(f"\n{agree} of {len(ran)} agree.")


if __name__ == "__main__":
    try:
        main()
    except UrdftoolError as error:
        raise SystemExit(str(error)) from None
