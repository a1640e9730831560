"""Where a robot starts: on the plane, or above it where a fixed base carries it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from ..model.pose import Pose, rotation_from_rpy
from .recording import Array
from .settings import Settings
from .shapes import Shape

GAP = 1e-4
"""How far above the plane the lowest point starts [m]."""

CLEAR = 0.05
"""How far above the plane the moving parts on a fixed base start, as a part of the robot's size.

That is how far a joint may sag before it is reported, at the end of an arm as long as the robot."""


def spawn_pose(
    parts: Sequence[tuple[Pose, Sequence[Shape]]],
    settings: Settings,
    *,
    fixed: bool,
    at_origin: bool,
) -> tuple[Pose, float]:
    """Compute the pose of the root above the plane, and the largest extent of the robot [m].

    A free root starts with its lowest point on the plane. A fixed one does, too, unless that is a
    moving part: the plane would carry what the joints are to hold. Then the moving parts start
    clear of the plane.

    Args:
        parts: Each body's pose in the frame of the root and its collision shapes, the root first.
        settings: How the robot is spawned.
        fixed: Whether the root is fixed to the world.
        at_origin: Whether the file says where: it is put higher only where that is in the plane.
    """
    turn = Pose(rotation_from_rpy(settings.start_rpy))
    low, high = _compute_bounds(parts, turn)
    size = float((high - low).max()) if np.isfinite(low).all() else 0.0
    if settings.height is not None:
        return Pose(turn.rotation, (0.0, 0.0, settings.height)), size
    if not fixed:
        height = GAP - float(low[2])
    else:
        root, moving = (float(_compute_bounds(some, turn)[0][2]) for some in (parts[:1], parts[1:]))
        height = max(GAP - root, CLEAR * size - moving)
    if not math.isfinite(height):
        height = 0.0
    elif at_origin:
        height = max(0.0, height)
    return Pose(turn.rotation, (0.0, 0.0, height)), size


def _compute_bounds(
    parts: Iterable[tuple[Pose, Sequence[Shape]]], turn: Pose
) -> tuple[Array, Array]:
    """Compute the box around shapes of a turned robot; infinite without shapes."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for place, shapes in parts:
        if not shapes:
            continue
        pose = turn @ place
        rotation, at = np.array(pose.rotation), np.array(pose.translation)
        for axis in range(3):
            along = rotation.T @ np.eye(3)[axis]
            low[axis] = min(low[axis], at[axis] - max(s.compute_reach(-along) for s in shapes))
            high[axis] = max(high[axis], at[axis] + max(s.compute_reach(along) for s in shapes))
    return low, high
