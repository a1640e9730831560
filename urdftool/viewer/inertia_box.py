"""Inertia box: a box of uniform density with the mass and inertia of a link."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..mechanics.tensor import compute_principal_axes, compute_second_moment
from ..model.elements import Inertial, Vector
from ..model.pose import Pose, make_pose


@dataclass(frozen=True)
class InertiaBox:
    """A box in the frame of its link.

    Attributes:
        size: Edges [m].
        pose: Pose of its center, along its edges.
        possible: Whether the inertia is physically consistent; if not, an edge whose square would
            be negative has length 0.
    """

    size: Vector
    pose: Pose
    possible: bool


def compute_inertia_box(inertial: Inertial | None) -> InertiaBox | None:
    """Compute the box of uniform density with the mass and inertia of a link.

    The edge along a principal axis is √(12 s / m), with s = ∫ x² dm the second moment, which is m
    a² / 12 for a box of edge a.

    Returns:
        None if mass or inertia is missing, not positive or not finite.
    """
    if inertial is None or inertial.inertia is None or not inertial.mass:
        return None
    pose = make_pose(inertial.origin)
    numbers = (*inertial.inertia.six, inertial.mass, *pose.translation, *pose.rotation[0])
    if (
        inertial.mass < 0
        or not all(map(math.isfinite, numbers))
        or not any(inertial.inertia.moments)
    ):
        return None
    moments, axes = compute_principal_axes(compute_second_moment(inertial.inertia.six))
    squares = 12.0 * moments / inertial.mass
    x, y, z = (float(edge) for edge in np.sqrt(np.maximum(squares, 0.0)))
    rows = axes.tolist()
    turned = Pose((tuple(rows[0]), tuple(rows[1]), tuple(rows[2])), (0.0, 0.0, 0.0))
    possible = bool(squares.min() >= -1e-9 * squares.max())
    return InertiaBox((x, y, z), pose @ turned, possible)
