"""Contact of two shapes by their triangles, without FCL: meshes are surfaces, primitives solid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.mesh import Array
from ..geometry.tessellate import tessellate
from ..geometry.triangle_contact import find_crossing
from ..model.elements import Robot
from ..model.pose import Pose
from .shapes import Solid, read_solids


@dataclass(frozen=True, eq=False)
class Surface:
    """The surface of a shape.

    Attributes:
        triangles: Its triangles [m], shape (n, 3, 3).
        is_solid: Whether it is a primitive, whose inside counts.
    """

    triangles: Array
    is_solid: bool


def read_surfaces(robot: Robot, link: str, pose: Pose) -> list[Surface]:
    """Read the collisions of a link.

    Raises:
        UrdftoolError: A mesh cannot be read, or a shape is not bounded.
    """
    return [_place_solid(solid, pose) for solid in read_solids(robot, link)]


def _place_solid(solid: Solid, pose: Pose) -> Surface:
    """Return the surface of a shape of a link with a pose."""
    vertices, faces = solid.vertices, solid.faces
    if vertices is None or faces is None:
        vertices, faces = tessellate(solid.kind, solid.size)
        vertices = vertices @ solid.rotation.T + solid.translation
    placed = vertices @ np.array(pose.rotation).T + np.array(pose.translation)
    return Surface(placed[faces], solid.vertices is None)


def find_contact(one: Surface, other: Surface) -> bool | None:
    """Find whether two shapes touch: their surfaces cross, or one is within a solid.

    Returns:
        None if they have too many triangles.
    """
    if not len(one.triangles) or not len(other.triangles):
        return False
    if _holds_corner(one, other) or _holds_corner(other, one):
        return True
    return find_crossing(one.triangles, other.triangles)


def _holds_corner(solid: Surface, other: Surface) -> bool:
    """Find whether a corner of a surface is within a convex solid."""
    a, b, c = (solid.triangles[:, corner] for corner in range(3))
    outward = np.cross(b - a, c - a)
    heights = ((other.triangles[0, 0] - a) * outward).sum(axis=1)
    return solid.is_solid and bool((heights <= 0).all())
