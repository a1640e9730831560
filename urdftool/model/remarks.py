"""What a description writes that no part of a robot can hold, or that it writes twice."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ..source.location import Place
from .block_elements import list_dangling_blocks
from .elements import Robot
from .materials import resolve_material
from .numbers import describe_content
from .settings import Settings, Value


class Remark(NamedTuple):
    """A statement of a description that is not used as it is written."""

    code: str
    place: Place
    kind: str
    name: str
    message: str


def list_remarks(robot: Robot) -> Iterator[Remark]:
    """Yield what a robot does not hold as it is written; for MJCF and USD none."""
    for one in robot.rejected_settings:
        yield Remark(one.code, one.place, one.kind, one.name, f"{one.fact}; it is ignored")
    for name, block in list_dangling_blocks(robot):
        place = block.locate_attribute("reference")
        yield Remark("dangling-reference", place, "gazebo", name, describe_dangling(robot, name))
    yield from _list_repeated(robot)
    yield from _list_undefined(robot)


def _list_repeated(robot: Robot) -> Iterator[Remark]:
    """Yield the settings that blocks give several values."""
    for part, value in list_repeated_settings(robot):
        text = describe_repeated(part, value)
        yield Remark("conflicting-references", value.place, *part, text)


def list_repeated_settings(robot: Robot) -> Iterator[tuple[tuple[str, str], Value]]:
    """Yield kind and name of a part with a setting that has several values, once an element."""
    known: set[Place] = set()
    for kind, name, settings in _list_settings(robot):
        for value in settings.values():
            if value.earlier and value.place not in known:
                known.add(value.place)
                yield (kind, name), value


def describe_dangling(robot: Robot, name: str) -> str:
    """Describe a ``<gazebo>`` block whose reference is neither a link nor a joint."""
    link = next((link.name for link, shape in robot.shapes if shape.name == name), None)
    of = "" if link is None else f"; it is a shape of link '{link}'"
    return f"<gazebo> refers to '{name}', not to a link or joint, and is ignored{of}"


def describe_repeated(part: tuple[str, str], value: Value) -> str:
    """Describe a setting that has several values: which, and which one counts."""
    shown = [
        f"{content:g}" if isinstance(content, float) else content
        for content in (describe_content(one.written) for one in (*value.earlier, value))
    ]
    text = f"{part[0]} '{part[1]}': {value.tag} is set several times ({', '.join(shown)})"
    return f"{text}; {shown[-1]} counts, as in Gazebo"


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
                place = own.locate_attribute("name")
                text = f"{describe_undefined(own.name)}; it gives no color"
                yield Remark("undefined-material", place, "material", own.name, text)


def describe_undefined(material: str) -> str:
    """Describe a material that a visual names and nothing defines."""
    return f"material '{material}' is not defined"
