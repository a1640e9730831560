"""Round trips of URDF through SDF and MJCF."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from urdftool.compare.compare import compare_robots
from urdftool.errors import UrdftoolError
from urdftool.formats.common.directory import write_directory
from urdftool.formats.mjcf.options import Options as MjcfOptions
from urdftool.formats.registry import format_named
from urdftool.formats.sdf.options import Options as SdfOptions
from urdftool.formats.urdf.options import Options as UrdfOptions
from urdftool.model.elements import Robot
from urdftool.model.load import load
from urdftool.model.world import weld_base

OPTIONS = {
    "sdf": SdfOptions(folder="robot", uri="relative", force=True),
    "mjcf": MjcfOptions(actuators="described", force=True),
}


@dataclass
class Trip:
    """Result of one round trip.

    Attributes:
        name: Name of the robot's file.
        through: Format in between.
        refused: Why it was not exported; empty if it was.
        differing: Differences that no export announced, by row.
        announced: Reasons of the other differences, by row: codes of the losses that an export
            reported for the link or joint.
    """

    name: str
    through: str
    refused: str = ""
    differing: dict[str, list[str]] = field(default_factory=dict)
    announced: dict[str, set[str]] = field(default_factory=dict)


def load_robot(path: Path) -> Robot:
    """Read a robot of example-robot-data."""
    return load(path, package_paths=[path.parents[3].parent])


def export(robot: Robot, name: str, folder: Path) -> tuple[Path, dict[str, set[str]]]:
    """Export a robot; return the file, and the codes of losses by name of the link or joint.

    Elements of SDF that are lost are named by their tag, as the kind of a difference: a loss has
    the paths of several.
    """
    written = format_named(name).write(weld_base(robot), OPTIONS.get(name, UrdfOptions(force=True)))
    write_directory(folder, written.files, main=written.main)
    lost: dict[str, set[str]] = {}
    for loss in written.losses:
        if loss.code != "lossy-limit":
            lost.setdefault(loss.name, set()).add(loss.code)
        if loss.code == "unread-element":
            for path in loss.data["names"]:
                lost.setdefault(f"<{path.split()[0].split('/')[0]}>", set()).add(loss.code)
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
        if difference.is_convention:
            continue
        codes = {
            code
            for name in (*difference.names, *difference.owners)
            for losses in (lost, lost_back)
            for code in losses.get(name, ())
        }
        if through == "mjcf" and difference.what == "limit of velocity":
            codes = {"lossy-velocity"}
        if difference.row == "simulator data":  # blocks are written anew; their values have rows
            codes |= {"rewritten", *lost.get("", ()), *lost_back.get("", ())}
        if difference.kind == "robot":
            codes |= lost.get("", set()) | lost_back.get("", set())
        if difference.kind == "robot" and trip.announced:
            codes = {"follows"}
        if codes:
            trip.announced.setdefault(difference.row, set()).update(codes)
        else:
            trip.differing.setdefault(difference.row, []).append(
                f"{difference.title} {difference.values} {difference.note}"
            )
    return trip
