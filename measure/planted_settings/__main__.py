"""Measure how many planted changes ``verify`` names: ``python -m measure.planted_settings``."""

from __future__ import annotations

import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from lxml import etree

import urdftool as api
from urdftool.compare.compare import compare_robots
from urdftool.compare.difference import Difference
from urdftool.model.elements import Robot

from ..planted.change import Planted
from ..planted.measure import FOLDER
from . import mjcf, sdf

CHANGES: dict[str, Sequence[Planted]] = {"sdf": sdf.CHANGES, "mjcf": mjcf.CHANGES}


class Result(NamedTuple):
    """A change, and what the comparison says of it.

    Attributes:
        planted: The change; ``row`` has the names of parts.
        titles: Titles of the differences.
        is_named: Whether one is of such a part.
    """

    planted: Planted
    titles: list[str]
    is_named: bool


def export(robot: Robot, form: str, folder: Path) -> Path:
    """Export the robot and return its main file."""
    if form == "sdf":
        api.export_sdf(robot, folder)
        return folder / "model.sdf"
    api.export_mjcf(robot, folder)
    return folder / f"{robot.name}.xml"


def compare(robot: Robot, path: Path) -> list[Difference]:
    """Return the differences of the robot and a file, without conventions."""
    found = compare_robots(robot, api.load(path)).differences
    return [difference for difference in found if not difference.is_convention]


def measure(form: str, changes: Sequence[Planted], folder: Path) -> Iterator[Result]:
    """Yield what is found of each change; the first result is that of no change."""
    robot = api.load(FOLDER / "everything.urdf")
    path = export(robot, form, folder / form)
    text = path.read_bytes()
    titles = [difference.title for difference in compare(robot, path)]
    yield Result(Planted("no change", "", lambda root: None), titles, not titles)
    for planted in changes:
        root = etree.fromstring(text)
        planted.edit(root)
        path.write_bytes(etree.tostring(root))
        differences = compare(robot, path)
        parts = set(planted.row.split())
        named = any(parts & {*d.names, *d.owners} for d in differences)
        yield Result(planted, [d.title for d in differences], named)
    shutil.rmtree(folder / form)


def main() -> int:
    """Print what is not named, and the counts."""
    total = found = 0
    with tempfile.TemporaryDirectory() as name:
        for form, changes in CHANGES.items():
            for result in measure(form, changes, Path(name)):
                if result.planted.row:
                    total, found = total + 1, found + result.is_named
                if not result.is_named:
                    print(f"{form}: {result.planted.what} ({result.planted.row}): {result.titles}")
    print(f"{found} of {total} planted changes are named at their part")
    return int(found < 0.97 * total)


if __name__ == "__main__":
    sys.exit(main())
