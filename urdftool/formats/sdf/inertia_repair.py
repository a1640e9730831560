"""Repair of physically inconsistent inertia tensors."""

from __future__ import annotations

from functools import partial

from ...mechanics.repair import find_nearest_consistent
from ...mechanics.tensor import SymmetricTensor
from ...model.elements import Vector
from ..common.inertia_repair import repair_tensor
from .translation import Translation

CLEAR = 1e-6
"""Margin of a repaired tensor, relative to its largest moment, so that every reader accepts it."""


def repair_inertia(t: Translation, name: str) -> tuple[SymmetricTensor, str]:
    """Repair the inertia tensor of a body.

    Args:
        t: The export.
        name: The link that owns the body.

    Returns:
        The tensor about the center of mass, along the axes of the link [kg·m²], and a description
        of the method for a message.
    """
    members = t.plan.members[name]

    def measure_box() -> Vector | None:
        from ..common.extent import compute_box_size  # numpy, only for bodies that need it

        return compute_box_size(t.robot, ((t.robot.link[m], t.plan.in_owner[m]) for m in members))

    return repair_tensor(
        t.options.fix_inertia,
        t.plan.mass[name],
        measure_box,
        lift=partial(find_nearest_consistent, margin=CLEAR),
    )
