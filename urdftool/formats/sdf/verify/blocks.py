"""Contents of ``<gazebo>`` blocks for links, joints and the robot, read from the description."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ....model.elements import Collision, Joint, Link, Robot
from ....model.settings import (
    JOINT_TAGS,
    LUMPING_TAGS,
    OF_JOINTS,
    SURFACE,
    Setting,
    Settings,
)
from ....source.document import Element
from .facts import Facts, get_facts

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


def get_settings_facts(settings: Settings, rows: Iterable[Setting]) -> Facts:
    """Return the values of settings by their paths in SDF."""
    facts: Facts = {}
    for row in rows:
        if row.name in settings:
            content = settings[row.name].content
            value = content if isinstance(content, tuple) else (float(content),)
            facts.update({path: value for path in (row.path, row.also) if path})
    return facts


def get_expected_surface(robot: Robot, link: Link, collision: Collision) -> Facts:
    """Return the properties of a collision of a link, other than its shape."""
    facts: Facts = {}
    for element in list_elements(robot, link):
        if element.tag == "collision":
            facts.update(get_facts(element))
    return facts | get_settings_facts(collision.surface, SURFACE)


def get_expected_joint_physics(robot: Robot, joint: Joint) -> Facts:
    """Return the properties of a joint, other than its own axis and limits."""
    facts: Facts = {}
    for element in list_elements(robot, joint):
        if element.tag in ("physics", "axis", "axis2"):
            facts.update({f"{element.tag}/{p}": v for p, v in get_facts(element).items()})
    return facts | get_settings_facts(joint.settings, OF_JOINTS)
