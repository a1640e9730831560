"""Collision geometry of a robot as primitives and convex pieces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..errors import ModelError, UrdftoolError
from ..geometry.hull import compute_convex_hull, extract_hull_surface
from ..geometry.mesh import Faces
from ..geometry.mesh import Mesh as Triangles
from ..geometry.tessellate import tessellate
from ..model.bounds import has_extent
from ..model.elements import (
    Box,
    Capsule,
    Collision,
    Cone,
    Cylinder,
    Ellipsoid,
    Link,
    Mesh,
    Robot,
    Sphere,
)
from ..model.pose import Pose, make_pose
from ..model.shapes import get_shape_name
from .mesh_cache import get_cached_hulls, load_triangles
from .recording import Array

MOST_PIECES = 32
"""Maximum number of objects of a mesh file that become separate hulls; otherwise one hull. Chosen,
no source.
"""

MOST_VERTICES = 400
"""Maximum number of vertices of a hull; a finer hull is reduced to its extreme points. Chosen, no
source.
"""

_AROUND = 16
"""Number of corners of a circle in the approximation of an ellipsoid or cone. Chosen, no source."""

_LEAST = 1e-9
"""M: a mesh that is smaller is a point. Chosen, no source."""


@dataclass(frozen=True, eq=False)
class Shape:
    """One collision element.

    Attributes:
        link: Name of the link.
        index: Index of the element among all collision elements of the robot.
        kind: ``box``, ``cylinder``, ``sphere``, ``capsule`` or ``mesh``.
        size: Edges of a box, or radius and length of a round shape [m].
        pieces: Corners of each convex piece of a mesh [m], in the shape's frame.
        faces: Triangles of each piece.
        pose: Pose in the frame of the body.
    """

    link: str
    index: int
    kind: str
    size: tuple[float, ...] = ()
    pieces: tuple[Array, ...] = ()
    faces: tuple[Faces, ...] = ()
    pose: Pose = field(default_factory=Pose)

    def compute_reach(self, direction: Array) -> float:
        """Compute the support function along a unit vector of the body's frame [m]."""
        turn = np.array(self.pose.rotation)
        along = turn.T @ direction
        start = float(np.dot(self.pose.translation, direction))
        if self.kind == "mesh":
            return start + max(float((points @ along).max()) for points in self.pieces)
        if self.kind == "box":
            return start + float(np.abs(along) @ np.array(self.size)) / 2
        if self.kind == "sphere":
            return start + self.size[0]
        radius, length = self.size
        ends = abs(float(along[2])) * length / 2
        if self.kind == "capsule":
            return start + ends + radius
        return start + ends + radius * float(np.hypot(along[0], along[1]))

    def get_corners(self) -> Array:
        """Return corners of a mesh, a box, or a round shape's box, in its frame [m], (n, 3)."""
        if self.kind == "mesh":
            return np.concatenate(self.pieces)
        if self.kind == "box":
            edges = np.array(self.size)
        else:
            radius = self.size[0]
            length = self.size[1] if self.kind != "sphere" else 0.0
            ends = 0.0 if self.kind == "cylinder" else 2 * radius
            edges = np.array([2 * radius, 2 * radius, length + ends])
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        corners: Array = signs * edges / 2
        return corners

    def get_bounds(self) -> tuple[Array, Array]:
        """Return the bounding box in the frame of the body: lower and upper corner [m]."""
        return self._bounds

    @cached_property
    def _bounds(self) -> tuple[Array, Array]:
        axes = np.eye(3)
        high = np.array([self.compute_reach(axis) for axis in axes])
        low = -np.array([self.compute_reach(-axis) for axis in axes])
        return low, high


def make_shapes(robot: Robot, link: Link, at: Pose, first: int) -> Iterator[Shape]:
    """Make the shapes of a link whose frame is at a pose in its body.

    Raises:
        UrdftoolError: A mesh is not found or cannot be read, or has no extent.
    """
    for number, collision in enumerate(link.collisions, first):
        geometry = collision.geometry
        if is_without_extent(collision):
            continue
        pose = at @ make_pose(collision.origin)
        if isinstance(geometry, Mesh):
            pieces, faces = _collect_pieces(robot, collision, geometry)
            largest = max(float(np.ptp(piece, axis=0).max()) for piece in pieces)
            if largest < _LEAST:
                raise ModelError(
                    f"mesh '{geometry.filename}' of link '{link.name}' has a scaled size of "
                    f"{largest:g} m and cannot make contact",
                    at=geometry.place,
                )
            yield Shape(link.name, number, "mesh", (), pieces, faces, pose)
            continue
        if isinstance(geometry, Ellipsoid | Cone):
            lengths = _get_lengths(geometry)
            points, triangles = tessellate(get_shape_name(geometry), lengths, _AROUND)
            yield Shape(link.name, number, "mesh", (), (points,), (triangles,), pose)
            continue
        size: tuple[float, ...]
        if isinstance(geometry, Box):
            kind, size = "box", geometry.size
        elif isinstance(geometry, Sphere):
            kind, size = "sphere", (geometry.radius,)
        elif isinstance(geometry, (Cylinder, Capsule)):
            kind = "cylinder" if isinstance(geometry, Cylinder) else "capsule"
            size = (geometry.radius, geometry.length)
        else:
            raise ModelError(
                f"collision of link '{link.name}' has no shape; write a box, cylinder, sphere, "
                "capsule or mesh",
                at=collision.place,
                rule="unsupported-shape",
            )
        yield Shape(link.name, number, kind, tuple(size), pose=pose)


def _get_lengths(geometry: Ellipsoid | Cone) -> tuple[float, ...]:
    if isinstance(geometry, Ellipsoid):
        return geometry.radii
    return geometry.radius, geometry.length


def is_without_extent(collision: Collision) -> bool:
    """Tell whether a collision is a primitive with a length of zero or less."""
    geometry = collision.geometry
    return isinstance(geometry, Box | Sphere | Cylinder | Capsule) and not has_extent(geometry)


def _collect_pieces(
    robot: Robot, collision: Collision, geometry: Mesh
) -> tuple[tuple[Array, ...], tuple[Faces, ...]]:
    try:
        if robot.source is None:
            raise ModelError("the robot was not read from a file, so its meshes cannot be found")
        parts = get_cached_hulls(
            robot,
            geometry,
            "pieces",
            lambda: list(_list_convex_parts(load_triangles(robot, geometry))),
        )
    except UrdftoolError as error:
        message = f"mesh '{geometry.filename}': {error.message}"
        raise ModelError(message, at=geometry.place, notes=error.notes, rule=error.rule) from None
    return tuple(points for points, _ in parts), tuple(faces for _, faces in parts)


def _list_convex_parts(mesh: Triangles) -> Iterator[tuple[Array, Faces]]:
    """Yield the hull of each object of a mesh, as engines make it."""
    parts = [mesh.get_part_faces(part) for part in mesh.parts]
    if mesh.format == "stl" or not 1 < len(parts) <= MOST_PIECES:
        parts = [mesh.faces]
    for faces in parts:
        used = np.zeros(len(mesh.vertices), dtype=bool)
        used[faces] = True
        yield compute_hull(mesh.vertices[used])


def compute_hull(points: Array) -> tuple[Array, Faces]:
    """Compute corners and triangles of the convex hull of points; flat points are returned."""
    found = compute_convex_hull(points)
    if found is not None and found.num_vert() > MOST_VERTICES:
        found = compute_convex_hull(_choose_extreme_points(extract_hull_surface(found)[0]))
    if found is None:
        points = _choose_extreme_points(points) if len(points) > MOST_VERTICES else points
        return points, _make_fan(len(points))
    return extract_hull_surface(found)


def _make_fan(count: int) -> Faces:
    """Make triangles that refer to every point."""
    fan: Faces = np.array([(0, i, min(i + 1, count - 1)) for i in range(max(1, count - 1))])
    return fan


def _choose_extreme_points(points: Array) -> Array:
    """Choose the extreme points along directions spread evenly over the sphere."""
    steps = np.arange(MOST_VERTICES) + 0.5
    z = 1 - 2 * steps / MOST_VERTICES
    angle = steps * np.pi * (1 + 5**0.5)
    ring = np.sqrt(1 - z * z)
    directions = np.stack([ring * np.cos(angle), ring * np.sin(angle), z])
    axes = np.concatenate([np.eye(3), -np.eye(3)]).T
    chosen = np.unique((points @ np.concatenate([directions, axes], axis=1)).argmax(axis=0))
    thinned: Array = points[chosen]
    return thinned


def compute_lowest_height(shapes: Sequence[Shape], turn: Array, at: Array) -> float:
    """Compute the height of the lowest point of shapes of one body in the world [m].

    Args:
        shapes: Shapes of the body.
        turn: Rotation of the body in the world, shape (3, 3).
        at: Origin of the body in the world [m].
    """
    down = turn.T @ np.array([0.0, 0.0, -1.0])
    return float(at[2]) - max(shape.compute_reach(down) for shape in shapes)
