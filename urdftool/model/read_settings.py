"""Reading of settings: those of ``<gazebo>`` blocks and of elements of SDF."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from ..source.document import Element
from .block_elements import is_set_by_block
from .elements import Robot
from .numbers import number
from .settings import (
    ALL_OF_JOINTS,
    ALL_OF_LINKS,
    ALL_SURFACE,
    BAD_ELEMENT,
    BAD_KEYWORD,
    OF_JOINTS,
    OF_LINKS,
    OF_ROBOT,
    OUT_OF_RANGE,
    SURFACE,
    Rejected,
    Setting,
    Settings,
    Value,
    find_required,
    get_text,
    parse,
)
from .urdf_schema import DIALECT_ATTRIBUTES


@dataclass(slots=True)
class _Reading:
    """Values of one part while they are read.

    Attributes:
        name: Name of the part.
        kind: Kind of the part.
        rejected: Elements whose text is not a value.
        values: What was read.
        weak: Identities of values for another reader, which are replaced without a word.
    """

    name: str = ""
    kind: str = "link"
    rejected: list[Rejected] = field(default_factory=list)
    values: Settings = field(default_factory=dict)
    weak: set[int] = field(default_factory=set)

    def put(
        self, row: Setting, element: Element, *, negated: bool = False, code: str = BAD_ELEMENT
    ) -> None:
        text = get_text(element)
        content, required = parse(row.kind, text), self._find_required(row, element, text, code)
        if content is None or required:
            if all(one.provenance is not element for one in self.rejected):
                code = OUT_OF_RANGE if code == BAD_KEYWORD and content is not None else code
                part = self.kind, self.name
                self.rejected.append(Rejected(element, code, *part, element.tag, text, required))
            return
        content = not content if negated else content
        before = self.values.get(row.name)
        earlier: tuple[Value, ...] = ()
        if before is not None and id(before) not in self.weak and before.content != content:
            earlier = (*before.earlier, before)
        self.values[row.name] = Value(element, content, earlier)

    def _find_required(self, row: Setting, element: Element, text: str, code: str) -> str:
        """Describe what a text has to be: one of SDF, which a block may hold, or one of a tag."""
        if code != BAD_ELEMENT or not row.path:
            return find_required(row, text)
        above = element.parent
        if above is None or above.tag == "gazebo":
            return find_required(row, text, element, {"robot": "model"}.get(self.kind, self.kind))
        return find_required(row, text, element, above.tag)


def list_settings(robot: Robot) -> Iterator[tuple[str, str, Sequence[Setting], Settings]]:
    """Yield kind and name of the robot, each link and each joint with its rows and settings.

    The settings of several collisions of a link are yielded once if they are the same.
    """
    yield "robot", robot.name, OF_ROBOT, robot.settings
    for link in robot.links:
        yield "link", link.name, ALL_OF_LINKS, link.settings
        surfaces = {id(shape.surface): shape.surface for shape in link.collisions}
        for surface in surfaces.values():
            yield "link", link.name, ALL_SURFACE, surface
    for joint in robot.joints:
        yield "joint", joint.name, ALL_OF_JOINTS, joint.settings


def list_bullet_attributes(robot: Robot) -> Iterator[tuple[str, str]]:
    """Yield the attributes of collisions that only PyBullet reads, with their links."""
    names = DIALECT_ATTRIBUTES["collision"]
    for link in robot.links if robot.format == "urdf" else ():
        for collision in link.collisions:
            if collision.xml is not None:
                yield from ((n, link.name) for n in collision.xml.attributes if n in names)


def read_sdf_settings(
    element: Element,
    rows: Iterable[Setting],
    rejected: list[Rejected],
    part: tuple[str, str],
    *,
    axis: str = "axis",
) -> Settings:
    """Return the valid settings in the SDF element of a collision, link, joint, model or world.

    ``rejected`` receives the elements whose text is not a value; ``axis`` may be ``axis2``.
    """
    kind, name = part
    reading = _Reading(name, kind, rejected)
    for row in rows:
        paths = [path.replace("axis/", f"{axis}/") for path in (row.path, row.also) if path]
        found = next((e for path in paths if (e := _find(element, path)) is not None), None)
        if found is not None:
            reading.put(row, found)
    return reading.values


def _find(element: Element, path: str) -> Element | None:
    found: Element | None = element
    for tag in path.split("/"):
        found = None if found is None else found.find_child(tag)
    return found


def add_settings(robot: Robot) -> None:
    """Read the settings of a URDF: from ``<gazebo>`` blocks and Bullet's ``<contact>``."""
    blocks, own = robot.block_elements, _Reading(robot.name, "robot")
    robot.settings = _read_elements(robot, own, blocks.get("", []), OF_ROBOT)
    for link in robot.links:
        contact, elements = link.find_child_xml("contact"), blocks.get(link.name, [])
        if not elements and contact is None:
            continue
        link.settings = _read_elements(robot, _Reading(link.name), elements, OF_LINKS)
        shapes = [e for element in elements if element.tag == "collision" for e in element.children]
        reading = _Reading(link.name)
        _put_contact(reading, contact)
        _put_raw(reading, shapes, SURFACE)
        link.surface = _read_elements(robot, reading, elements, SURFACE)
        bare = _Reading(link.name)
        _put_contact(bare, contact)
        for shape in link.collisions:
            shape.surface = link.surface if is_set_by_block(shape.name, link.name) else bare.values
        named = [get_text(e) for e in elements if e.tag == "material" and not e.children]
        link.gazebo_material = named[-1] if named else ""
    for joint in robot.joints:
        if elements := blocks.get(joint.name, []):
            reading = _Reading(joint.name, "joint")
            joint.settings = _read_elements(robot, reading, elements, OF_JOINTS)


def _read_elements(
    robot: Robot, reading: _Reading, elements: Sequence[Element], rows: Sequence[Setting]
) -> Settings:
    """Read the elements in the blocks of a part: a tag counts before an element of SDF."""
    tags = {tag: row for row in rows for tag in (*row.tags, row.opposite) if tag}
    if rows is not SURFACE:  # of several, sdformat reads the first
        _put_raw(reading, (one for one in elements[::-1] if one.tag not in tags), rows)
    for element in elements:
        if element.tag in tags:
            for row in rows:
                if element.tag in row.tags or element.tag == row.opposite:
                    is_opposite = element.tag == row.opposite
                    reading.put(row, element, negated=is_opposite, code=BAD_KEYWORD)
    robot.rejected_settings += reading.rejected
    return reading.values


def _put_raw(reading: _Reading, elements: Iterable[Element], rows: Iterable[Setting]) -> None:
    """Take the values of elements of SDF."""
    for element in elements:
        for row in rows:
            first, _, rest = row.path.partition("/")
            if element.tag == first:
                found = _find(element, rest) if rest else element
                if found is not None:
                    reading.put(row, found)


def _put_contact(reading: _Reading, contact: Element | None) -> None:
    """Take the values of Bullet's ``<contact>``; its stiffness of 0 means the default."""
    for row in SURFACE if contact is not None else ():
        element = contact.find_child(row.contact) if contact is not None and row.contact else None
        if element is not None and (row.contact != "stiffness" or number(get_text(element)) != 0):
            reading.put(row, element, code=OUT_OF_RANGE)  # 0 as a stiffness means the default
    for value in reading.values.values():
        reading.weak.add(id(value))
