"""The choice of ``--fix-inertia``: what replaces a physically inconsistent inertia tensor."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from ...mechanics.repair import box_tensor, sphere_tensor
from ...mechanics.spatial_inertia import SpatialInertia
from ...mechanics.tensor import SymmetricTensor
from ...model.elements import Vector

FixInertia = Literal["none", "lift", "balance", "box"]
"""Reject it; the nearest consistent tensor; a sphere's of the same mean; a box's of its size."""

REPAIRS: tuple[FixInertia, ...] = ("none", "lift", "balance", "box")


def repair_tensor(
    fix: FixInertia,
    body: SpatialInertia,
    size: Callable[[], Vector | None],
    *,
    lift: Callable[[SymmetricTensor], SymmetricTensor],
) -> tuple[SymmetricTensor, str]:
    """Replace the inertia tensor of a body as the user chose.

    Args:
        fix: The choice; ``none`` lifts, for a writer that goes on without one.
        body: The body.
        size: Returns the edges [m] of the box around the geometry; None where there is none.
        lift: Returns the nearest consistent tensor, with the margin that a format needs.

    Returns:
        The tensor [kg·m²], and how it was made, for a message.
    """
    if fix == "box":
        edges = size()
        if edges is None:
            return lift(body.tensor), "it has no geometry for a box, so it is lifted"
        return box_tensor(body.mass, edges), "made that of a box around its geometry, changed"
    if fix == "balance":
        return sphere_tensor(body.tensor), "balanced"
    return lift(body.tensor), "lifted"
