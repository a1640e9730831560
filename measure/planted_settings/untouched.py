"""Differences of untouched exports: ``python -m measure.planted_settings.untouched [FORMAT ...]``.

A difference of a part that a loss of the export names, or of the whole robot, is declared; another
one is printed.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pybullet_data

import urdftool as api
from urdftool.compare.compare import compare_robots
from urdftool.compare.rows import GLOBAL_ROWS
from urdftool.errors import UrdftoolError

FORMATS = ("sdf", "mjcf", "usd")
MAIN = {"sdf": "model.sdf", "mjcf": "*.xml", "usd": "*.usda"}


def list_robots() -> Iterator[Path]:
    """Yield the descriptions of both packages."""
    packages = Path(pybullet_data.__file__).parents[1]
    example = packages / "cmeel.prefix" / "share" / "example-robot-data" / "robots"
    yield from sorted(example.rglob("*.urdf"))
    bullet = Path(pybullet_data.getDataPath())
    yield from (p for p in sorted(bullet.rglob("*.urdf")) if "random_urdfs" not in p.parts)


def list_undeclared(path: Path, form: str, folder: Path) -> list[str]:
    """Return the differences of an export that none of its losses declares."""
    robot = api.load(path)
    export = getattr(api, f"export_{form}")
    written = export(robot, folder / "made", force=True)
    (main, *_) = sorted((folder / "made").glob(MAIN[form]))
    found = compare_robots(robot, api.load(main)).differences
    parts = {loss.name for loss in written.losses}
    parts |= {name for loss in written.losses for name in loss.data.get("names", ())}
    return [
        f"{d.row}: {d.title} {d.values} {d.note}"
        for d in found
        if not d.is_convention
        and d.row not in GLOBAL_ROWS
        and not parts & {*d.names, *d.owners, d.kind == "robot" and robot.name}
    ]


def main() -> int:
    """Print undeclared differences, and the counts."""
    counts: dict[str, list[int]] = {}
    for form in sys.argv[1:] or FORMATS:
        count = counts[form] = [0, 0, 0]
        for path in list_robots():
            with tempfile.TemporaryDirectory() as name:
                try:
                    found = list_undeclared(path, form, Path(name))
                except UrdftoolError as error:
                    count[2] += 1
                    print(f"{form} {path.name}: refused: {str(error)[:100]}", flush=True)
                    continue
            count[0] += 1
            count[1] += not found
            for text in found[:6]:
                print(f"{form} {path.name}: {text[:220]}", flush=True)
    for form, (tried, clean, refused) in counts.items():
        print(f"{form}: {clean} of {tried} without an undeclared difference, {refused} refused")
    return 0


if __name__ == "__main__":
    sys.exit(main())
