"""Replacements for an inertia tensor that is physically inconsistent."""

from __future__ import annotations

from ..model.elements import Vector
from .tensor import (
    SymmetricTensor,
    compute_principal_axes,
    from_matrix,
    make_diagonal_tensor,
    trace_of,
)


def find_nearest_consistent(tensor: SymmetricTensor, margin: float = 0.0) -> SymmetricTensor:
    """Return the nearest physically consistent tensor with the same principal axes.

    Eigenvalues of the second moment matrix ∫ x xᵀ dm below the margin are raised to it (Wensing,
    Kim and Slotine 2018).

    Args:
        tensor: Inertia about the center of mass [kg·m²].
        margin: Smallest second moment, relative to the largest principal moment. A value above 0
            keeps the result consistent in readers that round principal moments.
    """
    import numpy as np

    moments, axes = compute_principal_axes(tensor)
    size = float(np.abs(moments).max()) or 1.0
    second = np.maximum(0.5 * moments.sum() - moments, margin * size)
    return from_matrix((axes * (second.sum() - second)) @ axes.T)


def compute_sphere_tensor(tensor: SymmetricTensor) -> SymmetricTensor:
    """Return the sphere tensor of equal mean moment, as MuJoCo's ``balanceinertia`` does."""
    mean = max(trace_of(tensor) / 3, 0.0)
    return make_diagonal_tensor(mean, mean, mean)


def compute_box_tensor(mass: float, size: Vector) -> SymmetricTensor:
    """Return the tensor of a solid box of a mass [kg] and edges along x, y, z [m]."""
    xx, yy, zz = (edge * edge for edge in size)
    return make_diagonal_tensor(mass * (yy + zz) / 12, mass * (xx + zz) / 12, mass * (xx + yy) / 12)
