"""Measure what is known of the size of a link whose shapes are not all known."""

from __future__ import annotations

import math

from ...model.elements import Collision, Link, Robot, Visual
from ...model.pose import make_pose
from ..mesh.link_extents import get_extents


def measure_known_size(robot: Robot, link: Link) -> float:
    """Measure the diagonal of the box of a link's known shapes and of its joints [m]."""
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    boxes = [get_extents(robot).get_shape_box(one) for one in shapes]
    points = [point for box in boxes if box is not None for point in box]
    joints = robot.tree.get_child_joints(link.name)
    points += [make_pose(joint.origin).translation for joint in joints]
    if not points:
        return 0.0
    columns = list(zip(*points, strict=True))
    return math.dist([min(one) for one in columns], [max(one) for one in columns])
