"""Round trips of URDF through SDF and MJCF."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from urdftool.errors import UrdftoolError
from urdftool.formats.common.directory import write_directory
from urdftool.formats.mjcf.options import Options as MjcfOptions
from urdftool.formats.registry import format_named
from urdftool.formats.sdf.options import Options as SdfOptions
from urdftool.formats.urdf.options import Options as UrdfOptions
from urdftool.formats.verify.compare import compare_robots
from urdftool.model.elements import Robot
from urdftool.model.load import load
from urdftool.model.world import weld_base

OPTIONS = {
    "sdf": SdfOptions(folder="robot", uri="relative", force=True),
    "mjcf": MjcfOptions(force=True),
}


@dataclass
class Trip:
    """Result of one round trip.

    Attributes:
        name: Name of the robot's file.
        through: Format in between.
        refused: Why it was not exported; empty if it was.
        differing: Differences that no export announced, by row.
        announced: Number of differences that are limits of velocity (not in MJCF), or of links
            and joints with a reported loss.
    """

    name: str
    through: str
    refused: str = ""
    differing: dict[str, list[str]] = field(default_factory=dict)
    announced: int = 0


def load_robot(path: Path) -> Robot:
    """Read a robot of example-robot-data."""
    return load(path, package_paths=[path.parents[3].parent])


def export(robot: Robot, name: str, folder: Path) -> tuple[Path, set[str]]:
    """Export a robot; return the file, and the names of links and joints with a loss."""
    written = format_named(name).write(weld_base(robot), OPTIONS.get(name, UrdfOptions(force=True)))
    write_directory(folder, written.files, main=written.main)
    lost = {loss.name for loss in written.losses if loss.code not in ("lossy-limit",)}
    return folder / written.main, lost


def make_trip(path: Path, through: str, folder: Path) -> Trip:
    """Convert a robot to a format and back, and compare it with its source.

    Args:
        path: A URDF.
        through: ``sdf`` or ``mjcf``.
        folder: An empty folder.
    """
    trip = Trip(path.stem, through)
    try:
        robot = load_robot(path)
        there, lost = export(robot, through, folder / "there")
        middle = format_named(through).read(there).robot
        back, lost_back = export(middle, "urdf", folder / "back")
        comparison = compare_robots(robot, load(back))
    except UrdftoolError as error:
        trip.refused = error.message
        return trip
    for difference in sorted(comparison.differences, key=lambda d: d.kind == "robot"):
        velocity = through == "mjcf" and difference.what == "limit of velocity"
        whole = difference.kind == "robot" and trip.announced > 0
        if (
            difference.is_convention
            or velocity
            or whole
            or {*difference.names} & (lost | lost_back)
        ):
            trip.announced += 1
        else:
            trip.differing.setdefault(difference.row, []).append(
                f"{difference.title} {difference.values} {difference.note}"
            )
    return trip
