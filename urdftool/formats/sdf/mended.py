"""The three ways to mend the inertia of a body that no rigid body has."""

from __future__ import annotations

import math

from ...model.pose import Rotation
from .mass import CLEAR, lifted, principal
from .translation import Translation


def mended(t: Translation, name: str) -> tuple[Rotation, str]:
    """The tensor that is written for a body, and how it was made, in words.

    Args:
        t: The export; without ``--fix-inertia`` it has been told to go on, and lifts.
        name: The link that has the whole body's mass.

    Returns:
        The tensor about the centre of mass, along the axes of the link [kg·m²].
    """
    mass, fix = t.plan.mass[name], t.options.fix_inertia
    if fix == "box":
        edges = _edges(t, name)
        if edges is None:
            return lifted(mass.tensor, CLEAR), "it has no geometry for a box, so it is lifted"
        xx, yy, zz = (edge * edge * mass.mass / 12 for edge in edges)
        tensor = _diagonal(yy + zz, xx + zz, xx + yy)
        return tensor, "made that of a box around its geometry, changed"
    if fix == "balance":
        mean = max(math.fsum(mass.tensor[k][k] for k in range(3)) / 3, 0.0)
        return _diagonal(mean, mean, mean), "balanced"
    return lifted(mass.tensor, CLEAR), "lifted"


def moments_text(tensor: Rotation) -> str:
    """Principal moments for a message, ascending."""
    return ", ".join(f"{moment:.6g}" for moment in principal(tensor)[0])


def _diagonal(xx: float, yy: float, zz: float) -> Rotation:
    return (xx, 0.0, 0.0), (0.0, yy, 0.0), (0.0, 0.0, zz)


def _edges(t: Translation, name: str) -> tuple[float, float, float] | None:
    """Edges [m] of the box around what touches of a body, or else around what is seen of it."""
    import numpy as np

    from ..common.extent import shape_points

    members = [t.robot.link[member] for member in t.plan.members[name]]
    for kind in ("collisions", "visuals"):
        found = []
        for link in members:
            pose = t.plan.in_owner[link.name]
            for shape in getattr(link, kind):
                points = shape_points(t.robot, shape)
                if points is not None:
                    found.append(points @ np.array(pose.rotation).T + np.array(pose.translation))
        if found:
            x, y, z = np.ptp(np.concatenate(found), axis=0).tolist()
            return x, y, z
    return None
