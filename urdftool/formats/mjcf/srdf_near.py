"""Search for the SRDF of a robot, which is suggested but not used unless the user passes it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ...diagnostic import Severity
from ...errors import SourceError
from ...model.elements import Robot
from ...source.document import parse, read_file
from ...source.packages import find_own_package, shorten_path
from ..written import Written


def offer_srdf(robot: Robot, written: Written) -> None:
    """Report the SRDF files of a robot next to it or in its MoveIt configuration."""
    found = find_srdf_files(robot)
    if found:
        names = " or ".join(shorten_path(path) for path in found)
        written.report_loss(
            "srdf-not-used",
            f"robot '{robot.name}' has an SRDF, which is not used: --srdf {names} takes over its "
            "disabled collisions, group states and virtual joint",
            robot.element.place,
            severity=Severity.INFO,
        )


def find_srdf_files(robot: Robot) -> list[Path]:
    """Find the SRDF files whose robot has the same name.

    The search covers the folder of the description, and ``config`` of a package ``…_moveit_config``
    next to the package of the description or inside it.
    """
    if robot.source is None or robot.source.path == "-":
        return []
    path = Path(robot.source.path).absolute()
    return [file for file in dict.fromkeys(_list_candidates(path)) if _is_of(file, robot)]


def _list_candidates(path: Path) -> Iterator[Path]:
    yield from sorted(path.parent.glob("*.srdf"))
    own = find_own_package(path)
    if own is None:
        return
    yield from sorted(own[1].glob("srdf/*.srdf"))
    yield from sorted(own[1].glob("config/*.srdf"))
    for folder in (own[1], own[1].parent):
        yield from sorted(folder.glob("*_moveit_config/config/*.srdf"))


def _is_of(file: Path, robot: Robot) -> bool:
    try:
        root = parse(read_file(shorten_path(file))).root
    except SourceError:
        return False
    return root.tag == "robot" and root.get("name") == robot.name
