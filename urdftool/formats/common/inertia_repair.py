"""Repair of physically inconsistent inertia tensors, as ``--fix-inertia`` selects it."""

from __future__ import annotations

from collections.abc import Callable

from ...mechanics.repair import compute_box_tensor, compute_sphere_tensor
from ...mechanics.spatial_inertia import SpatialInertia
from ...mechanics.tensor import SymmetricTensor
from ...model.elements import Vector
from .option import FixInertia


def repair_tensor(
    fix: FixInertia,
    body: SpatialInertia,
    size: Callable[[], Vector | None],
    *,
    lift: Callable[[SymmetricTensor], SymmetricTensor],
) -> tuple[SymmetricTensor, str]:
    """Repair the inertia tensor of a body by the method that the user chose.

    Args:
        fix: The method; ``none`` lifts, for a writer that continues in spite of the defect.
        body: The body.
        size: Returns the edges [m] of the bounding box of the geometry; None without geometry.
        lift: Returns the nearest consistent tensor, with the margin that a format needs.

    Returns:
        The tensor [kg·m²], and a description of the method for a message.
    """
    if fix == "box":
        edges = size()
        if edges is None:
            return lift(
                body.tensor
            ), "it has no geometry for a box, so its smallest moments are increased"
        return compute_box_tensor(
            body.mass, edges
        ), "replaced by the inertia of a box around its geometry, and changed"
    if fix == "balance":
        return compute_sphere_tensor(body.tensor), "balanced"
    return lift(body.tensor), "lifted"
