"""Inertia tensors that MuJoCo accepts, and corrected principal moments for those it might reject.

Tensors are about the center of mass [kg·m²]. MuJoCo rejects a model if the sum of the two smaller
principal moments is below the largest, exactly, after its own diagonalization; a flat plate whose
numbers were rounded to text fails by 1e-16.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from ...mechanics.repair import find_nearest_consistent
from ...mechanics.tensor import (
    ROUNDING,
    ZERO_TENSOR,
    SymmetricTensor,
    compute_principal_axes,
    measure_consistency,
)
from ...model.elements import Vector

Array = npt.NDArray[np.float64]

_SAFE = 1e-12
"""Excess and moments, relative to the largest, that MuJoCo reads without an error."""

_LIFT = 2e-12
"""What a moment at the bound is raised by, relative to the largest, against rounding."""


def is_possible(tensor: SymmetricTensor) -> bool:
    """Tell whether a tensor is physically consistent, up to rounding."""
    return all(map(math.isfinite, tensor)) and measure_consistency(tensor).excess <= ROUNDING


def is_safe_diagonal(moments: Vector) -> bool:
    """Tell whether MuJoCo accepts these principal moments unchanged."""
    a, b, c = moments
    return min(a, b, c) >= 0 and a + b >= c and a + c >= b and b + c >= a


def is_safe_tensor(tensor: SymmetricTensor) -> bool:
    """Tell whether MuJoCo accepts a tensor, with a margin for rounding in its diagonalization."""
    found = measure_consistency(tensor)
    return found.excess < -_SAFE and found.moments[0] > _SAFE * max(map(abs, tensor))


def compute_principal(tensor: SymmetricTensor) -> tuple[Array, Array]:
    """Compute principal moments, raised until MuJoCo accepts them, and axes as columns."""
    moments, axes = compute_principal_axes(tensor)
    size = moments[2]
    moments = np.maximum(moments, 0.0)
    gap = moments[2] - moments[0] - moments[1]
    if gap > -_SAFE * size:
        moments[:2] += max(gap, 0.0) / 2 + _LIFT * size
        moments[:2] = [_round_up(moment) for moment in moments[:2]]
    moments[0] = max(moments[0], _LIFT * size)
    return moments, axes


def _round_up(moment: float) -> float:
    """Round up to twelve digits, by at most 1e-11 of the value."""
    short = float(f"{moment:.11e}")
    return short if short >= moment else float(f"{moment * (1 + 1e-11):.11e}")


def lift(tensor: SymmetricTensor) -> SymmetricTensor:
    """Return the nearest physically consistent tensor; zeros if almost nothing remains."""
    lifted = find_nearest_consistent(tensor)
    negligible = max(map(abs, lifted)) < ROUNDING * max(map(abs, tensor))
    return ZERO_TENSOR if negligible else lifted
