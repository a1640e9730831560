"""Planted differences on 40 random robots: ``python -m tests.verification --seed 1 FILE``."""

from __future__ import annotations

import argparse
import json
import random
import tempfile
from dataclasses import asdict
from pathlib import Path

from urdftool.errors import UrdftoolError

from .planted import Harness, plant_some
from .sample import draw, is_suitable, read

PER_GROUP, PER_ROBOT = 10, 13


def main() -> None:
    """Plant, and append a line of JSON for each result to a file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--group", default="", help="only this group of robots")
    parser.add_argument("results", type=Path)
    options = parser.parse_args()
    with options.results.open("a", encoding="utf-8") as out:
        for group, sources in draw(options.seed).items():
            if options.group and group != options.group:
                continue
            done = 0
            for source in sources:
                generator = random.Random(f"{options.seed} {source.name}")
                try:
                    robot = read(source)
                    if not is_suitable(robot):
                        continue
                    with tempfile.TemporaryDirectory() as folder:
                        harness = Harness(robot, source.name, Path(folder))
                        for equal in harness.compare_equal():
                            out.write(json.dumps({"group": group, **asdict(equal)}) + "\n")
                        for planted in plant_some(harness, PER_ROBOT, generator):
                            out.write(json.dumps({"group": group, **planted.as_json()}) + "\n")
                            out.flush()
                except (UrdftoolError, RecursionError) as error:
                    line = {"group": group, "robot": source.name, "refused": str(error)}
                    out.write(json.dumps(line) + "\n")
                    continue
                done += 1
                print(group, done, source.name, flush=True)
                if done == PER_GROUP:
                    break


if __name__ == "__main__":
    main()
