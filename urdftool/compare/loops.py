"""Joints that close loops, in the rigid bodies of the first of two robots."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..mechanics.reference import Array, get_origin_matrix
from ..model.elements import Robot
from ..model.mechanism import Closure
from .bodies import Bodies
from .frames import make_origin
from .pair import Pair

_SAME = {"ball": "connect", "fixed": "weld"}
"""Constraint of MJCF that is that of a joint of SDF, by type."""


def put_loops_into_bodies(pair: Pair) -> tuple[Robot, Robot]:
    """Return both robots with each end of a loop at a rigid body of the first robot.

    Links of a body may differ in the two files. A joint of SDF is the constraint that it makes.
    """
    frames = {two: (one, frame) for one, (two, frame) in pair.frames.items()}
    own = {one: (one, np.eye(4)) for one in pair.a.by_name}
    a, b = pair.a.robot, pair.b.robot
    return (
        replace(a, closures=[_put_into_bodies(closure, pair.a, own) for closure in a.closures]),
        replace(b, closures=[_put_into_bodies(closure, pair.b, frames) for closure in b.closures]),
    )


def _put_into_bodies(
    closure: Closure, bodies: Bodies, frames: Mapping[str, tuple[str, Array]]
) -> Closure:
    """Return a loop whose ends are at bodies; they are unchanged if one has no counterpart.

    A ``connect`` has a common point, so the axes of its frame are those of the bodies.

    Args:
        closure: The loop.
        bodies: Bodies of its robot.
        frames: Name and pose, 4 × 4, of each body in the first robot.
    """
    closure = replace(closure, type=_SAME.get(closure.type, closure.type))
    ends = []
    for link, origin in ((closure.parent, closure.origin), (closure.child, closure.child_origin)):
        body = bodies.body_of.get(link, "")
        if body not in frames:
            return closure
        name, frame = frames[body]
        pose: Array = frame @ bodies.by_name[body].members[link] @ get_origin_matrix(origin)
        if closure.type == "connect":
            pose[:3, :3] = np.eye(3)
        ends.append((name, make_origin(pose)))
    (parent, origin), (child, child_origin) = ends
    return replace(closure, parent=parent, child=child, origin=origin, child_origin=child_origin)
