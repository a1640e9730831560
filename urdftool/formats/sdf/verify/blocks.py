"""Contents of ``<gazebo>`` blocks for links, joints and the robot, read from the description."""

from __future__ import annotations

from collections.abc import Iterator

from ....model.elements import Joint, Link, Robot
from ....model.settings import JOINT_TAGS, LUMPING_TAGS
from ....source.document import Element

NOWHERE = frozenset(("canonicalBody",))


def list_elements(robot: Robot, part: Link | Joint) -> Iterator[Element]:
    """Yield the elements in the blocks of a link or joint.

    If a link and a joint share a name, each gets the elements of its kind.
    """
    shared = part.name in robot.link and part.name in robot.joint
    for block in robot.gazebo:
        if block.element.get("reference") != part.name:
            continue
        for element in block.element.children:
            of_joint = element.tag in JOINT_TAGS | LUMPING_TAGS or (
                element.tag == "sensor" and (element.get("type") or "").strip() == "force_torque"
            )
            if not shared or of_joint == isinstance(part, Joint):
                yield element


def list_elements_of_whole(robot: Robot) -> Iterator[Element]:
    """Yield the elements in blocks without reference."""
    for block in robot.gazebo:
        if not block.element.get("reference"):
            yield from block.element.children
