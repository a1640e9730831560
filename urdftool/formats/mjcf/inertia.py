"""Which tensors MuJoCo takes, and the three ways to mend one that no rigid body has.

Tensors are symmetric 3 × 3 arrays [kg·m²] about the centre of mass. MuJoCo refuses a model where
the two smaller principal moments do not add up to the largest, exactly, after its own
diagonalisation; a flat plate whose numbers were rounded to text fails by 1e-16.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

ROUNDING = 1e-9
"""Relative violation that rounding explains; it is raised away without a word."""

_SAFE = 1e-12
_LIFT = 2e-12


def excess(tensor: Array) -> float:
    """By how much the largest principal moment exceeds the others' sum, or a moment is negative.

    Relative to the largest moment by size; zero or negative for a tensor that a rigid body has.
    """
    low, middle, high = np.linalg.eigvalsh(tensor)
    size = max(abs(low), abs(high))
    if size == 0:
        return 0.0
    return float(max(high - low - middle, -low) / size)


def is_possible(tensor: Array) -> bool:
    """Whether a rigid body has it, up to rounding."""
    return bool(np.isfinite(tensor).all()) and excess(tensor) <= ROUNDING


def is_safe_diagonal(moments: Array) -> bool:
    """Whether MuJoCo takes these moments as they are."""
    a, b, c = (float(moment) for moment in moments)
    return min(a, b, c) >= 0 and a + b >= c and a + c >= b and b + c >= a


def is_safe_tensor(tensor: Array) -> bool:
    """Whether MuJoCo takes it whatever its diagonalisation rounds to."""
    low = np.linalg.eigvalsh(tensor)[0]
    return excess(tensor) < -_SAFE and low > _SAFE * abs(tensor).max()


def principal(tensor: Array) -> tuple[Array, Array]:
    """Principal moments, raised so far that MuJoCo takes them, and their axes as columns."""
    moments, axes = np.linalg.eigh(tensor)
    if np.linalg.det(axes) < 0:
        axes = axes * np.array([1.0, 1.0, -1.0])
    size = moments[2]
    moments = np.maximum(moments, 0.0)
    gap = moments[2] - moments[0] - moments[1]
    if gap > -_SAFE * size:
        moments[:2] += max(gap, 0.0) / 2 + _LIFT * size
        moments[:2] = [_rounded_up(moment) for moment in moments[:2]]
    moments[0] = max(moments[0], _LIFT * size)
    return moments, axes


def _rounded_up(moment: float) -> float:
    """The next number of twelve digits, which is above by at most 1e-11 of it."""
    short = float(f"{moment:.11e}")
    return short if short >= moment else float(f"{moment * (1 + 1e-11):.11e}")


def lift(tensor: Array) -> Array:
    """The nearest tensor that a body has: ∫ x xᵀ dm without its negative eigenvalues.

    A tensor is possible exactly where S = ½ tr(I) E − I has none (Wensing, Kim and Slotine 2018).
    """
    second = 0.5 * np.trace(tensor) * np.eye(3) - tensor
    values, axes = np.linalg.eigh(second)
    kept: Array = (axes * np.maximum(values, 0.0)) @ axes.T
    lifted: Array = np.trace(kept) * np.eye(3) - kept
    negligible = abs(lifted).max() < ROUNDING * abs(tensor).max()
    return np.zeros((3, 3)) if negligible else lifted


def balance(tensor: Array) -> Array:
    """A ball of the same mean moment, as MuJoCo's ``balanceinertia`` makes it."""
    balanced: Array = np.eye(3) * max(float(np.trace(tensor)) / 3, 0.0)
    return balanced


def box(mass: float, size: Array) -> Array:
    """A solid box of a mass [kg] and edges [m]."""
    x, y, z = size**2
    tensor: Array = np.diag([y + z, x + z, x + y]) * mass / 12
    return tensor


def moments_text(tensor: Array) -> str:
    """Principal moments for a message, ascending."""
    return ", ".join(f"{moment:.6g}" for moment in np.linalg.eigvalsh(tensor))
