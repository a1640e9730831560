"""Shapes at their poses in the frame of a body, and their descriptions."""

from __future__ import annotations

from typing import NamedTuple

from ..mechanics.reference import Array, get_origin_matrix
from ..model.elements import (
    Box,
    Capsule,
    Collision,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Link,
    Mesh,
    Plane,
    Sphere,
    Visual,
)
from ..model.shapes import describe_shape
from .frames import describe_pose


class Placed(NamedTuple):
    """A shape at its pose in the frame of the first body.

    Attributes:
        link: Its link.
        shape: The visual or collision.
        geometry: Its geometry.
        pose: Pose, 4 × 4.
    """

    link: Link
    shape: Visual | Collision
    geometry: Geometry
    pose: Array


def get_size(geometry: Geometry) -> tuple[float, float, float] | None:
    """Return three lengths [m] that describe a primitive, of which the third is along z."""
    if isinstance(geometry, Box):
        return geometry.size
    if isinstance(geometry, Ellipsoid):
        return geometry.radii
    if isinstance(geometry, Sphere):
        return geometry.radius, geometry.radius, geometry.radius
    if isinstance(geometry, Cylinder | Capsule | Cone):
        return geometry.radius, geometry.radius, geometry.length
    if isinstance(geometry, Plane):
        return 1.0, 1.0, 0.0
    return None


def describe_what(kind: str, placed: Placed) -> str:
    """Return the kind and name of a shape."""
    return f"{kind} '{placed.shape.name}'" if placed.shape.name else kind


def describe(placed: Placed) -> str:
    """Describe a shape with its size and its pose in the link."""
    geometry = placed.geometry
    lengths: list[float] = []
    if isinstance(geometry, Mesh):
        text = f"mesh {geometry.filename.rpartition('/')[2]}"
        if geometry.scale != (1, 1, 1):
            text, lengths = f"{text} ×", list(geometry.scale)
    else:
        facts = describe_shape(geometry)
        text = facts.pop("shape")
        if not isinstance(geometry, Plane):
            lengths = [length for value in facts.values() for length in value]
    at = describe_pose(get_origin_matrix(placed.shape.origin))
    return " ".join((text, *(f"{length:.6g}" for length in lengths), "at", at))
