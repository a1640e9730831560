"""Conditions that mass properties must fulfill before they are used or written."""

from __future__ import annotations

import math
from collections.abc import Iterable

from ..mechanics import spatial_inertia
from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import ROUNDING, format_moments_text, measure_consistency
from .inertia_error import InertiaError


def is_consistent(properties: SpatialInertia, *, tolerance: float = ROUNDING) -> bool:
    """Tell whether mass properties are finite, physically consistent and have some inertia.

    Args:
        properties: Mass properties.
        tolerance: Allowed excess over the triangle inequality, relative to the largest principal
            moment.
    """
    if not properties.is_finite:
        return False
    found = measure_consistency(properties.tensor)
    return found.size > 0 and found.excess <= tolerance and found.negativity <= ROUNDING


def require_consistent(properties: SpatialInertia, what: str = "the result") -> SpatialInertia:
    """Return the argument if it is physically consistent.

    Raises:
        InertiaError: The mass is not above zero, or the tensor violates positivity or the triangle
            inequality.
    """
    if not (math.isfinite(properties.mass) and properties.mass > 0):
        raise InertiaError(f"{what} would have {properties.mass:g} kg; the mass must be above zero")
    if not is_consistent(properties):
        moments = "not finite"
        if all(map(math.isfinite, properties.tensor)):
            moments = format_moments_text(properties.tensor)
        raise InertiaError(
            f"{what} has a physically inconsistent inertia: principal moments {moments} kg·m², of "
            "which each must be positive and none larger than the sum of the other two"
        )
    return properties


def combine(bodies: Iterable[SpatialInertia]) -> SpatialInertia:
    """Combine bodies in one frame into one rigid body with a mass above zero.

    Raises:
        InertiaError: No body is given, or the total mass is not above zero.
    """
    pieces = list(bodies)
    whole = spatial_inertia.combine(pieces)
    if not whole.mass > 0:
        raise InertiaError(
            f"the {len(pieces)} bodies have {whole.mass:g} kg in total; a center of mass "
            "requires mass"
        )
    return whole
