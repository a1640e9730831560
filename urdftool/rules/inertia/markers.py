"""Find out which links are markers and stands, whose density says nothing."""

from __future__ import annotations

import math

from ...model.elements import Link, Robot
from ..mesh.link_extents import get_extents
from .solids import compute_solid_moments


def is_marker(robot: Robot, link: Link, mass: float, small: float, marker: float) -> bool:
    """Tell whether the shape of a link that is not a root only marks its place.

    It is at most ``marker`` [m] large, or smaller than ``small`` [m] and fixed to much heavier
    links.
    """
    reach = get_extents(robot)
    box = reach.get_link_box(link)
    if box is None or max(box.size) >= small:
        return False
    if max(box.size) <= marker * _ROUNDING and robot.tree.get_parent_joint(link.name) is not None:
        return True
    return sum(other.mass for other, _ in reach.get_attached(link)[1:]) >= 10 * mass


def is_anchor(robot: Robot, link: Link) -> bool:
    """Tell whether a root of a round mass, from which its inertia was computed, is a stand."""
    if robot.tree.get_parent_joint(link.name) is not None or link.mass < _HEAVY_STAND:
        return False
    power = math.log10(link.mass)
    solid, inertial = compute_solid_moments(link), link.inertial
    if abs(power - round(power)) > 1e-9 or solid is None or inertial is None:
        return False
    written = inertial.inertia.moments if inertial.inertia is not None else ()
    return bool(written) and all(
        0.5 * right <= one <= 2 * right for one, right in zip(written, solid, strict=True)
    )


_ROUNDING = 1 + 1e-6
"""Factor, because the box of a rotated shape is subject to rounding."""

_HEAVY_STAND = 100.0
"""[kg] A root of this mass and more is a stand if its mass is a power of ten. Chosen, no source."""
