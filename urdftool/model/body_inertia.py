"""The mass properties of links that are one rigid body, added up."""

from __future__ import annotations

from typing import NamedTuple

from .attached import Attached
from .elements import ZERO, Vector
from .pose import pose_of
from .tensor3 import SMALLEST_RADIUS, Six, eigenvalues, turned

_NO_INERTIA: Six = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class BodyInertia(NamedTuple):
    """The mass properties of several links together, in the frame of the first.

    Attributes:
        mass: [kg].
        com: Center of mass [m].
        tensor: About the center of mass [kg·m²].
    """

    mass: float
    com: Vector
    tensor: Six

    @property
    def is_thin(self) -> bool:
        """Whether the body has no inertia about some axis, but for rounding."""
        return eigenvalues(self.tensor)[0] <= self.mass * SMALLEST_RADIUS**2


def combined_inertia(members: Attached) -> BodyInertia:
    """Add up the written mass properties of links that are rigidly attached to each other.

    Links without a mass, and those of a negative one, are left out; a tensor that is not written
    counts as zero. By the parallel axis theorem.

    Args:
        members: Links with their poses in one frame.
    """
    parts: list[tuple[float, Vector, Six]] = []
    for link, pose in members:
        inertial = link.inertial
        if inertial is None or not inertial.mass or inertial.mass < 0:
            continue
        at = pose @ pose_of(inertial.origin)
        six = inertial.inertia.six if inertial.inertia is not None else _NO_INERTIA
        parts.append((inertial.mass, at.translation, turned(six, at.rotation)))
    mass = sum(part[0] for part in parts)
    if not mass:
        return BodyInertia(0.0, ZERO, _NO_INERTIA)
    a, b, c = (sum(m * at[i] for m, at, _ in parts) / mass for i in range(3))
    total = _NO_INERTIA
    for m, centre, (xx, xy, xz, yy, yz, zz) in parts:
        x, y, z = centre[0] - a, centre[1] - b, centre[2] - c
        total = (
            total[0] + xx + m * (y * y + z * z),
            total[1] + xy - m * x * y,
            total[2] + xz - m * x * z,
            total[3] + yy + m * (x * x + z * z),
            total[4] + yz - m * y * z,
            total[5] + zz + m * (x * x + y * y),
        )
    return BodyInertia(mass, (a, b, c), total)
