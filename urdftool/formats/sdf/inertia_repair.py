"""The repair of an inertia that is physically inconsistent."""

from __future__ import annotations

import math

from ...model.elements import Vector
from ...model.pose import Rotation
from ..common.extent import box_size
from ..common.inertia_repair import repair_tensor
from .mass import CLEAR, lifted, principal
from .translation import Translation


def repair_inertia(t: Translation, name: str) -> tuple[Rotation, str]:
    """Choose the tensor that is written for a body.

    Args:
        t: The export.
        name: The link that has the whole body's mass.

    Returns:
        The tensor about the center of mass, along the axes of the link [kg·m²], and how it was
        made, for a message.
    """
    mass = t.plan.mass[name]

    def balance() -> Rotation:
        mean = max(math.fsum(mass.tensor[k][k] for k in range(3)) / 3, 0.0)
        return _diagonal(mean, mean, mean)

    def box(edges: Vector) -> Rotation:
        xx, yy, zz = (edge * edge * mass.mass / 12 for edge in edges)
        return _diagonal(yy + zz, xx + zz, xx + yy)

    members = t.plan.members[name]
    return repair_tensor(
        t.options.fix_inertia,
        lambda: box_size(t.robot, ((t.robot.link[m], t.plan.in_owner[m]) for m in members)),
        lift=lambda: lifted(mass.tensor, CLEAR),
        balance=balance,
        box=box,
    )


def moments_text(tensor: Rotation) -> str:
    """Principal moments for a message, ascending."""
    return ", ".join(f"{moment:.6g}" for moment in principal(tensor)[0])


def _diagonal(xx: float, yy: float, zz: float) -> Rotation:
    return (xx, 0.0, 0.0), (0.0, yy, 0.0), (0.0, 0.0, zz)
