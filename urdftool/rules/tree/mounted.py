"""Distinguish robots that are mounted on something from those that move freely."""

from __future__ import annotations

import re

from ...model.elements import Link, Robot

_MOBILE = re.compile(
    r"wheel|caster|castor|track|hip|leg|foot|feet|ankle|rotor|prop|thruster|footprint",
    re.IGNORECASE,
)
"""Words in the names of links and joints of robots that drive, walk, fly or swim."""


_WHEEL = re.compile(r"wheel|caster|castor|track|footprint", re.IGNORECASE)
"""Words in the names of links and joints of robots that drive."""


def is_floating_base(robot: Robot) -> bool:
    """Tell whether names show that a robot walks, flies or swims, and none that it drives."""
    names = (*robot.link, *robot.joint)
    return any(map(_MOBILE.search, names)) and not any(map(_WHEEL.search, names))


def is_mobile(robot: Robot) -> bool:
    """Tell whether names or a floating joint show that the base of a robot moves freely."""
    names = (*robot.link, *robot.joint)
    return any(map(_MOBILE.search, names)) or any(j.type == "floating" for j in robot.joints)


def is_arm(robot: Robot) -> bool:
    """Tell whether a robot is an arm: one chain of at least four joints begins at its root.

    The root has less than twice the mass of what it moves, and no link drives, walks or flies.
    """
    root = robot.tree.root
    if root is None or is_mobile(robot):
        return False
    turning = [joint for joint in robot.joints if joint.type in ("revolute", "continuous")]
    roots = {name for name, body in robot.tree.bodies.items() if body == root.name}
    starts = [joint for joint in robot.moving_joints if joint.parent in roots]
    mass = sum(robot.link[name].mass for name in roots)
    moved = sum(link.mass for link in robot.links) - mass
    return len(starts) == 1 and len(turning) >= 4 and mass < 2 * moved


def is_base_of_arm(robot: Robot, link: Link) -> bool:
    """Tell whether a link is the root of an arm, or fixed to it."""
    root = robot.tree.root
    return root is not None and robot.tree.bodies.get(link.name) == root.name and is_arm(robot)
