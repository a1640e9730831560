"""The inertia tensors of a robot, as far as they can be judged."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.elements import Inertia, Inertial, Link, Robot, Vector
from ...model.read import number
from ...model.tensor3 import SMALLEST_RADIUS, Six, eigenvalues

SIX = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def six_of(inertia: Inertia) -> Six:
    """Its six numbers."""
    return inertia.six


def tensors(robot: Robot) -> Iterator[tuple[Link, Inertial, Six]]:
    """Links with mass and six numbers that are written and can be read.

    A tensor of which a number is missing or unreadable is another matter, and so is one without
    mass; those are left out.
    """
    for link in robot.links:
        inertial = link.inertial
        if inertial is None or not inertial.mass or inertial.inertia is None:
            continue
        six = six_of(inertial.inertia)
        if 0.0 in six:
            attributes = inertial.inertia.element.attributes
            zeros = (name for name, value in zip(SIX, six, strict=True) if value == 0.0)
            if any(number(attributes.get(name)) is None for name in zeros):
                continue
        yield link, inertial, six


def moments_of(six: Six) -> Vector:
    """Principal moments, ascending."""
    return eigenvalues(six)


def is_zero(six: Six, mass: float) -> bool:
    """Whether all six are 0, but for the noise of whatever computed them.

    Args:
        six: The six numbers [kg·m²].
        mass: The body's mass [kg]; what is below it times (10 µm)² is noise.
    """
    return max(map(abs, six)) <= abs(mass) * SMALLEST_RADIUS**2


def is_positive(moments: Vector, tolerance: float = 1e-6) -> bool:
    """Whether no principal moment is negative, but for rounding."""
    low, _, high = moments
    return low >= -tolerance * max(abs(low), abs(high))
