"""Friction and contact parameters of rigid bodies."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ..model.elements import Robot
from ..model.settings import get_number


@dataclass(frozen=True)
class Surface:
    """Contact parameters of a body; None for values that the file does not set.

    Attributes:
        friction: Coulomb friction coefficient [–] in the first direction.
        stiffness: Contact stiffness [N/m].
        damping: Contact damping [N·s/m].
    """

    friction: float | None = None
    stiffness: float | None = None
    damping: float | None = None


def choose_surface(robot: Robot, links: Iterable[str]) -> Surface:
    """Return the contact parameters of a rigid body of several links.

    Engines have one set for a body: if its collisions differ, the smallest of each is used.
    """
    surfaces = [shape.surface for name in links for shape in robot.link[name].collisions]

    def least(name: str) -> float | None:
        values = (get_number(surface, name) for surface in surfaces)
        return min((v for v in values if v is not None and v >= 0), default=None)

    stiffness = least("contact_stiffness")
    return Surface(least("friction"), stiffness or None, least("contact_damping"))
