"""Pieces of collision geometry: primitives and meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Faces, Points
from ..geometry.plain_form import check_triangles
from ..geometry.tessellate import tessellate
from .vec3 import compute_bounds

PRIMITIVES = ("sphere", "capsule", "box", "cylinder")
"""Kinds that require no mesh file."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A shape in the frame of its source mesh.

    Attributes:
        kind: One of ``PRIMITIVES``, ``"convex"`` for a convex mesh, or ``"mesh"``.
        size: Lengths [m] of a primitive: three edges of a box; radius and length of a cylinder or
            capsule (length between the caps); radius of a sphere.
        rotation: Axes of the primitive in the mesh's frame, as columns.
        center: Center of the primitive [m] in the mesh's frame.
        vertices: Points [m] of the surface; a fine approximation for a primitive.
        faces: Triangles of the surface, wound outward.
    """

    kind: str
    size: tuple[float, ...]
    rotation: Points
    center: Points
    vertices: Points
    faces: Faces

    @property
    def is_primitive(self) -> bool:
        """Tell whether it is a URDF primitive, which requires no mesh file."""
        return self.kind in PRIMITIVES

    @property
    def corners(self) -> Points:
        """Return the triangles of the surface [m], shape (m, 3, 3)."""
        return self.vertices[self.faces]

    @cached_property
    def sides(self) -> Points:
        """Return the planes of a convex piece's faces, from :func:`.convex.planes`."""
        from .convex import compute_planes

        return compute_planes(self.vertices, self.faces)

    @cached_property
    def bounds(self) -> Points:
        """Return lower and upper corner [m] of the bounding box, shape (2, 3)."""
        return compute_bounds(self.vertices)

    def transform_to_local(self, points: Points) -> Points:
        """Transform points from the mesh's frame to the primitive's frame."""
        return np.asarray((points - self.center) @ self.rotation)

    def transform(self, rotation: Points, translation: Points, scale: float = 1.0) -> Piece:
        """Scale the piece, then transform it into the parent frame of the mesh."""
        return Piece(
            self.kind,
            tuple(length * scale for length in self.size),
            rotation @ self.rotation,
            rotation @ (self.center * scale) + translation,
            (self.vertices * scale) @ rotation.T + translation,
            self.faces,
        )

    def as_dict(self) -> dict[str, Any]:
        """Convert to plain numbers; a primitive without its triangles."""
        if self.is_primitive:
            return {
                "kind": self.kind,
                "size": list(self.size),
                "rotation": self.rotation.tolist(),
                "center": self.center.tolist(),
            }
        return {
            "kind": self.kind,
            "vertices": self.vertices.tolist(),
            "faces": self.faces.tolist(),
        }


def find_overlapping_boxes(box: Points, boxes: Points, gap: float) -> npt.NDArray[np.bool_]:
    """Find the boxes, shape (n, 2, 3), that are at most a gap [m] from a box along each axis."""
    near = np.ones(len(boxes), dtype=bool)
    for axis in range(3):
        near &= box[0, axis] - boxes[:, 1, axis] <= gap
        near &= boxes[:, 0, axis] - box[1, axis] <= gap
    return near


def make_mesh_piece(vertices: Points, faces: Faces, *, convex: bool = True) -> Piece:
    """Create a piece from a mesh."""
    kind = "convex" if convex else "mesh"
    return Piece(kind, (), np.eye(3), np.zeros(3), vertices, faces)


def make_primitive(
    kind: str, size: Sequence[float], rotation: Points, center: Sequence[float] | Points
) -> Piece:
    """Create a box, cylinder, capsule or sphere, with triangles fine enough for distances.

    Args:
        kind: One of ``PRIMITIVES``.
        size: Lengths [m], as ``Piece.size``.
        rotation: Its axes, as columns.
        center: Its center [m].
    """
    vertices, faces = tessellate(kind, size)
    turned = np.asarray(rotation, dtype=np.float64)
    middle = np.asarray(center, dtype=np.float64)
    return Piece(kind, tuple(size), turned, middle, vertices @ turned.T + middle, faces)


def parse_piece(table: dict[str, Any]) -> Piece:
    """Create the piece that :meth:`Piece.as_dict` describes.

    Raises:
        ValueError: A number is not finite, or a triangle has a point that does not exist.
    """
    if table["kind"] in PRIMITIVES:
        rotation = np.array(table["rotation"], dtype=np.float64).reshape(3, 3)
        center = np.array(table["center"], dtype=np.float64).reshape(3)
        piece = make_primitive(table["kind"], tuple(map(float, table["size"])), rotation, center)
        if not np.isfinite(piece.vertices).all():
            raise ValueError("a number is not finite")
        return piece
    vertices = np.array(table["vertices"], dtype=np.float64).reshape(-1, 3)
    faces = np.array(table["faces"], dtype=np.int64).reshape(-1, 3)
    check_triangles(vertices, faces)
    return make_mesh_piece(vertices, faces, convex=table["kind"] == "convex")
