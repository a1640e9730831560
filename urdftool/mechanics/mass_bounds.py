"""Physical bounds on a mass distribution: is the written inertial possible within its geometry?

Mass within an interval [lo, hi] with its mean at c has a variance of at most (hi − c)(c − lo)
(Bhatia and Davis, "A Better Bound on the Variance", 2000), reached only by two point masses at the
ends. The variance along an axis is the second moment ½ tr(I) − Iₐₐ divided by the mass. A tensor
beyond that bound cannot belong to a body inside the bounding box, at any density. With c in
the middle the bound is largest, a quarter of the length squared: no shorter box can hold the mass,
for any center of mass.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from ..listing import quote_first
from ..model.bounds import Bounds
from ..model.elements import Vector
from .tensor import SymmetricTensor

ALLOWED = 1.1
"""Largest allowed ratio of the variance to the bound of the box; doubled for meshes."""

CERTAIN = 10.0
"""Ratio above which even the bounding box of a mesh, which may omit heavy parts, rules a tensor
out."""

ROUNDING = 0.01
"""Part of ½ tr(I) that is tolerated in addition: rounding hides the second moment of a thin
plate."""

NEAR = 0.1
"""Part of the box's length by which the center of mass counts as away from the ends of the box."""

SHORTEST = 1.05
"""Least factor that a message states; below it the center of mass, near an end, is the reason.
Chosen."""

MARGIN = 0.02
"""Part of the box's diagonal by which the center of mass may lie outside; doubled for meshes."""


class Misfit(NamedTuple):
    """A mass distribution that does not fit into the bounding box of the geometry.

    Attributes:
        sentence: The fact without its subject: ``is 0.3 m outside its shapes along x …``.
        axis: Axis of the largest deviation: 0, 1 or 2.
        amount: Distance outside the box [m], or the least factor by which the geometry would have
            to be longer, for any center of mass.
        certain: Whether it is physically impossible; if not, a mesh may omit heavy parts.
    """

    sentence: str
    axis: int
    amount: float
    certain: bool


def name_shapes(attached: Iterable[str], shown: int = 2) -> str:
    """Name the shapes in the bounding box of a link: its own, and those of attached links."""
    names = list(attached)
    return f"its shapes and those of {quote_first(names, shown)}" if names else "its shapes"


def spread_ratio(
    box: Bounds, mass: float, com: Vector, tensor: SymmetricTensor, rounding: float = ROUNDING
) -> tuple[float, int]:
    """Compute the ratio of the variance of a mass to the largest that fits into a box.

    Args:
        box: Bounding box of the body's shapes [m].
        mass: Mass [kg], above zero.
        com: Center of mass [m].
        tensor: Inertia about the center of mass, along the axes of the box [kg·m²].
        rounding: Part of ½ tr(I) that is tolerated in addition.

    Returns:
        The largest ratio and its axis. A ratio above 1 is impossible. An axis on which the center
        of mass is outside the box is skipped; if all are, the ratio is 0.
    """
    xx, _, _, yy, _, zz = tensor
    half_trace = (xx + yy + zz) / 2
    worst = (0.0, 0)
    for i, moment in enumerate((xx, yy, zz)):
        room = _get_largest_variance(box, com, i) * mass
        if room > 0:
            worst = max(worst, ((half_trace - moment) / (room + rounding * half_trace), i))
    return worst


def _get_largest_variance(box: Bounds, com: Vector, axis: int) -> float:
    """Return the largest variance [m²] of a mass in a box; 0 if its center is outside.

    A center near an end of the box is moved to ``NEAR`` of the length from it: there the center of
    mass is suspect, not the variance.
    """
    low, high, center = box[0][axis], box[1][axis], com[axis]
    if not low <= center <= high:
        return 0.0
    near = NEAR * (high - low)
    center = min(max(center, low + near), high - near)
    return (high - center) * (center - low)


def check_spread(
    box: Bounds,
    mass: float,
    com: Vector,
    tensor: SymmetricTensor,
    rough: bool,
    *,
    allowed: float = ALLOWED,
    certain: float = CERTAIN,
    rounding: float = ROUNDING,
    shapes: str = "its shapes",
) -> Misfit | None:
    """Check the variance of a mass against its bounding box; return None if it fits.

    Args:
        box: Bounding box of the body's shapes [m].
        mass: Mass [kg].
        com: Center of mass [m].
        tensor: Inertia about the center of mass, along the axes of the box [kg·m²].
        rough: Whether the shapes may differ from the body: a mesh may omit protruding parts, and
            visuals without a collision may be markers.
        allowed: Largest allowed ratio of the variance to the bound; doubled for rough shapes.
        certain: Ratio above which rough shapes rule the tensor out, too.
        rounding: Part of ½ tr(I) that is tolerated, see :func:`spread_ratio`.
        shapes: Name of the shapes in the box, for the message.
    """
    ratio, axis = spread_ratio(box, mass, com, tensor, rounding)
    if ratio <= allowed * (2 if rough else 1):
        return None
    low, high, name = box[0][axis], box[1][axis], "xyz"[axis]
    moments = tensor[0], tensor[3], tensor[5]
    spread = math.sqrt((sum(moments) / 2 - moments[axis]) / mass)
    times = 2 * spread / (high - low)
    if times >= SHORTEST:
        sentence = (
            f"would be possible only if {shapes} were at least {times:.3g} times as long along "
            f"{name}, where they span {low:.4g} to {high:.4g} m"
        )
    else:
        sentence = (
            f"is possible only with mass outside {shapes} along {name}, where they span {low:.4g} "
            f"to {high:.4g} m and the center of mass is at {com[axis]:.4g} m"
        )
    return Misfit(sentence, axis, times, not rough or ratio > certain)


def check_com(
    box: Bounds,
    com: Vector,
    has_mesh: bool,
    *,
    margin: float = MARGIN,
    shapes: str = "its shapes",
) -> Misfit | None:
    """Check the center of mass against its bounding box; return None if it is inside.

    Args:
        box: Bounding box of the body's shapes [m].
        com: Center of mass [m].
        has_mesh: Whether a shape is a mesh, which often covers the housing but not the motor; then
            only a distance of at least half a diagonal is certainly wrong.
        margin: Part of the box's diagonal that is tolerated outside; doubled for meshes.
        shapes: Name of the shapes in the box, for the message.
    """
    diagonal = math.dist(*box)
    slack = margin * diagonal * (2 if has_mesh else 1)
    outside = [
        (max(low - value, value - high), axis)
        for axis, (low, value, high) in enumerate(zip(box.low, com, box.high, strict=True))
        if not low - slack <= value <= high + slack
    ]
    if not outside:
        return None
    distance, axis = max(outside)
    sentence = (
        f"is {distance:.3g} m outside {shapes} along {'xyz'[axis]}, where they span "
        f"{box.low[axis]:.4g} to {box.high[axis]:.4g} m"
    )
    return Misfit(sentence, axis, distance, not has_mesh or distance >= diagonal / 2)
