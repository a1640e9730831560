"""Compute the spawn pose of a robot: on the plane, or above it with a fixed base."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from ..model.pose import Pose, rotation_from_rpy
from .recording import Array
from .settings import Settings
from .shapes import Shape

GAP = 1e-4
"""Height of the lowest point above the plane at the start [m]. Chosen, no source."""

CLEAR = 0.05
"""Height of the moving links on a fixed base above the plane at the start, over the robot's size.
Joint drift of an arm of this length is reported before its end is as low as the plane. Chosen, no
source.
"""


def spawn_pose(
    parts: Sequence[tuple[Pose, Sequence[Shape]]],
    settings: Settings,
    *,
    fixed: bool,
    at_origin: bool,
) -> tuple[Pose, float]:
    """Compute the pose of the root above the plane, and the largest extent of the robot [m].

    The lowest point of a robot starts on the plane. If the base is fixed and the lowest link moves,
    it starts clear of the plane, which would carry a load that the joints must hold.

    ``at_origin``: the file places the root, which is raised only if it is below the plane.
    """
    upright = Pose(rotation_from_rpy(settings.upright_rpy))
    turn = Pose(rotation_from_rpy(settings.start_rpy)) @ upright
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
