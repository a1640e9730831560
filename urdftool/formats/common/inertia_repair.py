"""The choice of ``--fix-inertia``: what replaces a physically inconsistent inertia tensor."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, TypeVar

from ...model.elements import Vector

FixInertia = Literal["none", "lift", "balance", "box"]
"""Reject it; the nearest consistent tensor; a sphere's of the same mean; a box's of its size."""

REPAIRS: tuple[FixInertia, ...] = ("none", "lift", "balance", "box")

Tensor = TypeVar("Tensor")


def repair_tensor(
    fix: FixInertia,
    size: Callable[[], Vector | None],
    *,
    lift: Callable[[], Tensor],
    balance: Callable[[], Tensor],
    box: Callable[[Vector], Tensor],
) -> tuple[Tensor, str]:
    """Replace an inertia tensor as the user chose.

    Args:
        fix: The choice; ``none`` lifts, for a writer that goes on without one.
        size: Returns the edges [m] of the box around the geometry; None where there is none.
        lift: Returns the nearest consistent tensor.
        balance: Returns the tensor of a sphere with the same mean moment.
        box: Returns the tensor of a solid box with these edges.

    Returns:
        The tensor, and how it was made, for a message.
    """
    if fix == "box":
        edges = size()
        if edges is None:
            return lift(), "it has no geometry for a box, so it is lifted"
        return box(edges), "made that of a box around its geometry, changed"
    if fix == "balance":
        return balance(), "balanced"
    return lift(), "lifted"
