"""What a description writes that no part of a robot can hold, or that it writes twice."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ..source.location import Place
from .block_elements import list_dangling_blocks
from .elements import Robot
from .materials import resolve_material
from .numbers import describe_content
from .settings import Settings


class Remark(NamedTuple):
    """A statement of a description that is not used as it is written.

    Attributes:
        code: ``rejected-setting``, ``repeated-setting``, ``dangling-block`` or
            ``undefined-material``.
        place: Where it is.
        kind: Kind of its part, such as ``link``.
        name: Name of that part.
        message: What is wrong, and what counts instead.
    """

    code: str
    place: Place
    kind: str
    name: str
    message: str


def list_remarks(robot: Robot) -> Iterator[Remark]:
    """Yield what a robot does not hold as it is written; for MJCF and USD none."""
    for one in robot.rejected_settings:
        yield Remark("rejected-setting", one.place, one.kind, one.name, one.message)
    rejected = {one.place for one in robot.rejected_settings}
    for name, block in list_dangling_blocks(robot):
        if block.place not in rejected:
            text = f"<gazebo> refers to '{name}', not to a link or joint; it is ignored"
            yield Remark("dangling-block", block.place, "gazebo", name, text)
    yield from _list_repeated(robot)
    yield from _list_undefined(robot)


def _list_repeated(robot: Robot) -> Iterator[Remark]:
    """Yield the settings that blocks give several values, once for each element that counts."""
    known: set[Place] = set()
    for kind, name, settings in _list_settings(robot):
        for value in settings.values():
            if value.earlier and value.place not in known:
                known.add(value.place)
                text = f"{kind} '{name}': {value.tag} is set several times; "
                shown = describe_content(value.written)
                shown = f"{shown:g}" if isinstance(shown, float) else shown
                text += f"{shown} counts, as in Gazebo"
                yield Remark("repeated-setting", value.place, kind, name, text)


def _list_settings(robot: Robot) -> Iterator[tuple[str, str, Settings]]:
    yield "robot", robot.name, robot.settings
    for link in robot.links:
        yield "link", link.name, {**link.surface, **link.settings}
    for joint in robot.joints:
        yield "joint", joint.name, joint.settings


def _list_undefined(robot: Robot) -> Iterator[Remark]:
    """Yield the first use of each material that a URDF names and does not define."""
    known: set[str] = set()
    for link in robot.links if robot.format == "urdf" else ():
        for visual in link.visuals:
            own = visual.material
            if own is None or not own.name or own.name in known:
                continue
            known.add(own.name)
            if resolve_material(robot, own) is None:
                text = f"material '{own.name}' is not defined; its visuals have no color"
                yield Remark("undefined-material", own.place, "material", own.name, text)
