"""Step every robot as exported to MJCF: ``python -m tests.runs [--only WORD] [--jobs N]``.

Robots of example-robot-data (in the environment of ``measure.benchmarks.peers``) and pybullet_data
are exported, held at home by their own actuators (by position actuators where they have none),
and stepped in MuJoCo for 2 s at 2 ms and 5 ms. The table has a line for each that does not run.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from measure.benchmarks.robots import bullet_robots, example_folder, example_robots
from urdftool.errors import UrdftoolError
from urdftool.formats.common.directory import write_directory
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.verify_runs import TIMESTEPS, run_at_home
from urdftool.formats.mjcf.write import write
from urdftool.model.load import load
from urdftool.refusal import Refused


@dataclass
class Outcome:
    """What became of one robot.

    Attributes:
        name: Its folder and file.
        refused: Why it is not exported; empty where it is.
        forced: Whether it is exported with ``--force`` only.
        actuators: Number of actuators, and of which kind they are.
        faults: What keeps it from running, by time step [s].
    """

    name: str
    refused: str = ""
    forced: bool = False
    actuators: str = ""
    faults: dict[float, list[str]] = field(default_factory=dict)

    @property
    def runs(self) -> bool:
        """Whether it is exported and runs at every time step."""
        return not self.refused and not any(self.faults.values())


def try_robot(path: Path, choices: dict[str, object]) -> Outcome:
    """Export a robot and step it."""
    share = example_folder()
    paths = [path.parent] if share is None else [path.parent, share.parent]
    outcome = Outcome(f"{path.parent.name}/{path.stem}")
    with tempfile.TemporaryDirectory() as folder:
        try:
            robot = load(path, package_paths=paths)
            for actuators in ("auto", "position"):
                options = {"actuators": actuators, "exclude": "touching", **choices}
                try:
                    written = write(robot, Options(**options))
                except Refused:
                    outcome.forced = True
                    written = write(robot, Options(force=True, **options))
                outcome.actuators = actuators
                if b"<actuator>" in written.text.encode():
                    break
            target = Path(folder) / "model"
            write_directory(target, written.files, main=written.main)
            for timestep in TIMESTEPS:
                trial = run_at_home(target / written.main, timestep)
                outcome.faults[timestep] = trial.list_faults()
        except (UrdftoolError, ValueError) as error:
            outcome.refused = " ".join(str(error).split())
    return outcome


def robots(only: str = "") -> list[Path]:
    """The descriptions that are tried."""
    return [path for path in (*example_robots(), *bullet_robots()) if only in str(path)]


def outcomes(paths: list[Path], choices: dict[str, object], jobs: int = 1) -> Iterator[Outcome]:
    """Try robots, each in a worker process."""
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(partial(try_robot, choices=choices), paths)


def main(arguments: list[str]) -> int:
    """Print the table; 1 where a robot does not run."""
    parser = argparse.ArgumentParser(prog="python -m tests.runs", description=__doc__)
    parser.add_argument("--only", default="", metavar="WORD", help="Part of the path of a robot.")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="Worker processes.")
    parser.add_argument("--base", help="As export mjcf has it.")
    parser.add_argument("--actuators", help="As export mjcf has it.")
    parser.add_argument("--exclude", help="As export mjcf has it.")
    parser.add_argument("--all", action="store_true", help="Also a line for those that run.")
    given = parser.parse_args(arguments)
    choices: dict[str, object] = {
        name: value for name in ("base", "actuators", "exclude") if (value := getattr(given, name))
    }
    paths = robots(given.only)
    counts = {"run": 0, "do not run": 0, "are refused": 0}
    for outcome in outcomes(paths, choices, given.jobs):
        kind = "run" if outcome.runs else "are refused" if outcome.refused else "do not run"
        counts[kind] += 1
        if kind != "run" or given.all:
            forced = ", with --force" if outcome.forced else ""
            print(f"- {outcome.name} ({outcome.actuators}{forced}): {outcome.refused}", flush=True)
        for fault in dict.fromkeys(fault for faults in outcome.faults.values() for fault in faults):
            print(f"    - {fault}", flush=True)
    print(", ".join(f"{count} {kind}" for kind, count in counts.items()) + f"; of {len(paths)}")
    return 1 if counts["do not run"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
