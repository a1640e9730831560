"""Which tensors MuJoCo accepts, and the moments that are written for one that it might reject.

Tensors are about the center of mass [kg·m²]. MuJoCo rejects a model where the two smaller principal
moments do not add up to the largest, exactly, after its own diagonalization; a flat plate whose
numbers were rounded to text fails by 1e-16.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from ...mechanics.repair import nearest_consistent
from ...mechanics.tensor import (
    ZERO_TENSOR,
    SymmetricTensor,
    consistency,
    principal_axes,
)
from ...model.elements import Vector

Array = npt.NDArray[np.float64]

ROUNDING = 1e-9
"""Relative violation that rounding explains; it is raised away without a word."""

_SAFE = 1e-12
_LIFT = 2e-12


def is_possible(tensor: SymmetricTensor) -> bool:
    """Whether a rigid body can have it, up to rounding."""
    return all(map(math.isfinite, tensor)) and consistency(tensor).excess <= ROUNDING


def is_safe_diagonal(moments: Vector) -> bool:
    """Whether MuJoCo accepts these moments as they are."""
    a, b, c = moments
    return min(a, b, c) >= 0 and a + b >= c and a + c >= b and b + c >= a


def is_safe_tensor(tensor: SymmetricTensor) -> bool:
    """Whether MuJoCo accepts it however its diagonalization is rounded."""
    found = consistency(tensor)
    return found.excess < -_SAFE and found.moments[0] > _SAFE * max(map(abs, tensor))


def principal(tensor: SymmetricTensor) -> tuple[Array, Array]:
    """Compute principal moments, raised so far that MuJoCo accepts them, and axes as columns."""
    moments, axes = principal_axes(tensor)
    size = moments[2]
    moments = np.maximum(moments, 0.0)
    gap = moments[2] - moments[0] - moments[1]
    if gap > -_SAFE * size:
        moments[:2] += max(gap, 0.0) / 2 + _LIFT * size
        moments[:2] = [_rounded_up(moment) for moment in moments[:2]]
    moments[0] = max(moments[0], _LIFT * size)
    return moments, axes


def _rounded_up(moment: float) -> float:
    """Return the next number of twelve digits, which is above by at most 1e-11 of it."""
    short = float(f"{moment:.11e}")
    return short if short >= moment else float(f"{moment * (1 + 1e-11):.11e}")


def lift(tensor: SymmetricTensor) -> SymmetricTensor:
    """Return the nearest tensor of a rigid body; zeros where next to nothing is left of it."""
    lifted = nearest_consistent(tensor)
    negligible = max(map(abs, lifted)) < ROUNDING * max(map(abs, tensor))
    return ZERO_TENSOR if negligible else lifted
