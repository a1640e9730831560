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


def put_loops_into_bodies(pair: Pair) -> tuple[Robot, Robot]:
    """Return both robots with each end of a loop at a rigid body of the first robot.

    Links of a body may differ in the two files.
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
    """Return a loop whose ends are at bodies; unchanged if one has no counterpart.

    Args:
        closure: The loop.
        bodies: Bodies of its robot.
        frames: Name and pose, 4 × 4, of each body in the first robot.
    """
    ends = []
    for link, origin in ((closure.parent, closure.origin), (closure.child, closure.child_origin)):
        body = bodies.body_of.get(link, "")
        if body not in frames:
            return closure
        name, frame = frames[body]
        pose: Array = frame @ bodies.by_name[body].members[link] @ get_origin_matrix(origin)
        ends.append((name, make_origin(pose)))
    (parent, origin), (child, child_origin) = ends
    return replace(closure, parent=parent, child=child, origin=origin, child_origin=child_origin)
