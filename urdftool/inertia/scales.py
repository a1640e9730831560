"""What links weigh and how their mass lies, for those who fill in what is missing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..errors import UrdftoolError
from ..model.elements import Robot
from ..source.description import Description
from .bodies import weighed
from .link_review import LinkReview
from .mesh_files import Meshes, read_meshes
from .review import find_bodies


class Scales:
    """Weighs links at one density; a mesh file is read once, whichever robots name it."""

    def __init__(self, density: float) -> None:
        """Weigh at a density [kg/m³]."""
        self.density = density
        self.known: dict[tuple[str, str], Any] = {}

    def __call__(self, robot: Robot, names: Sequence[str]) -> dict[str, tuple[float, Any, Any]]:
        """Compute mass [kg], center of mass [m] and tensor [kg·m²] of links, in the link frame.

        Args:
            robot: The robot, read from a description.
            names: The links; one whose shapes do not say what it encloses is not in the result.
        """
        description = robot.source
        assert description is not None

        def read(wanted: Sequence[str]) -> dict[str, Any]:
            keys = {name: _key(description, name) for name in wanted}
            new = [name for name in wanted if keys[name] not in self.known]
            for name, body in read_meshes(description, new, jobs=1).items():
                self.known[keys[name]] = body
            return {name: self.known[keys[name]] for name in wanted}

        found = [LinkReview(robot.link[name]) for name in names]
        weights: dict[str, tuple[float, Any, Any]] = {}
        try:
            find_bodies(found, Meshes(read))
            for item in found:
                body = item.body
                if body is None or not body.complete or not body.volume > 0:
                    continue
                whole = weighed(body.unit, "link", density=self.density)
                weights[item.link.name] = whole.mass, whole.com, whole.tensor
        except UrdftoolError:
            return {}
        return weights


def _key(description: Description, name: str) -> tuple[str, str]:
    """The file that a name means with how it is read; where there is none, the name itself."""
    try:
        return str(description.resolve(name)), description.gltf_up
    except UrdftoolError:
        return description.path, name
