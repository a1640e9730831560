"""On what a robot of two driven wheels stands besides: casters, and how high they end."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from ...geometry.penetration import Convex
from ...model.attached import attached_links
from ...model.elements import Collision, Joint, Link, Robot, Sphere, Vector
from ...model.pose import Pose, dot, pose_of, rotate, transpose
from ..gazebo.wheel_pair import CASTER, driven_joints
from .pieces import Pieces, pieces

_UP = (0.0, 0.0, 1.0)


class Axle(NamedTuple):
    """The wheels that are driven, where all joints are at zero, in the frame of the root [m].

    Attributes:
        links: Their names.
        middle: The middle of their lowest points.
        ahead: A level direction across the axle, of length 1.
    """

    links: frozenset[str]
    middle: Vector
    ahead: Vector


class Caster(NamedTuple):
    """What a robot stands on beside its wheels.

    Attributes:
        link: Its link.
        above: How much higher than the driven wheels it ends [m].
        ahead: How far it is before the axle, less than 0 behind [m].
        moved: What places it: a joint, or a collision of a larger link.
        height: Where that would have to be for it to end as low as the wheels do [m]; None where
            its z does not point up.
    """

    link: Link
    above: float
    ahead: float
    moved: Joint | Collision
    height: float | None

    @property
    def tilt(self) -> float:
        """By how much the robot lies tilted on it and its wheels [rad]."""
        return math.atan2(self.above, abs(self.ahead))


def axle_of(robot: Robot) -> Axle | None:
    """The one axle that is driven; None where there is none, or it is not known how low it is."""
    found = pieces(robot)
    lows = []
    wheels = driven_joints(robot)
    for joint in wheels:
        low = _lowest(found, _body(robot, joint.child))
        if low is None or not _hangs_rigidly(robot, joint.parent):
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
    heights, places = [low[2] for low in lows], [dot(ahead, low) for low in lows]
    if max(heights) - min(heights) > 0.002 or max(places) - min(places) > 0.01:
        return None
    a, b, c = (sum(part) / len(lows) for part in zip(*lows, strict=True))
    links = frozenset(name for joint in wheels for name in _body(robot, joint.child))
    return Axle(links, (a, b, c), ahead)


def _body(robot: Robot, name: str) -> set[str]:
    """The names of a link and of all that is rigidly attached to it."""
    return {link.name for link, _ in attached_links(robot, robot.link[name])}


def casters_of(robot: Robot, axle: Axle) -> Iterator[Caster]:
    """The casters, by their names, and spheres that are the lowest of a robot but its wheels."""
    found = pieces(robot)
    taken = set(axle.links)
    for name in robot.tree.order:
        joint = robot.tree.parent_joint(name)
        if joint is None or name in taken:
            continue
        if CASTER.search(name) or CASTER.search(joint.name):
            links = {name, *robot.tree.descendants(name)}
            taken |= links
            low = _lowest(found, links)
            if low is not None and _hangs_rigidly(robot, name):
                yield _caster(found, robot.link[name], axle, low, joint)
    balls = list(_balls(robot, found, taken))
    if not balls:
        return
    shapes = {id(ball[1]) for ball in balls}
    others = [
        _low(piece)[2]
        for parts in found.bodies.values()
        for link, piece in parts
        if link.name not in taken and not any(id(c) in shapes for c in link.collisions)
    ]
    for link, collision, low in balls:
        joint = robot.tree.parent_joint(link.name)
        alone = joint is not None and len(link.collisions) == 1
        if all(low[2] <= other + 1e-6 for other in others):
            moved = joint if alone and joint is not None else collision
            yield _caster(found, link, axle, low, moved)


def _balls(
    robot: Robot, found: Pieces, taken: set[str]
) -> Iterator[tuple[Link, Collision, Vector]]:
    """Spheres of links that stand still to the root, each with its lowest point."""
    for link in robot.links:
        if link.name in taken or link.name not in found.poses:
            continue
        for collision in link.collisions:
            shape = collision.geometry
            if isinstance(shape, Sphere) and _hangs_rigidly(robot, link.name):
                pose = found.poses[link.name] @ pose_of(collision.origin)
                x, y, z = pose.translation
                yield link, collision, (x, y, z - abs(shape.radius))


def _caster(found: Pieces, link: Link, axle: Axle, low: Vector, moved: Joint | Collision) -> Caster:
    above = low[2] - axle.middle[2]
    name = moved.parent if isinstance(moved, Joint) else link.name
    frame: Pose | None = found.poses.get(name)
    up = frame is not None and dot(rotate(frame.rotation, _UP), _UP) > 0.9999
    z = moved.origin.xyz[2] if moved.origin is not None else 0.0
    return Caster(
        link,
        above,
        dot(axle.ahead, low) - dot(axle.ahead, axle.middle),
        moved,
        z - above if up else None,
    )


def _hangs_rigidly(robot: Robot, link: str) -> bool:
    """Whether nothing springs between a link and the root; a swivel may turn."""
    for name in (link, *robot.tree.ancestors(link)):
        joint = robot.tree.parent_joint(name)
        if joint is not None and not joint.is_fixed and joint.type != "continuous":
            return False
    return True


def _lowest(found: Pieces, links: set[str]) -> Vector | None:
    """The lowest point of some links; None where they touch nothing, or a mesh was not read."""
    parts = [
        (link, piece)
        for body in found.bodies.values()
        for link, piece in body
        if link.name in links
    ]
    if len(parts) < sum(len(found.robot.link[name].collisions) for name in links):
        return None
    return min((_low(piece) for _, piece in parts), key=lambda point: point[2], default=None)


def _low(piece: Convex) -> Vector:
    """The middle of a piece, at the height of its lowest point [m]."""
    x, y, z = piece.pose.translation
    return x, y, z - piece.reach(*rotate(transpose(piece.pose.rotation), (0.0, 0.0, -1.0)))
