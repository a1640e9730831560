"""Whether a mass can be where it is written: inside the box around the shapes, and so spread.

Mass within an interval [lo, hi] with its mean at c has a variance of at most (hi − c)(c − lo)
(Bhatia and Davis, "A Better Bound on the Variance", 2000), reached only by two lumps at the two
ends. The variance along an axis is the second moment ½ tr(I) − Iₐₐ over the mass. A tensor beyond
that cannot belong to a body that lies within the box, whatever its material. The bound grows with
the square of the length, so the root of the ratio says how many times as long the box would have to
be.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from ..model.bounds import Bounds
from ..model.elements import Vector
from .tensor import SymmetricTensor

ALLOWED = 1.1
"""By how much the variance may exceed what the box allows; twice as much of a mesh."""

CERTAIN = 10.0
"""By how much it has to exceed the box around a mesh, which may leave out what is heavy."""

ROUNDING = 0.01
"""Part of ½ tr(I) that is allowed in addition: of a plate the difference is lost in rounding."""

NEAR = 0.1
"""Part of the length by which a center of mass is from an end, as far as the spread is judged."""

MARGIN = 0.02
"""Part of the box's diagonal by which a center of mass may be outside; of a mesh twice that."""


class Misfit(NamedTuple):
    """A mass that cannot be where it is written.

    Attributes:
        sentence: What is wrong, without whose it is: ``is 0.3 m outside its shapes along x …``.
        axis: Along which axis it is worst: 0, 1 or 2.
        amount: How far outside [m], or how many times as long the shapes would have to be.
        certain: Whether it is wrong; else a mesh may leave out what is heavy.
    """

    sentence: str
    axis: int
    amount: float
    certain: bool


def shapes_in_words(attached: Iterable[str], shown: int = 2) -> str:
    """Name the shapes in the box around a link: its own, and those of the attached links."""
    names = [f"'{name}'" for name in attached]
    if not names:
        return "its shapes"
    more = f" and {len(names) - shown} more" if len(names) > shown else ""
    return f"its shapes and those of {', '.join(names[:shown])}{more}"


def spread_ratio(
    box: Bounds, mass: float, com: Vector, tensor: SymmetricTensor, rounding: float = ROUNDING
) -> tuple[float, int]:
    """Compare the variance of a mass with the largest that fits into a box.

    Args:
        box: The box around the body's shapes [m].
        mass: Mass [kg], above zero.
        com: Center of mass [m].
        tensor: Inertia about the center of mass, along the axes of the box [kg·m²].
        rounding: Part of ½ tr(I) that is allowed in addition.

    Returns:
        By how much the variance exceeds it, and along which axis that is worst. Above 1 is
        impossible; 0 along an axis on which the center of mass is outside.
    """
    xx, _, _, yy, _, zz = tensor
    half_trace = (xx + yy + zz) / 2
    worst = (0.0, 0)
    for i, moment in enumerate((xx, yy, zz)):
        room = _room(box, com, i) * mass
        if room > 0:
            worst = max(worst, ((half_trace - moment) / (room + rounding * half_trace), i))
    return worst


def _room(box: Bounds, com: Vector, axis: int) -> float:
    """Return the largest variance [m²] of a mass in a box; 0 where its center is outside.

    A center that is very near to an end counts as a tenth of the length away from it: where it is
    wrong it is the center that is, and not the spread.
    """
    low, high, center = box[0][axis], box[1][axis], com[axis]
    if not low <= center <= high:
        return 0.0
    near = NEAR * (high - low)
    center = min(max(center, low + near), high - near)
    return (high - center) * (center - low)


def misfit_of_spread(
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
    """Judge how far the mass of a body is spread; None where its shapes allow it.

    Args:
        box: The box around the body's shapes [m].
        mass: Mass [kg].
        com: Center of mass [m].
        tensor: Inertia about the center of mass, along the axes of the box [kg·m²].
        rough: Whether the shapes may differ from the body: a mesh may leave out what sticks out,
            and visuals without a collision may be markers.
        allowed: By how much the variance may exceed what the box allows; twice that of rough ones.
        certain: By how much it has to exceed the box of rough shapes to be wrong.
        rounding: As for :func:`spread_ratio`.
        shapes: The shapes in the box, in words.
    """
    ratio, axis = spread_ratio(box, mass, com, tensor, rounding)
    if ratio <= allowed * (2 if rough else 1):
        return None
    low, high = box[0][axis], box[1][axis]
    moments = tensor[0], tensor[3], tensor[5]
    times = math.sqrt((sum(moments) / 2 - moments[axis]) / (_room(box, com, axis) * mass))
    sentence = (
        f"is only possible if {shapes} were {times:.3g} times as long along {'xyz'[axis]}, where "
        f"they span {low:.4g} to {high:.4g} m"
    )
    return Misfit(sentence, axis, times, not rough or ratio > certain)


def misfit_of_com(
    box: Bounds,
    com: Vector,
    has_mesh: bool,
    *,
    margin: float = MARGIN,
    shapes: str = "its shapes",
) -> Misfit | None:
    """Judge where the center of mass of a body is; None where it is inside the box.

    Args:
        box: The box around the body's shapes [m].
        com: Center of mass [m].
        has_mesh: Whether a shape of it is a mesh, which often shows the cover and not the motor;
            then it is wrong only beyond half a diagonal.
        margin: Part of the box's diagonal that is allowed outside; of a mesh twice that.
        shapes: The shapes in the box, in words.
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
