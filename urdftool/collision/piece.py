"""One convex shape or mesh of a collision geometry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Faces, Points
from ..geometry.tessellate import tessellate
from .vec3 import bounds

PRIMITIVES = ("sphere", "capsule", "box", "cylinder")
"""Kinds that need no mesh file."""

CONVEX = (*PRIMITIVES, "convex")


@dataclass(frozen=True, eq=False)
class Piece:
    """A shape in the frame of the mesh it stands for.

    Attributes:
        kind: One of ``PRIMITIVES``, ``"convex"`` for a convex mesh, or ``"mesh"``.
        size: Lengths [m] of a primitive: a box's three edges; radius and length of a cylinder or
            capsule, whose length is that of the part between the caps; a sphere's radius.
        rotation: Axes of the primitive in the mesh's frame, as columns.
        centre: Its centre [m] in the mesh's frame.
        vertices: Points [m] of the surface, of a primitive a fine approximation of it.
        faces: Triangles of the surface, outwards.
    """

    kind: str
    size: tuple[float, ...]
    rotation: Points
    centre: Points
    vertices: Points
    faces: Faces

    @property
    def is_primitive(self) -> bool:
        """Whether it is a shape of URDF that needs no file."""
        return self.kind in PRIMITIVES

    @property
    def corners(self) -> Points:
        """The triangles of its surface [m], shape (m, 3, 3)."""
        return self.vertices[self.faces]

    @cached_property
    def sides(self) -> Points:
        """The planes of a convex piece's faces, from :func:`.convex.planes`."""
        from .convex import planes

        return planes(self.vertices, self.faces)

    @cached_property
    def bounds(self) -> Points:
        """The lowest and the highest corner [m] of its box, shape (2, 3)."""
        return bounds(self.vertices)

    def local(self, points: Points) -> Points:
        """Points of the mesh's frame in the primitive's own."""
        return np.asarray((points - self.centre) @ self.rotation)

    def posed(self, rotation: Points, translation: Points, scale: float = 1.0) -> Piece:
        """The piece scaled, then turned and moved into a frame around the mesh's."""
        return Piece(
            self.kind,
            tuple(length * scale for length in self.size),
            rotation @ self.rotation,
            rotation @ (self.centre * scale) + translation,
            (self.vertices * scale) @ rotation.T + translation,
            self.faces,
        )

    def as_dict(self) -> dict[str, Any]:
        """Plain numbers; of a primitive, what it can be made of again."""
        if self.is_primitive:
            return {
                "kind": self.kind,
                "size": list(self.size),
                "rotation": self.rotation.tolist(),
                "centre": self.centre.tolist(),
            }
        return {
            "kind": self.kind,
            "vertices": self.vertices.tolist(),
            "faces": self.faces.tolist(),
        }


def near_ones(box: Points, boxes: Points, gap: float) -> npt.NDArray[np.bool_]:
    """Which boxes, shape (n, 2, 3), are at most a gap [m] from a box along each axis."""
    near = np.ones(len(boxes), dtype=bool)
    for axis in range(3):
        near &= box[0, axis] - boxes[:, 1, axis] <= gap
        near &= boxes[:, 0, axis] - box[1, axis] <= gap
    return near


def mesh_piece(vertices: Points, faces: Faces, *, convex: bool = True) -> Piece:
    """A piece that is a mesh."""
    kind = "convex" if convex else "mesh"
    return Piece(kind, (), np.eye(3), np.zeros(3), vertices, faces)


def primitive(
    kind: str, size: Sequence[float], rotation: Points, centre: Sequence[float] | Points
) -> Piece:
    """Make a box, cylinder, capsule or sphere, with triangles fine enough to measure distances to.

    Args:
        kind: One of ``PRIMITIVES``.
        size: Lengths [m], as ``Piece.size``.
        rotation: Its axes, as columns.
        centre: Its center [m].
    """
    vertices, faces = tessellate(kind, size)
    turned = np.asarray(rotation, dtype=np.float64)
    middle = np.asarray(centre, dtype=np.float64)
    return Piece(kind, tuple(size), turned, middle, vertices @ turned.T + middle, faces)


def piece_of(table: dict[str, Any]) -> Piece:
    """Make the piece that :meth:`Piece.as_dict` describes."""
    if table["kind"] in PRIMITIVES:
        return primitive(
            table["kind"], tuple(table["size"]), np.array(table["rotation"]), table["centre"]
        )
    vertices = np.array(table["vertices"], dtype=np.float64).reshape(-1, 3)
    faces = np.array(table["faces"], dtype=np.int64).reshape(-1, 3)
    return mesh_piece(vertices, faces, convex=table["kind"] == "convex")
