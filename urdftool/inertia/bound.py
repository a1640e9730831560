"""The spread of mass that fits into a box: the Bhatia–Davis bound.

Mass inside the interval [lo, hi] with its mean at c has a variance of at most (hi − c)(c − lo)
(Bhatia and Davis, "A Better Bound on the Variance", 2000), reached only by two lumps at the two
ends. The variance along an axis is the second moment Sᵤᵤ / m of the tensor, so a tensor beyond it
cannot belong to a body that lies within the box, whatever its material.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .tensor import Array, second_moment

BOX_MARGIN = 0.02
"""By how much the box is widened on every side, relative to its diagonal."""


def spread_ratio(
    mass: float,
    com: Sequence[float] | Array,
    inertia: Array,
    lower: Sequence[float] | Array,
    upper: Sequence[float] | Array,
    *,
    margin: float = BOX_MARGIN,
) -> Array:
    """The spread of mass along X, Y, Z, relative to the largest that fits into the box.

    A value above 1 is impossible for a body inside the box. Where the centre of mass itself lies
    outside the (widened) box, nothing fits and the value is infinite.

    Args:
        mass: Mass [kg], above zero.
        com: Centre of mass [m].
        inertia: Tensor [kg·m²] about the centre of mass, along the axes of the box.
        lower: Smallest corner of the box [m], in the same frame.
        upper: Largest corner of the box [m].
        margin: Widening of the box on every side, relative to its diagonal.
    """
    centre = np.asarray(com, dtype=np.float64)
    low, high = np.asarray(lower, dtype=np.float64), np.asarray(upper, dtype=np.float64)
    widening = margin * float(np.linalg.norm(high - low))
    room = (high + widening - centre) * (centre - low + widening)
    outside = (centre > high + widening) | (centre < low - widening)
    spread = np.diag(second_moment(inertia)) / mass
    ratio = np.full(3, np.inf)
    fits = ~outside & (room > 0)
    ratio[fits] = spread[fits] / room[fits]
    return ratio
