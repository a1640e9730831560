"""Measurements of ``urdftool verify`` on real robots.

- ``python -m measure.verification plant FILE --seed N``: plants differences in 40 random robots,
  and appends a line of JSON for each result to a file. The environment variable URDFTOOL_MJCF names
  a folder with the files of robosuite, dm_control, gymnasium and gymnasium-robotics.
- ``python -m measure.verification write FILE ...``: writes them into docs/commands/verify.md.
- ``python -m measure.verification trips``: makes all round trips, and writes them too.
"""

from __future__ import annotations

import argparse
import json
import random
import tempfile
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from urdftool.errors import UrdftoolError

from ..benchmarks.robots import example_robots
from .page import format_planted, format_trips, replace_block
from .planted import Harness, plant_some
from .round_trips import make_trip
from .sample import PER_GROUP, Source, draw, is_suitable, read

PER_ROBOT = 13


def measure(source: Source, seed: int) -> Iterator[dict[str, object]]:
    """Yield the results of a robot; nothing for one that is not suitable.

    Raises:
        UrdftoolError: It cannot be read or exported.
    """
    robot = read(source)
    if not is_suitable(robot):
        return
    with tempfile.TemporaryDirectory() as folder:
        harness = Harness(robot, source.name, Path(folder))
        for equal in harness.compare_equal():
            yield asdict(equal)
        generator = random.Random(f"{seed} {source.name}")
        for planted in plant_some(harness, PER_ROBOT, generator):
            yield asdict(planted)


def measure_group(sources: list[Source], seed: int) -> Iterator[dict[str, object]]:
    """Yield the results of the first suitable robots of a group."""
    done = 0
    for source in sources:
        results = []
        try:
            for result in measure(source, seed):
                results.append(result)
                yield {"group": source.group, **result}
        except (UrdftoolError, RecursionError) as error:
            yield {"group": source.group, "robot": source.name, "refused": str(error)}
            continue
        done += bool(results)
        if done == PER_GROUP:
            return


def main() -> None:
    """Run one of the measurements."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("action", choices=["plant", "write", "trips"])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--group", default="", help="only this group of robots")
    parser.add_argument("results", type=Path, nargs="*")
    options = parser.parse_args()
    if options.action == "write":
        replace_block("planted", format_planted(options.results))
    elif options.action == "trips":
        trips = []
        for through in ("sdf", "mjcf"):
            for path in example_robots():
                with tempfile.TemporaryDirectory() as folder:
                    trips.append(make_trip(path, through, Path(folder)))
                print(through, path.stem, trips[-1].refused, trips[-1].differing, flush=True)
        replace_block("trips", format_trips(trips))
    else:
        with options.results[0].open("a", encoding="utf-8") as out:
            for group, sources in draw(options.seed).items():
                if group.startswith(options.group):
                    for record in measure_group(sources, options.seed):
                        out.write(json.dumps(record) + "\n")
                        out.flush()


if __name__ == "__main__":
    main()
