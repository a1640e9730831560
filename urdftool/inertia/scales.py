"""Estimated mass properties of links at one density, as a scale for missing values."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..errors import UrdftoolError
from ..model.elements import Robot
from ..source.description import Description
from .bodies import scale_to_mass
from .link_review import LinkReview
from .mesh_files import Meshes, read_meshes
from .review import find_bodies


class Scales:
    """Mass estimation at one density; each mesh file is read once for all robots."""

    def __init__(self, density: float) -> None:
        """Set the density [kg/m³]."""
        self.density = density
        self.known: dict[tuple[str, str], Any] = {}

    def __call__(self, robot: Robot, names: Sequence[str]) -> dict[str, tuple[float, Any, Any]]:
        """Compute mass [kg], center of mass [m] and tensor [kg·m²] of links, in the link frame.

        Returns:
            Links whose geometry has an unknown volume are missing; empty if the estimate fails.
        """
        description = robot.source
        assert description is not None

        def read(names: Sequence[str]) -> dict[str, Any]:
            keys = {name: _get_key(description, name) for name in names}
            new = [name for name in names if keys[name] not in self.known]
            for name, body in read_meshes(description, new, jobs=1).items():
                self.known[keys[name]] = body
            return {name: self.known[keys[name]] for name in names}

        found = [LinkReview(robot.link[name]) for name in names]
        weights: dict[str, tuple[float, Any, Any]] = {}
        try:
            find_bodies(found, Meshes(read))
            for item in found:
                body = item.body
                if body is None or not body.complete or not body.volume > 0:
                    continue
                whole = scale_to_mass(body.unit, "link", density=self.density)
                weights[item.link.name] = whole.mass, whole.com, whole.tensor
        except UrdftoolError:
            return {}
        return weights


def _get_key(description: Description, name: str) -> tuple[str, str]:
    """Return the file of a URI and its up axis; if not found, the description and the URI."""
    try:
        return str(description.resolve(name)), description.gltf_up
    except UrdftoolError:
        return description.path, name
