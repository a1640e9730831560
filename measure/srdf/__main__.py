"""Measurements of ``urdftool srdf`` on real robots.

- ``python -m measure.srdf decide``: proves all pairs of each robot, in one process.
- ``python -m measure.srdf sample --poses N --seconds S --search S``: random poses and a directed
  search on the pairs that were proved, and MoveIt's sampling on the arms.
- ``python -m measure.srdf boxes ROBOT ...``: lets coal check all boxes of the proofs.
- ``python -m measure.srdf write``: writes docs/measurements/srdf-numbers.md.

Results are JSON files in the folder ``--work``; robots that have one are not measured again.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from urdftool.model.load import load
from urdftool.report.srdf import as_dict
from urdftool.srdf.verdicts import Options, decide

from ..benchmarks.robots import ROOT
from .page import format_page
from .robots import ARM, GRIPPER, Source, list_sources

PAGE = ROOT / "docs" / "measurements" / "srdf-numbers.md"


def measure_decided(source: Source) -> dict[str, Any]:
    """Prove all pairs of a robot; return the verdicts and the processor time [s]."""
    robot, begin = load(source.path), time.process_time()
    data = as_dict(decide(robot, Options(jobs=1)))
    seconds = time.process_time() - begin
    return {"name": source.name, "kind": source.kind, "seconds": seconds, **data}


def measure_samples(source: Source, proved: dict[str, Any], options: Any) -> dict[str, Any]:
    """Sample the proved pairs of a robot, and find the pairs of MoveIt's steps on an arm."""
    from .moveit_sampling import sample_matrix
    from .sampling import sample

    robot = load(source.path)
    never = [tuple(p["links"]) for p in proved["pairs"] if p["verdict"] == "never"]
    found = sample(robot, never, most=options.poses, seconds=options.seconds, each=options.search)
    matrix = sample_matrix(robot).as_dict() if source.kind in (ARM, GRIPPER) else None
    return {"proved": found.as_dict(), "moveit": matrix}


def measure_boxes(source: Source) -> dict[str, Any]:
    """Let coal check the boxes of all proofs of a robot."""
    from .boxes import check_boxes

    return check_boxes(load(source.path)).as_dict()


def read_results(work: Path, action: str) -> dict[str, dict[str, Any]]:
    """Read the results of an action, by robot."""
    found = {}
    for source in list_sources():
        path = work / f"{action}-{source.name}.json"
        if path.is_file():
            found[source.name] = json.loads(path.read_text("utf-8"))
    return found


def run(options: Any) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the result of each robot that has none yet."""
    proved = read_results(options.work, "decide")
    for source in list_sources():
        if options.robots and source.name not in options.robots:
            continue
        if (options.work / f"{options.action}-{source.name}.json").is_file():
            continue
        if options.action == "decide":
            yield source.name, measure_decided(source)
        elif options.action == "boxes" and options.robots:
            yield source.name, measure_boxes(source)
        elif options.action == "sample" and source.name in proved:
            yield source.name, measure_samples(source, proved[source.name], options)


def main() -> None:
    """Run one of the measurements."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("action", choices=["decide", "sample", "boxes", "write"])
    parser.add_argument("robots", nargs="*")
    parser.add_argument("--work", type=Path, default=ROOT / "build" / "srdf")
    parser.add_argument("--poses", type=int, default=1_000_000)
    parser.add_argument(
        "--seconds", type=float, default=60.0, help="of random poses, of each robot"
    )
    parser.add_argument("--search", type=float, default=0.3, help="seconds of the search of a pair")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    if options.action == "write":
        results = [read_results(options.work, name) for name in ("decide", "sample", "boxes")]
        PAGE.write_text(format_page(*results), "utf-8")
        return
    for name, result in run(options):
        path = options.work / f"{options.action}-{name}.json"
        path.write_text(json.dumps(result), "utf-8")
        print(name, flush=True)


if __name__ == "__main__":
    main()
