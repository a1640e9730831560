"""What a description writes that no part of a robot can hold, or that it writes twice."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ..source.location import Place
from .block_elements import is_set_by_block, list_dangling_blocks, list_part_elements
from .elements import Collision, Link, Robot, Visual
from .materials import resolve_material
from .numbers import describe_content
from .settings import SURFACE_TAGS, Settings, Value

UNSET = "named-geometry-loses-extensions"
"""Name of the rule of ``lint`` on collisions that the blocks of their link do not reach."""


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
    for link, shape, tags in list_unset_collisions(robot):
        place, text = shape.locate_attribute("name"), describe_unset(link, shape, tags)
        yield Remark(UNSET, place, "link", link.name, text)
    yield from _list_repeated(robot)
    yield from _list_undefined(robot)


def list_unset_collisions(robot: Robot) -> Iterator[tuple[Link, Collision, list[str]]]:
    """Yield the collisions whose name keeps the blocks of their link from them, with the tags."""
    for link in robot.links:
        tags = {e.tag for e in list_part_elements(robot, link)} & {*SURFACE_TAGS, "collision"}
        for shape in link.collisions if tags else ():
            if not is_set_by_block(shape.name, link.name):
                yield link, shape, sorted(tags)


def describe_unset(link: Link, shape: Collision | Visual, tags: Sequence[str]) -> str:
    """Describe a shape to which Gazebo does not apply the blocks of its link: why, and which."""
    name = shape.name or ""
    why = f"does not begin with '{link.name}'"
    if name.startswith(link.name):
        why = "is one of a lumped link"
    return f"name of {shape.tag} '{name}' {why}, so Gazebo applies no {' or '.join(tags)} to it"


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
