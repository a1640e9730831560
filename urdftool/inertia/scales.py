"""What links weigh and how their mass lies, for those who fill in what is missing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..errors import UrdftoolError
from ..model.elements import Robot
from .masses import Masses
from .mesh_files import read_meshes
from .review import review
from .tensor import six_numbers


class Scales:
    """Weighs links at one density; a mesh is read once, however often it is asked for."""

    def __init__(self, density: float) -> None:
        """Weigh at a density [kg/m³]."""
        self.density = density
        self.known: dict[tuple[str, str], Any] = {}

    def __call__(self, robot: Robot, names: Sequence[str]) -> dict[str, tuple[float, Any, Any]]:
        """Mass, centre and tensor of links, in the link frame."""
        description = robot.source
        assert description is not None

        def read(wanted: Sequence[str]) -> dict[str, Any]:
            new = [name for name in wanted if (description.path, name) not in self.known]
            for name, body in read_meshes(description, new, jobs=1).items():
                self.known[description.path, name] = body
            return {name: self.known[description.path, name] for name in wanted}

        links = [robot.link[name] for name in names]
        return _weighed(Robot(robot.element, robot.name, links=links), read, self.density)


def _weighed(robot: Robot, read: Any, density: float) -> dict[str, tuple[float, Any, Any]]:
    try:
        found = review(robot, read, masses=Masses(density=density, anew=True))
    except UrdftoolError:
        return {}
    weighed = {}
    for item in found:
        body = item.implied
        if body is not None and item.body is not None and item.body.complete and body.mass > 0:
            centre = tuple(float(part) for part in body.com)
            weighed[item.link.name] = body.mass, centre, tuple(six_numbers(body.inertia).values())
    return weighed
