"""Rigid bodies as simulators make them: a link with all that is fixed to it, and its inertia."""

from __future__ import annotations

from collections.abc import Iterable

from ...model.attached import attached_links
from ...model.body_inertia import BodyInertia, combined_inertia
from ...model.elements import Link, Robot

_KEEPERS = ("preserveFixedJoint", "disableFixedJointLumping")
_TRUE = ("true", "1", "yes")


def bodies(robot: Robot) -> dict[str, list[Link]]:
    """The links of each rigid body, by the name of the link that the others hang on.

    Gazebo lumps a link into its parent over a fixed joint, unless the joint's ``<gazebo>`` says to
    keep it; nothing is lumped into ``world``.
    """
    kept = {
        block.reference
        for block in robot.gazebo
        if block.reference and any((block.value(k) or "").lower() in _TRUE for k in _KEEPERS)
    }
    owner: dict[str, str] = {}
    found: dict[str, list[Link]] = {}
    for name in robot.tree.order:
        joint = robot.tree.parent_joint(name)
        lumped = joint is not None and joint.is_fixed and joint.name not in kept
        if joint is not None and lumped and joint.parent != "world":
            owner[name] = owner.get(joint.parent, name)
        else:
            owner[name] = name
        found.setdefault(owner[name], []).append(robot.link[name])
    return found


def mass_of(links: list[Link]) -> float:
    """What a rigid body weighs [kg]."""
    return sum(link.mass for link in links)


def body_inertia(robot: Robot, links: Iterable[Link]) -> BodyInertia:
    """Add up the mass properties of the links of one body, in the frame of its first link.

    Args:
        robot: The robot.
        links: Links of one body of :func:`bodies`, the topmost first.
    """
    members = list(links)
    names = {link.name for link in members}
    around = attached_links(robot, members[0])
    return combined_inertia([(link, pose) for link, pose in around if link.name in names])
