"""Find the casters of a robot with two driven wheels, and their height."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from ...geometry.penetration import Convex
from ...model.attached import find_attached_links
from ...model.elements import Collision, Joint, Link, Robot, Sphere, Vector
from ...model.pose import Pose, compute_dot, make_pose, rotate, transpose
from ..gazebo.wheel_pair import CASTER, find_driven_joints
from .convex_bodies import ConvexBodies, get_convex_bodies

_UP = (0.0, 0.0, 1.0)
"""Direction of the vertical in the frame of the robot."""


class Axle(NamedTuple):
    """The driven wheels with all joints at zero, in the root frame [m].

    Attributes:
        links: Names of their links.
        middle: Mean of their lowest points.
        ahead: Horizontal direction perpendicular to the axle, of length 1.
    """

    links: frozenset[str]
    middle: Vector
    ahead: Vector


class Caster(NamedTuple):
    """A support of the robot in addition to its driven wheels.

    Attributes:
        link: Its link.
        above: Height of its lowest point above that of the driven wheels [m].
        ahead: Distance in front of the axle, negative behind it [m].
        moved: What positions it: a joint, or a collision of a larger link.
        height: z of ``moved`` at which it ends as low as the wheels [m]; None if its z axis does
            not point up.
    """

    link: Link
    above: float
    ahead: float
    moved: Joint | Collision
    height: float | None

    @property
    def tilt(self) -> float:
        """Tilt of the robot if it stands on this caster and its wheels [rad]."""
        return math.atan2(self.above, abs(self.ahead))


def find_axle(robot: Robot) -> Axle | None:
    """Find the one driven axle; None if there is none, or its height is unknown."""
    found = get_convex_bodies(robot)
    lows = []
    wheels = find_driven_joints(robot)
    for joint in wheels:
        low = _find_lowest_point(found, _get_body_names(robot, joint.child))
        if low is None or not _is_rigid(robot, joint.parent):
            return None
        lows.append(low)
    if len(wheels) < 2:
        return None
    axis = wheels[0].axis.xyz if wheels[0].axis is not None else (1.0, 0.0, 0.0)
    x, y, z = rotate(found.poses[wheels[0].child].rotation, axis)
    level = math.hypot(x, y)
    if not level or abs(z) > 0.1 * level:
        return None
    ahead = (y / level, -x / level, 0.0)
    heights, places = [low[2] for low in lows], [compute_dot(ahead, low) for low in lows]
    if max(heights) - min(heights) > 0.002 or max(places) - min(places) > 0.01:
        return None
    a, b, c = (sum(part) / len(lows) for part in zip(*lows, strict=True))
    links = frozenset(name for joint in wheels for name in _get_body_names(robot, joint.child))
    return Axle(links, (a, b, c), ahead)


def _get_body_names(robot: Robot, name: str) -> set[str]:
    """Get the names of a link and of all links rigidly attached to it."""
    return {link.name for link, _ in find_attached_links(robot, robot.link[name])}


def find_casters(robot: Robot, axle: Axle) -> Iterator[Caster]:
    """Find casters by their names, and spheres that are lower than all but the wheels."""
    found = get_convex_bodies(robot)
    taken = set(axle.links)
    for name in robot.tree.order:
        joint = robot.tree.get_parent_joint(name)
        if joint is None or name in taken:
            continue
        if CASTER.search(name) or CASTER.search(joint.name):
            links = {name, *robot.tree.list_descendants(name)}
            taken |= links
            low = _find_lowest_point(found, links)
            if low is not None and _is_rigid(robot, name):
                yield _make_caster(found, robot.link[name], axle, low, joint)
    balls = list(_find_spheres(robot, found, taken))
    if not balls:
        return
    shapes = {id(ball[1]) for ball in balls}
    others = [
        _get_lowest_point(piece)[2]
        for parts in found.bodies.values()
        for link, piece in parts
        if link.name not in taken and not any(id(c) in shapes for c in link.collisions)
    ]
    for link, collision, low in balls:
        joint = robot.tree.get_parent_joint(link.name)
        alone = joint is not None and len(link.collisions) == 1
        if all(low[2] <= other + 1e-6 for other in others):
            moved = joint if alone and joint is not None else collision
            yield _make_caster(found, link, axle, low, moved)


def _find_spheres(
    robot: Robot, found: ConvexBodies, taken: set[str]
) -> Iterator[tuple[Link, Collision, Vector]]:
    """Get spheres of links that are fixed to the root, each with its lowest point."""
    for link in robot.links:
        if link.name in taken or link.name not in found.poses:
            continue
        for collision in link.collisions:
            shape = collision.geometry
            if isinstance(shape, Sphere) and _is_rigid(robot, link.name):
                pose = found.poses[link.name] @ make_pose(collision.origin)
                x, y, z = pose.translation
                yield link, collision, (x, y, z - abs(shape.radius))


def _make_caster(
    found: ConvexBodies, link: Link, axle: Axle, low: Vector, moved: Joint | Collision
) -> Caster:
    above = low[2] - axle.middle[2]
    name = moved.parent if isinstance(moved, Joint) else link.name
    frame: Pose | None = found.poses.get(name)
    up = frame is not None and compute_dot(rotate(frame.rotation, _UP), _UP) > 0.9999
    z = moved.origin.xyz[2] if moved.origin is not None else 0.0
    return Caster(
        link,
        above,
        compute_dot(axle.ahead, low) - compute_dot(axle.ahead, axle.middle),
        moved,
        z - above if up else None,
    )


def _is_rigid(robot: Robot, link: str) -> bool:
    """Tell whether no spring is between a link and the root; swivel joints are allowed."""
    for name in (link, *robot.tree.list_ancestors(link)):
        joint = robot.tree.get_parent_joint(name)
        if joint is not None and not joint.is_fixed and joint.type != "continuous":
            return False
    return True


def _find_lowest_point(found: ConvexBodies, links: set[str]) -> Vector | None:
    """Compute the lowest point of links; None without collisions or with an unread mesh."""
    parts = [
        (link, piece)
        for body in found.bodies.values()
        for link, piece in body
        if link.name in links
    ]
    if len(parts) < sum(len(found.robot.link[name].collisions) for name in links):
        return None
    return min(
        (_get_lowest_point(piece) for _, piece in parts), key=lambda point: point[2], default=None
    )


def _get_lowest_point(piece: Convex) -> Vector:
    """Compute the center of a piece, at the height of its lowest point [m]."""
    x, y, z = piece.pose.translation
    return x, y, z - piece.reach(*rotate(transpose(piece.pose.rotation), (0.0, 0.0, -1.0)))
