"""Collision shapes of links: convex pieces for proofs, triangles and primitives for contacts.

Contacts are those of MoveIt's FCL: surfaces of meshes, and solid primitives. A link wholly inside
the mesh of another one does not touch it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import MeshError, UrdftoolError
from ..geometry.load import load_named
from ..geometry.mesh import Faces, Points
from ..geometry.tessellate import tessellate
from ..model.elements import (
    Box,
    Capsule,
    Collision,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Mesh,
    Robot,
    Sphere,
    Visual,
)
from ..model.pose import make_pose
from .cover import Piece, make_hull, split_triangles

PIECES = 24
"""Convex pieces of a link's mesh; chosen, see ``docs/commands/srdf.md``."""

AROUND = 64
"""Corners of the circle around a cylinder; chosen, no source."""


@dataclass(frozen=True, eq=False)
class Solid:
    """A shape as FCL tests it for contact.

    Attributes:
        kind: ``mesh``, or the name of a primitive of FCL.
        size: Its parameters [m].
        rotation: Of the shape in the frame of the link.
        translation: Of the shape in the frame of the link [m].
        vertices: Corners of a mesh in the frame of the link [m], shape (n, 3).
        faces: Triangles of a mesh.
    """

    kind: str
    size: tuple[float, ...]
    rotation: np.ndarray
    translation: np.ndarray
    vertices: Points | None = None
    faces: Faces | None = None


@dataclass(frozen=True, eq=False)
class LinkShape:
    """Shapes of a link."""

    link: str
    pieces: tuple[Piece, ...]
    solids: tuple[Solid, ...]
    problem: str = ""


def read_shapes(
    robot: Robot, link: str, *, visual: bool = False, pieces: int = PIECES
) -> LinkShape:
    """Read the shapes of a link; a mesh that cannot be read is the problem of the result."""
    part = robot.link[link]
    shapes: Sequence[Collision | Visual] = part.visuals if visual else part.collisions
    found: list[Piece] = []
    solids: list[Solid] = []
    for shape in shapes:
        try:
            solid = _read_shape(robot, shape)
        except UrdftoolError as error:
            return LinkShape(link, (), (), str(error))
        solids.append(solid)
        found += _cover(solid, max(2, pieces // len(shapes)))
    return LinkShape(link, tuple(found), tuple(solids))


def read_solids(robot: Robot, link: str) -> list[Solid]:
    """Read the collisions of a link as FCL tests them for contact.

    Raises:
        UrdftoolError: A mesh cannot be read, or a shape is not bounded.
    """
    return [_read_shape(robot, shape) for shape in robot.link[link].collisions]


def _read_shape(robot: Robot, shape: Collision | Visual) -> Solid:
    """Return a shape in the frame of its link; it is read once for a robot."""
    # the shape is kept with its solid, so that no other shape gets its id
    return robot.memo.get((_read_shape, id(shape)), lambda: (shape, _make_solid(robot, shape)))[1]


def _make_solid(robot: Robot, shape: Collision | Visual) -> Solid:
    pose = make_pose(shape.origin)
    rotation, translation = np.array(pose.rotation, float), np.array(pose.translation, float)
    geometry = shape.geometry
    if isinstance(geometry, Mesh):
        if robot.source is None:
            raise MeshError("the robot was not read from a file, so its meshes are unknown")
        mesh = load_named(robot.source, geometry.filename, geometry.scale)
        vertices = mesh.vertices @ rotation.T + translation
        return Solid("mesh", (), np.eye(3), np.zeros(3), vertices, mesh.faces)
    kind, size = describe_primitive(geometry)
    if not all(math.isfinite(value) and value > 0 for value in size):
        raise MeshError(f"the size of the {kind} is not given, or not above 0")
    return Solid(kind, size, rotation, translation)


def describe_primitive(geometry: Geometry | None) -> tuple[str, tuple[float, ...]]:
    """Return the name of a primitive and its lengths [m] as ``tessellate`` takes them.

    Raises:
        MeshError: It is not a bounded primitive.
    """
    if isinstance(geometry, Box):
        return "box", geometry.size
    if isinstance(geometry, Sphere):
        return "sphere", (geometry.radius,)
    if isinstance(geometry, Cylinder | Cone | Capsule):
        return type(geometry).__name__.lower(), (geometry.radius, geometry.length)
    if isinstance(geometry, Ellipsoid):
        return "ellipsoid", geometry.radii
    raise MeshError("the shape is not a mesh, box, cylinder, sphere, capsule, ellipsoid or cone")


def _cover(solid: Solid, pieces: int) -> list[Piece]:
    """Cover a shape by convex pieces in the frame of the link."""
    if solid.vertices is not None and solid.faces is not None:
        corners = solid.vertices[solid.faces]
        return [make_hull(points) for points in split_triangles(corners, pieces)]
    none = np.zeros((0, 3), dtype=np.int64)
    if solid.kind == "sphere":
        return [Piece(solid.translation[None], none, solid.size[0])]
    if solid.kind == "capsule":
        half = solid.size[1] / 2 * solid.rotation[:, 2]
        return [Piece(solid.translation + np.stack([-half, half]), none, solid.size[0])]
    points = make_circumscribed(solid.kind, solid.size) @ solid.rotation.T + solid.translation
    return [make_hull(points)]


def make_circumscribed(kind: str, size: Sequence[float]) -> Points:
    """Return the corners [m] of a polyhedron that contains a primitive."""
    if kind == "box":
        return tessellate(kind, size)[0]
    if kind == "ellipsoid":
        points, faces = tessellate("sphere", (1.0,), AROUND // 2)
        a, b, c = points[faces].swapaxes(0, 1)
        normals = np.cross(b - a, c - a)
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        larger: Points = points / (normals * a).sum(axis=1).min() * np.asarray(size)
        return larger
    points, _ = tessellate(kind, size, AROUND)
    wider = 1 / math.cos(math.pi / AROUND)
    scaled: Points = points * np.array([wider, wider, 1.0])
    return scaled


def make_collider(solid: Solid) -> tuple[Any, np.ndarray, np.ndarray]:
    """Return the geometry of FCL of a shape, and its pose in the frame of the link."""
    import fcl

    if solid.kind == "mesh":
        assert solid.vertices is not None
        assert solid.faces is not None
        model = fcl.BVHModel()
        model.beginModel(len(solid.vertices), len(solid.faces))
        model.addSubModel(solid.vertices, solid.faces)
        model.endModel()
        return model, solid.rotation, solid.translation
    make = {
        "box": fcl.Box,
        "sphere": fcl.Sphere,
        "cylinder": fcl.Cylinder,
        "capsule": fcl.Capsule,
        "cone": fcl.Cone,
        "ellipsoid": fcl.Ellipsoid,
    }[solid.kind]
    return make(*solid.size), solid.rotation, solid.translation
