"""Elements of ``<gazebo>`` blocks of a URDF, by the part that they are for.

What a robot does not hold as values, such as lights and unknown plugins, a writer takes as these.
"""

from __future__ import annotations

from collections.abc import Iterator

from ..source.document import Element
from ..source.location import Place
from .elements import GazeboExtension, Joint, Link, Robot
from .settings import JOINT_TAGS, LUMPING_TAGS

LUMPED = "_fixed_joint_lump__"
"""Mark in the names that Gazebo gives to the shapes of lumped links."""


def list_part_elements(robot: Robot, part: Link | Joint) -> Iterator[Element]:
    """Yield the elements in the blocks of a link or joint, in the order of the file.

    If a link and a joint share a name, each gets the elements of its kind.
    """
    shared = part.name in robot.link and part.name in robot.joint
    for block in robot.extensions.get(part.name, []):
        for element in block.element.children:
            if not shared or _is_of_joint(element) == isinstance(part, Joint):
                yield element


def _is_of_joint(element: Element) -> bool:
    if element.tag == "sensor":
        return (element.get("type") or "").strip() == "force_torque"
    return element.tag in JOINT_TAGS | LUMPING_TAGS


def list_model_elements(robot: Robot) -> Iterator[Element]:
    """Yield the elements in the blocks without a reference, in the order of the file."""
    for block in robot.gazebo:
        if not block.reference:
            yield from block.element.children


def list_plugins(robot: Robot) -> Iterator[Element]:
    """Yield the plugins of the robot, its links and joints, without those of sensors."""
    known = {None, "", *robot.link, *robot.joint}
    for block in robot.gazebo:
        if block.reference in known:
            yield from (plugin.element for plugin in block.plugins)


def list_dangling_blocks(robot: Robot) -> Iterator[tuple[str, GazeboExtension]]:
    """Yield the blocks whose reference is neither a link nor a joint, with the reference."""
    for block in robot.gazebo:
        name = block.reference
        if name and name not in robot.link and name not in robot.joint:
            yield name, block


def find_references_at(robot: Robot, place: Place) -> Iterator[str]:
    """Yield the reference of the block around a place; empty for that of the robot."""
    for block in robot.gazebo:
        element = block.element
        same = element.place.path == place.path
        if same and element.start <= place.start < element.end:
            yield block.reference or ""


_OWNERS = ("sensor", "light", "link", "joint", "world")


def find_owner(robot: Robot, element: Element) -> tuple[str, str]:
    """Return kind and name of the part that an element of SDF, in a file or a block, belongs to."""
    above: Element | None = element
    while above is not None:
        name = above.get("name") or ""
        if above.tag in _OWNERS and name:
            return above.tag, name
        if above.tag == "gazebo":
            reference = above.get("reference") or ""
            if not reference:
                return "robot", robot.name
            if (reference in robot.link) is (reference in robot.joint):
                return "joint" if _is_of_joint(element) else "link", reference
            return "link" if reference in robot.link else "joint", reference
        above = above.parent
    return "robot", robot.name


def is_set_by_block(shape: str | None, link: str) -> bool:
    """Tell whether Gazebo applies the settings of a link to a shape of that name in a URDF.

    As ``parser_urdf.cc`` of sdformat 12.3 (run): a name must begin with that of the link, and not
    be one of a lumped shape; shapes without a name are named by the parser.
    """
    return not shape or (shape.startswith(link) and LUMPED not in shape)


def make_taking_name(shape: str, link: str) -> str:
    """Return a name of a shape with which the settings of its link apply."""
    return f"{link}_{shape.replace(LUMPED, '_')}"
