"""Get the inertia tensors of a robot that can be checked."""

from __future__ import annotations

import math
from collections.abc import Iterator
from decimal import Decimal, InvalidOperation

from ...mechanics.tensor import (
    ROUNDING,
    SymmetricTensor,
    compute_principal_moments,
    get_noise,
    measure_consistency,
)
from ...model.elements import Inertia, Inertial, Link, Robot
from ...model.link import COMPONENTS
from ...model.read import number
from .bodies import compute_body_inertia, find_rigid_bodies

SIX = COMPONENTS


def get_tensors(robot: Robot) -> Iterator[tuple[Link, Inertial, SymmetricTensor]]:
    """Get links with mass and six readable components, each with its inertial and tensor.

    Missing or unreadable components, and tensors without mass, are left to other rules. Tensors
    that SDF or MuJoCo supplies are left out.
    """
    return iter(robot.memo.get(get_tensors, lambda: list(_find_tensors(robot))))


def _find_tensors(robot: Robot) -> Iterator[tuple[Link, Inertial, SymmetricTensor]]:
    for link in robot.links:
        inertial = link.inertial
        if inertial is None or not inertial.mass or inertial.inertia is None:
            continue
        if not has_written_tensor(robot, link):
            continue
        six = inertial.inertia.six
        if 0.0 in six:
            tensor = inertial.inertia.xml
            attributes = {} if tensor is None else tensor.attributes
            zeros = (name for name, value in zip(SIX, six, strict=True) if value == 0.0)
            if tensor is not None and any(number(attributes.get(n)) is None for n in zeros):
                continue
        yield link, inertial, six


def has_written_tensor(robot: Robot, link: Link) -> bool:
    """Tell whether a tensor is written, and is not a default of SDF or inferred by MuJoCo.

    Readers of SDF give a default the place of the ``<inertial>`` that lacks ``<inertia>``.
    """
    if not has_written_inertial(robot, link) or link.inertial is None:
        return False
    tensor = link.inertial.inertia
    return tensor is not None and (robot.format != "sdf" or tensor.place != link.inertial.place)


def has_written_inertial(robot: Robot, link: Link) -> bool:
    """Tell whether an ``<inertial>`` is written.

    Readers of SDF and MJCF give a default or inferred inertial the place of its link. The reader
    of USD adds none.
    """
    inertial = link.inertial
    written = robot.format in ("urdf", "usd")
    return inertial is not None and (written or inertial.place != link.place)


def is_zero(six: SymmetricTensor, mass: float) -> bool:
    """Tell whether all six components are 0, except for numerical noise.

    Args:
        six: The six numbers [kg·m²].
        mass: The body's mass [kg]; numbers below it times (10 µm)² are noise.
    """
    return max(map(abs, six)) <= get_noise(mass)


def is_positive(six: SymmetricTensor, tolerance: float = ROUNDING) -> bool:
    """Tell whether no principal moment is negative, except for rounding."""
    return measure_consistency(six).negativity <= tolerance


EXACT = 1e-12
"""Relative error of computed principal moments, above which Gazebo and MuJoCo, which have no
tolerance, reject a tensor. Chosen, no source."""


def is_accepted(six: SymmetricTensor) -> bool:
    """Tell whether Gazebo and MuJoCo accept a tensor: positive, triangle inequality satisfied."""
    found = measure_consistency(six)
    return found.negativity < -EXACT and found.excess <= EXACT


_LEAST_IN_MUJOCO = 1e-14
"""Moment [kg·m²] below which MuJoCo 4.0 rejects a link, even if it is fixed to others."""


def is_rejected_by_mujoco(six: SymmetricTensor) -> bool:
    """Tell whether MuJoCo rejects the file for a principal moment of a link.

    MuJoCo reads every link, the root too, before it merges those fixed together. At this point it
    treats six zeros as no inertia.

    Args:
        six: The six numbers [kg·m²].
    """
    return any(six) and compute_principal_moments(six)[0] < _LEAST_IN_MUJOCO


def has_inertia_that_mujoco_rejects(robot: Robot) -> bool:
    """Tell whether a link, with or without mass, has an inertia that is zero about an axis."""
    return any(
        is_rejected_by_mujoco(link.inertial.inertia.six)
        for link in robot.links
        if link.inertial is not None and link.inertial.inertia is not None
    )


def is_rejected_by_gazebo(robot: Robot, link: Link) -> bool:
    """Tell whether Gazebo rejects the inertia of a link after lumping fixed joints."""
    whole = next((links for links in find_rigid_bodies(robot).values() if link in links), None)
    if whole is None:
        joint = robot.tree.get_parent_joint(link.name)
        if joint is not None and joint.is_fixed:
            return False  # a broken tree does not determine the body
        whole = [link]
    return measure_consistency(compute_body_inertia(robot, whole).tensor).excess > EXACT


def compute_rounding(inertia: Inertia) -> float:
    """Compute how far rounding may raise the largest moment above the others' sum [kg·m²].

    Each component may be off by half a unit of its last digit, and each moment by the norm of that.
    """
    written = {} if inertia.xml is None else inertia.xml.attributes
    halves = [_compute_half_digit(written.get(name, "")) for name in SIX]
    xx, xy, xz, yy, yz, zz = halves
    norm = math.hypot(xx, yy, zz, *(math.sqrt(2) * part for part in (xy, xz, yz)))
    return 2 * norm + xx + yy + zz


def _compute_half_digit(text: str) -> float:
    """Compute half a unit of the last digit of a number as written; 0 for exactly 0."""
    try:
        value = Decimal(text.strip())
    except InvalidOperation:
        return 0.0
    exponent = value.as_tuple().exponent
    return 0.5 * 10.0**exponent if value and isinstance(exponent, int) else 0.0
