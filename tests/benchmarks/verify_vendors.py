"""Models of one robot by several vendors: ``python -m tests.benchmarks.verify_vendors``.

The page needs the packages example-robot-data, pybullet_data and robosuite; ``--robosuite`` is the
folder of the last, which need not be installed.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import NamedTuple

from urdftool.formats.detect import format_of
from urdftool.formats.verify.compare import compare_robots
from urdftool.formats.verify.difference import Comparison
from urdftool.formats.verify.rows import ROWS
from urdftool.model.elements import Robot
from urdftool.model.load import load
from urdftool.source.document import read_file

from .robots import example_folder

PAGE = Path(__file__).resolve().parents[2] / "docs" / "vendors.md"
BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


class Models(NamedTuple):
    """Two models of a robot, below the folders of two packages."""

    robot: str
    one: str
    two: str


_PANDA = "example:panda_description/urdf/panda.urdf"
_BULLET = "robosuite:bullet_data"

PAIRS = (
    Models("Panda", _PANDA, "robosuite:robots/panda/robot.xml"),
    Models("Panda", _PANDA, "bullet:franka_panda/panda.urdf"),
    Models(
        "Sawyer",
        f"{_BULLET}/sawyer_description/urdf/sawyer_arm.urdf",
        "robosuite:robots/sawyer/robot.xml",
    ),
    Models(
        "Baxter",
        f"{_BULLET}/baxter_description/urdf/baxter_arm.urdf",
        "robosuite:robots/baxter/robot.xml",
    ),
    Models("xArm7", "example:xarm_description/urdf/xarm7.urdf", "robosuite:robots/xarm7/robot.xml"),
)
"""Pairs of models, by package."""


def read(path: Path) -> Robot:
    """Read a robot of any format."""
    found = format_of(read_file(path))
    if found.name == "urdf":
        return load(path, package_paths=[path.parents[3].parent])
    return found.read(path).robot


def describe(comparison: Comparison) -> list[str]:
    """Return the cells of a pair: joints that match, and the differences of each group of rows."""
    cells = [str(len(comparison.joints))]
    groups = (
        ("tree",), ("frames", "axes"), ("limits",), ("joint physics",),
        ("mass",), ("center of mass", "inertia"), ("collisions", "visuals"),
    )  # fmt: skip
    for rows in groups:
        found = [d for d in comparison.differences if d.row in rows and not d.is_convention]
        worst = max((d.amount for d in found), default=0.0)
        size = "" if worst in (0.0, float("inf")) else f", {worst:.2g}"
        cells.append(f"{len(found)}{size}" if found else "equal")
    return cells


def list_lines(folders: dict[str, Path]) -> list[str]:
    """Return the table and the first differences of each pair."""
    head = ("robot", "models", "joints", "tree", "frames, axes", "limits", "joint physics", "mass",
            "center of mass, inertia", "shapes")  # fmt: skip
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    details = []
    for models in PAIRS:
        paths = [folders[name.partition(":")[0]] / name.partition(":")[2] for name in models[1:]]
        if not all(path.is_file() for path in paths):
            continue
        comparison = compare_robots(*map(read, paths))
        names = " / ".join(f"`{name}`" for name in models[1:])
        lines.append(f"| {' | '.join((models.robot, names, *describe(comparison)))} |")
        details += ["", f"## {models.robot}: {names}", ""]
        for row in ROWS:
            found = [d for d in comparison.differences if d.row == row.name and d.kind != "robot"]
            for d in found[:2]:
                if row.name in ("collisions", "visuals", "colors"):
                    continue
                values = " / ".join(
                    f"{v:.6g}" if isinstance(v, float) else str(v) for v in d.values
                )
                places = ", ".join(f"line {place.line}" for place in d.places)
                kind = " (convention)" if d.is_convention else ""
                details.append(f"- {d.title}{kind}: {values} {d.unit} ({places})")
    return [*lines, *details]


def main() -> None:
    """Measure, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robosuite", type=Path, required=True, help="folder models/assets")
    parser.add_argument("--bullet", type=Path, required=True, help="folder pybullet_data")
    options = parser.parse_args()
    example = example_folder()
    assert example is not None
    folders = {
        "example": example / "robots",
        "bullet": options.bullet,
        "robosuite": options.robosuite,
    }
    text = PAGE.read_text("utf-8")
    head, tail = text.partition(BEGIN)[0], text.partition(END)[2]
    PAGE.write_text(f"{head}{BEGIN}\n" + "\n".join(list_lines(folders)) + f"\n{END}{tail}", "utf-8")


if __name__ == "__main__":
    main()
