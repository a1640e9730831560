"""Attributes of PhysX on joints, in the units of its schemas.

Angular velocities are per degree, and so is viscous friction. A mimic joint of PhysX satisfies
``position + gearing · leader + offset = 0``, with the offset in degrees
(``InternalMimicJoint.cpp`` of NVIDIA-Omniverse/PhysX).
"""

from __future__ import annotations

from collections.abc import Mapping

from pxr import Sdf, Usd

from ...model.settings import OF_LIMITS, RESISTANCE
from .stage import apply, set_targets, set_value

_NAMES = {row.usd.partition(":")[2]: row.physx for row in (*OF_LIMITS, *RESISTANCE) if row.physx}
"""Attributes of PhysX for each of ``NewtonJointAPI``; releases before ``PhysxJointAxisAPI`` read
those of ``PhysxJointAPI``."""


def write_physx_values(
    prim: Usd.Prim, drive: str, values: Mapping[str, float], *, old_names: bool
) -> None:
    """Write values of Newton's schema in the schemas of PhysX."""
    apply(prim, f"PhysxJointAxisAPI:{drive}")
    for name, value in values.items():
        for attribute in _NAMES[name]:
            is_old = attribute.startswith("physxJoint:")
            if is_old and old_names:
                apply(prim, "PhysxJointAPI")
            if old_names or not is_old:
                set_value(prim, attribute.replace("*", drive), "float", value)


def write_physx_mimic(prim: Usd.Prim, leader: Sdf.Path, gearing: float, offset: float) -> None:
    """Write a mimic joint for releases of PhysX that do not read ``NewtonMimicAPI``.

    Args:
        prim: The follower, with one degree of freedom, so that any axis names it.
        leader: Path of the leader.
        gearing: Factor, with its sign changed; per degree if only one of the joints is angular.
        offset: Offset [degree or m], with its sign changed.
    """
    apply(prim, "PhysxMimicJointAPI:rotX")
    prefix = "physxMimicJoint:rotX"
    set_targets(prim, f"{prefix}:referenceJoint", [leader])
    set_value(prim, f"{prefix}:referenceJointAxis", "token", "rotX", uniform=True)
    set_value(prim, f"{prefix}:gearing", "float", gearing)
    set_value(prim, f"{prefix}:offset", "float", offset)
