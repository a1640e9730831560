"""Find links without mass whose rigid body is too light for their size."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...model.attached import is_fixed_to_world
from ...model.elements import Link, Robot
from ..mesh.link_extents import get_extents
from .bodies import compute_mass

_AIR = 1.2
"""Density [kg/m³] of air at 20 °C (ISO 2533 has 1.225 at 15 °C); chosen as the least of a robot."""


class LightBody(NamedTuple):
    """The rigid body of a link without mass.

    Attributes:
        mass: Mass of the links that are fixed to it [kg].
        density: That mass in the bounding box of the link [kg/m³].
    """

    mass: float
    density: float

    def describe(self) -> str:
        """Write the mass and density of the body."""
        return f"have only {self.mass:g} kg together, {self.density:.2g} kg/m³ of its bounding box"


def find_light_body(robot: Robot, link: Link, links: list[Link]) -> LightBody | None:
    """Find the body of a link without mass; None unless it has a mass that is too small."""
    mass = compute_mass(links)
    if mass <= 0 or not robot.moving_joints or is_fixed_to_world(robot, link):
        return None
    box = get_extents(robot).get_link_box(link)
    volume = math.prod(box.size) if box is not None else 0.0
    if volume <= 0 or mass >= _AIR * volume:
        return None
    return LightBody(mass, mass / volume)
