"""The left and the right of a robot: what they weigh."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...model.elements import Link, Robot
from ..rule import INFO, Problem, rule
from ..sides import twin_of


@rule(
    INFO,
    effects={
        "gz, gazebo-classic, mujoco, pybullet, pinocchio, drake": "take the two as written",
    },
)
def left_right_asymmetry(
    robot: Robot,
    *,
    mass_difference: float = 0.05,
    com_difference: float = 0.05,
    inertia_difference: float = 0.2,
) -> Iterator[Problem]:
    """A link and its mirror image differ in mass, centre of mass or inertia.

    They are told by their names, such as ``left_arm`` and ``right_arm``. One of the two was changed
    alone, or mistyped. What is compared does not depend on how their frames are turned: the mass,
    how far the centre of mass is from the frame, and the sum of the moments; each may differ by the
    part that its threshold says.
    """
    for link in robot.links:
        name = twin_of(link.name, robot.link)
        other = robot.link.get(name) if name else None
        if other is None or link.inertial is None or other.inertial is None:
            continue
        if link.mass <= 0 or other.mass <= 0:
            continue
        if _differ(link.mass, other.mass, mass_difference):
            yield Problem(
                other,
                f"link '{other.name}' weighs {other.mass:g} kg and '{link.name}' {link.mass:g} kg; "
                "mirror images weigh the same",
                at=other.inertial,
            )
            continue
        here, there = _com(link), _com(other)
        if _differ(here, there, com_difference) and abs(here - there) > 0.002:
            yield Problem(
                other,
                f"centre of mass of link '{other.name}' is {there:.3g} m from its frame and that "
                f"of '{link.name}' {here:.3g} m; mirror images have it at one distance",
                at=other.inertial.origin or other.inertial,
            )
            continue
        one, two = _spread(link), _spread(other)
        if one > 0 and two > 0 and _differ(one, two, inertia_difference):
            yield Problem(
                other,
                f"moments of inertia of link '{other.name}' are {two / one:.2g} times those of "
                f"'{link.name}', which is its mirror image",
                at=other.inertial.inertia or other.inertial,
            )


def _differ(one: float, other: float, part: float) -> bool:
    return abs(one - other) > part * max(abs(one), abs(other))


def _com(link: Link) -> float:
    """How far the centre of mass is from the frame of the link [m]."""
    origin = link.inertial.origin if link.inertial is not None else None
    return math.hypot(*origin.xyz) if origin is not None else 0.0


def _spread(link: Link) -> float:
    """The sum of the moments [kg·m²], which is the same in every frame."""
    inertia = link.inertial.inertia if link.inertial is not None else None
    return sum(inertia.moments) if inertia is not None else 0.0
