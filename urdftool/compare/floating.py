"""Floating joints inside of a robot, which other formats have as free trees in the world."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from ..model.elements import Joint, Link, Robot
from ..model.kinematics import link_poses
from ..model.pose import get_origin_at, make_pose
from ..model.world import WORLD


def find_released(a: Robot, b: Robot, links: Mapping[str, str]) -> dict[str, str]:
    """Return floating joints inside of a robot whose child is free in the world of the other.

    Args:
        a: The robot.
        b: The other.
        links: Names of links in the other by those in the robot.

    Returns:
        Names of the joints of the other by those of the robot.
    """
    free = {j.child: j.name for j in b.joints if j.type == "floating" and j.parent == WORLD}
    inner = [j for j in a.joints if j.type == "floating" and j.parent != WORLD]
    found = ((joint.name, free.get(links.get(joint.child, joint.child))) for joint in inner)
    return {name: other for name, other in found if other is not None}


def release(robot: Robot, names: Iterable[str], other: Robot) -> Robot:
    """Return a robot whose floating joints of some names are children of the world.

    The root then is a tree of the world, too. It is fixed or free as the base of the robot is; if
    that is unknown, as the root of the other robot.
    """
    root, poses = robot.tree.root, link_poses(robot)
    if root is None:
        return robot
    base = robot.base
    start = make_pose(None if base is None else base.origin)
    chosen = set(names)
    joints = [
        replace(j, parent=WORLD, origin=get_origin_at(start @ poses[j.child], j.provenance))
        if j.name in chosen
        else j
        for j in robot.joints
    ]
    if root.name == WORLD:
        return replace(robot, joints=joints)
    anchor = next((j.type for j in other.joints if j.parent == WORLD and j.child == root.name), "")
    is_fixed = anchor == "fixed" if base is None else not base.is_free
    kind = "fixed" if is_fixed else "floating"
    origin = None if base is None else base.origin
    first = Joint(robot.provenance, f"{root.name}_floating", kind, WORLD, root.name, origin=origin)
    links = [Link(robot.provenance, WORLD), *robot.links]
    return replace(robot, links=links, joints=[first, *joints], base=None)
