"""Collision geometry that is larger than the visuals on purpose."""

from __future__ import annotations

import math

from ...model.bounds import Bounds, compute_size
from ...model.elements import Cylinder, Link, Mesh, Robot, Sphere
from ...model.pose import make_pose
from ..mesh.link_extents import LinkExtents

_SWEPT = 1.2
"""A disc of a rotor is at most so many times as wide as its blades. Chosen, no source."""

_COMPOSED = 3
"""Number of primitives that are composed to be larger than the visual. Chosen, no source."""


def is_composed(link: Link) -> bool:
    """Tell whether the collisions of a link are several primitives."""
    shapes = [collision.geometry for collision in link.collisions]
    return len(shapes) >= _COMPOSED and not any(isinstance(shape, Mesh) for shape in shapes)


def find_longer_axis(
    collision_box: Bounds, visual_box: Bounds, ratio: float, least: float
) -> int | None:
    """Find the first axis along which one box is far longer than another; None if there is none."""
    for axis, (a, b) in enumerate(zip(collision_box.size, visual_box.size, strict=True)):
        if a > ratio * b and a - b > least:
            return axis
    return None


def is_swept(robot: Robot, link: Link, collision_box: Bounds, around: Bounds) -> bool:
    """Tell whether a flat disc on a rotating joint is as wide as the visual is long."""
    joint = robot.tree.get_parent_joint(link.name)
    shapes = [collision.geometry for collision in link.collisions]
    if joint is None or joint.type not in ("continuous", "revolute") or len(shapes) != 1:
        return False
    disc = shapes[0]
    if not isinstance(disc, Cylinder) or disc.length > disc.radius:
        return False
    return max(collision_box.size) <= _SWEPT * max(around.size)


def is_ball_of_wheel(link: Link, around: Bounds) -> bool:
    """Tell whether the only collision is a sphere as wide as the visual along two axes."""
    shapes = [collision.geometry for collision in link.collisions]
    if len(shapes) != 1 or not isinstance(shapes[0], Sphere):
        return False
    width = 2 * shapes[0].radius
    return sum(abs(size - width) <= 0.1 * width for size in around.size) >= 2


_AROUND = 1.3
"""A sphere around a body is at most so many times as wide as its diagonal. Chosen, no source."""


def is_ball_around(robot: Robot, link: Link, around: Bounds) -> bool:
    """Tell whether the largest collision is a sphere as wide as the diagonal of the longest sides.

    Its center is that of the box, up to three tenths of its radius. Wheels have their own rule.
    """
    joint = robot.tree.get_parent_joint(link.name)
    if joint is not None and joint.type in ("continuous", "revolute"):
        return False
    spheres = [
        (shape.radius, collision)
        for collision in link.collisions
        if isinstance(shape := collision.geometry, Sphere)
    ]
    if not spheres:
        return False
    radius, sphere = max(spheres, key=lambda one: one[0])
    sizes = [compute_size(collision.geometry) for collision in link.collisions]
    if any(size is None or max(size) > 2 * radius for size in sizes):
        return False
    if math.dist(make_pose(sphere.origin).translation, around.center) > 0.3 * radius:
        return False
    return 2 * radius <= _AROUND * math.hypot(*sorted(around.size)[1:])


_BEYOND = 0.1
"""Part of its length by which geometry may be longer than visuals. Chosen, no source."""


CLEARLY = 3.5
"""From so many times the visual along any axis on, a collision is reported by default. Chosen: of
those below it that readers judged, two of eleven were to be changed.
"""


SPANNED = 4.0
"""Geometry that spans the visuals of neighbors is at most so many times as long as the visual of
its own link. Chosen, no source.
"""


def is_inside(box: Bounds, around: Bounds, axis: int) -> bool:
    """Tell whether a bounding box is inside of another one along an axis."""
    slack = _BEYOND * box.size[axis]
    return box.low[axis] >= around.low[axis] - slack and box.high[axis] <= around.high[axis] + slack


def join_neighbor_visuals(robot: Robot, reach: LinkExtents, link: Link, box: Bounds) -> Bounds:
    """Join a bounding box with those of the visuals of the links that joints connect to a link."""
    above = robot.tree.get_parent_joint(link.name)
    parent = None if above is None else robot.link.get(above.parent)
    if above is not None and parent is not None and parent.visuals:
        other = reach.get_body_box(link, "visuals", [(parent, make_pose(above.origin).invert())])
        box = box if other is None else box.join(other)
    for joint in robot.tree.get_child_joints(link.name):
        child = robot.link.get(joint.child)
        if child is not None and child.visuals and not joint.is_fixed:
            other = reach.get_body_box(link, "visuals", [(child, make_pose(joint.origin))])
            box = box if other is None else box.join(other)
    return box


def is_doubled(link: Link, collision_box: Bounds, visual_box: Bounds) -> bool:
    """Tell whether a round collision is twice as wide as the visual, as with a wrong radius."""
    shapes = [collision.geometry for collision in link.collisions]
    if len(shapes) != 1 or not isinstance(shapes[0], Cylinder | Sphere):
        return False
    ratios = [a / b for a, b in zip(collision_box.size, visual_box.size, strict=True) if b > 0]
    return sum(1.9 <= ratio <= 2.1 for ratio in ratios) >= 2
