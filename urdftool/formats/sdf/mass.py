"""Mass, centre and inertia of rigid bodies, put together exactly and in plain Python.

A tensor is the symmetric matrix of URDF's six numbers. The principal_moments of a body's *spread*
``tr(I)/2 - I`` are its second moments of mass along three axes; that none of them is negative is
the same as the triangle inequality of its principal moments.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from ...mechanics.tensor import MIN_GYRATION_RADIUS
from ...model.elements import Inertia, Link, Vector
from ...model.pose import UPRIGHT, Pose, Rotation, matrix_product, pose_of, transpose

ROUNDING = 0.01
"""How far moments may miss the triangle inequality, relative to the largest, by rounding."""

CLEAR = 1e-6
"""What is added to a mended tensor, relative to its largest moment, so that no reader doubts it."""

NO_TENSOR: Rotation = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


class Mass(NamedTuple):
    """A rigid body's mass in one frame.

    Attributes:
        mass: Mass [kg].
        center: Centre of mass [m].
        tensor: Inertia about the centre of mass, along the frame's axes [kg·m²].
    """

    mass: float = 0.0
    center: Vector = (0.0, 0.0, 0.0)
    tensor: Rotation = NO_TENSOR

    def moved(self, pose: Pose) -> Mass:
        """The same body in the frame in which its own frame is at a pose."""
        turned = self.tensor
        if pose.rotation is not UPRIGHT:
            turned = matrix_product(matrix_product(pose.rotation, turned), transpose(pose.rotation))
        return Mass(self.mass, pose.transform(self.center), turned)


def tensor_of(inertia: Inertia | None) -> Rotation:
    """The matrix of URDF's six numbers [kg·m²]; zeros where there are none."""
    if inertia is None:
        return NO_TENSOR
    i = inertia
    return (i.ixx, i.ixy, i.ixz), (i.ixy, i.iyy, i.iyz), (i.ixz, i.iyz, i.izz)


def mass_of(link: Link) -> Mass:
    """The mass of a link in the link's frame."""
    if link.inertial is None:
        return Mass()
    own = Mass(link.mass, (0.0, 0.0, 0.0), tensor_of(link.inertial.inertia))
    return own.moved(pose_of(link.inertial.origin))


def united(masses: Iterable[Mass]) -> Mass:
    """Bodies of one frame as one rigid body, by the parallel axis theorem."""
    parts = list(masses)
    total = math.fsum(part.mass for part in parts)
    if total == 0.0:
        return Mass(0.0, (0.0, 0.0, 0.0), _sum(part.tensor for part in parts))
    center = tuple(
        math.fsum(part.mass * part.center[k] for part in parts) / total for k in range(3)
    )
    shifted = [_shifted(part, center) for part in parts]  # type: ignore[arg-type]
    return Mass(total, center, _sum(shifted))  # type: ignore[arg-type]


def _shifted(part: Mass, center: Vector) -> Rotation:
    x, y, z = (a - b for a, b in zip(part.center, center, strict=True))
    m, t = part.mass, part.tensor
    xy, xz, yz = t[0][1] - m * x * y, t[0][2] - m * x * z, t[1][2] - m * y * z
    return (
        (t[0][0] + m * (y * y + z * z), xy, xz),
        (xy, t[1][1] + m * (x * x + z * z), yz),
        (xz, yz, t[2][2] + m * (x * x + y * y)),
    )


def _sum(tensors: Iterable[Rotation]) -> Rotation:
    rows = list(tensors)
    return tuple(  # type: ignore[return-value]
        tuple(math.fsum(t[i][j] for t in rows) for j in range(3)) for i in range(3)
    )


def principal(tensor: Rotation) -> tuple[Vector, Rotation]:
    """Principal moments, rising, and the axes as the rows of a matrix (Jacobi's rotations)."""
    a = [list(row) for row in tensor]
    axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    for _ in range(30):
        p, q = max(((0, 1), (0, 2), (1, 2)), key=lambda pair: abs(a[pair[0]][pair[1]]))
        if abs(a[p][q]) <= 1e-17 * (abs(a[p][p]) + abs(a[q][q])) or a[p][q] == 0.0:
            break
        theta = (a[q][q] - a[p][p]) / (2 * a[p][q])
        t = math.copysign(1.0, theta) / (abs(theta) + math.hypot(theta, 1.0))
        c = 1.0 / math.hypot(t, 1.0)
        s = t * c
        for k in range(3):
            a[k][p], a[k][q] = c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]
        for k in range(3):
            a[p][k], a[q][k] = c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]
            axes[p][k], axes[q][k] = (
                c * axes[p][k] - s * axes[q][k],
                s * axes[p][k] + c * axes[q][k],
            )
    order = sorted(range(3), key=lambda k: a[k][k])
    moments = tuple(a[k][k] for k in order)
    return moments, tuple(tuple(axes[k]) for k in order)  # type: ignore[return-value]


def shortfall(tensor: Rotation, mass: float = 0.0) -> float:
    """How far a tensor is from being possible, relative to its largest moment; at most 0 if it is.

    It is possible if no principal moment is negative and none exceeds the sum of the others.

    Args:
        tensor: Inertia about the centre of mass [kg·m²].
        mass: The body's mass [kg]; moments that are nothing to it count as rounding.
    """
    low, middle, high = principal(tensor)[0]
    scale = max(abs(low), abs(high), mass * MIN_GYRATION_RADIUS**2)
    if scale == 0.0:
        return 0.0
    return max(high - middle - low, -low) / scale


def lifted(tensor: Rotation, margin: float = 1e-12) -> Rotation:
    """The nearest possible tensor with the same axes: negative second moments become none.

    Args:
        tensor: Inertia about the centre of mass [kg·m²].
        margin: What is added to it, relative to its largest moment, so that a reader who computes
            the principal moments with rounding finds it possible too.
    """
    moments, axes = principal(tensor)
    half = math.fsum(moments) / 2
    scale = max(map(abs, moments)) or 1.0
    spread = [max(half - moment, margin * scale) for moment in moments]
    total = math.fsum(spread)
    raised = [total - part for part in spread]
    return tuple(  # type: ignore[return-value]
        tuple(math.fsum(raised[k] * axes[k][i] * axes[k][j] for k in range(3)) for j in range(3))
        for i in range(3)
    )
