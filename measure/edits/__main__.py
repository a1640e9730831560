"""Measure every operation of ``urdftool edit``: ``python -m measure.edits [--write] [FILE...]``.

Without files, the robots of example-robot-data and pybullet_data that are installed are measured.
``--mistakes`` plants one mistake in each result of every fourth robot. ``--peer PYTHON`` measures
scikit-robot, which that Python has, in place of the operations. ``--write`` writes the tables into
docs/measurements/edits.md. ``--save FILE`` writes the results after each robot; ``--merge FILE...``
adds those of several processes.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

from ..damage.robots import example_robot_data, pybullet_data
from .page import write_page
from .peer_runs import measure_peer
from .run import Results, measure_robots, merge_results

GENERATED = ("random_urdfs",)
"""Folders of pybullet_data with objects that a program made."""


def list_robots() -> list[Path]:
    """Return the URDFs of the installed collections."""
    examples, bullet = example_robot_data(), pybullet_data()
    found = [] if examples is None else sorted(examples.rglob("*.urdf"))
    for path in [] if bullet is None else sorted(bullet.rglob("*.urdf")):
        if not set(path.parts) & set(GENERATED):
            found.append(path)
    return found


def main() -> int:
    """Measure, print and write; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--mistakes", action="store_true")
    parser.add_argument("--peer", metavar="PYTHON")
    parser.add_argument("--save", metavar="FILE", type=Path)
    parser.add_argument("--merge", metavar="FILE", type=Path, nargs="+")
    parser.add_argument("files", nargs="*", type=Path)
    options = parser.parse_args()
    if find_spec("pinocchio") is None:
        print("skipped: Pinocchio is not installed (pip install pin)", file=sys.stderr)
        return 2
    paths = options.files or list_robots()
    with tempfile.TemporaryDirectory() as folder:
        if options.merge:
            results = merge_results(options.merge)
        elif options.peer:
            results = Results(peer=measure_peer(paths, options.peer, Path(folder)))
        else:
            save, mistakes = options.save, options.mistakes
            results = measure_robots(paths, Path(folder), mistakes=mistakes, save=save)
    print(write_page(results, is_written=options.write))
    return 0


if __name__ == "__main__":
    sys.exit(main())
