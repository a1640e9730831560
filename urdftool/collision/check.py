"""How good the collisions are that a robot has, link by link, against its visuals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import UrdftoolError
from ..meshes.mesh import Points
from ..model.elements import Box, Capsule, Cylinder, Geometry, Link, Mesh, Robot, Sphere
from ..model.pose import pose_of
from .convex import hull, planes, signed_distance
from .links import Shape
from .measure import Target, measure
from .piece import Piece, mesh_piece
from .surface import Prepared, prepare, read_surface
from .tessellate import primitive

_CONVEX = 1e-3


@dataclass(frozen=True)
class Checked:
    """A link, and how good its collision is.

    Attributes:
        link: Its name.
        measures: As :meth:`Measures.as_dict`; None where there is nothing to compare.
        trouble: Why it could not be measured; empty where it was.
        hulled: Collision meshes that are not convex, of which most engines take the hull.
    """

    link: str
    measures: dict[str, Any] | None
    trouble: str = ""
    hulled: int = 0


def check_link(robot: Robot, link: Link) -> Checked | None:
    """How good a link's collisions are; None where it has no visual.

    Each collision mesh is taken as it is written, and counted if it is not convex.
    """
    if not link.visuals:
        return None
    try:
        visual = _visual(robot, link)
        if visual is None:
            return None
        if not link.collisions:
            return Checked(link.name, None, "it has no collision")
        pieces = [piece for shape in link.collisions for piece in shape_pieces(robot, shape)]
        if not pieces:
            return Checked(link.name, None, "its collisions have no shape")
        hulled = sum(piece.kind == "mesh" for piece in pieces)
        found = measure(Target(visual), pieces)
    except UrdftoolError as error:
        return Checked(link.name, None, str(error))
    return Checked(link.name, found.as_dict(), hulled=hulled)


def _visual(robot: Robot, link: Link) -> Prepared | None:
    vertices, faces, first = [], [], 0
    for shape in link.visuals:
        for piece in shape_pieces(robot, shape):
            vertices.append(piece.vertices)
            faces.append(piece.faces + first)
            first += len(piece.vertices)
    if not vertices:
        return None
    return prepare(np.concatenate(vertices), np.concatenate(faces))


def shape_pieces(robot: Robot, shape: Shape) -> list[Piece]:
    """A shape in the link's frame."""
    geometry = shape.geometry
    pose = pose_of(shape.origin)
    rotation = np.array(pose.rotation, dtype=np.float64)
    xyz = np.array(pose.translation, dtype=np.float64)
    piece = _piece(robot, geometry)
    return [] if piece is None else [piece.posed(rotation, xyz)]


def _piece(robot: Robot, geometry: Geometry | None) -> Piece | None:
    upright, middle = np.eye(3), np.zeros(3)
    if isinstance(geometry, Box):
        return primitive("box", geometry.size, upright, middle)
    if isinstance(geometry, Cylinder):
        return primitive("cylinder", (geometry.radius, geometry.length), upright, middle)
    if isinstance(geometry, Capsule):
        return primitive("capsule", (geometry.radius, geometry.length), upright, middle)
    if isinstance(geometry, Sphere):
        return primitive("sphere", (geometry.radius,), upright, middle)
    if isinstance(geometry, Mesh):
        assert robot.source is not None
        surface = read_surface(robot.source.resolve(geometry.filename), geometry.scale)
        return mesh_piece(surface.vertices, surface.faces, convex=_is_convex(surface))
    return None


def _is_convex(surface: Prepared) -> bool:
    """Whether a closed surface is its own hull."""
    try:
        vertices, faces = hull(surface.vertices)
    except UrdftoolError:
        return False
    middles: Points = surface.corners.mean(axis=1)
    depth = signed_distance(middles, planes(vertices, faces))
    return bool(surface.closed and depth.min() > -_CONVEX * surface.size)
