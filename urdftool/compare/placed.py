"""Shapes at their poses in the frame of a body, and their descriptions."""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np

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
    UnknownShape,
    Visual,
)
from ..model.shapes import describe_shape
from .frames import describe_pose

_SHOWN = 4
"""Largest number of values of a shape that are printed; chosen, no source."""


class Placed(NamedTuple):
    """A shape at its pose in the frame of the first body."""

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


def measure_corner_distance(*boxes: tuple[tuple[float, float, float], Array]) -> float:
    """Return the largest distance of a corner of one of two boxes to the nearest of the other [m].

    It is 0 for boxes that are one solid, such as a cube that is turned by 90°.

    Args:
        boxes: Two boxes, each as its size [m] and its pose, 4 × 4.
    """
    signs = np.array(list(product((-0.5, 0.5), repeat=3)))
    one, two = (signs * size @ pose[:3, :3].T + pose[:3, 3] for size, pose in boxes)
    distances = np.linalg.norm(one[:, None] - two[None], axis=2)
    return float(max(distances.min(axis=0).max(), distances.min(axis=1).max()))


def describe_what(kind: str, placed: Placed) -> str:
    """Return the kind and name of a shape."""
    return f"{kind} '{placed.shape.name}'" if placed.shape.name else kind


def describe(placed: Placed, other: Placed | None = None) -> str:
    """Describe a shape with its size and its pose in the link.

    Args:
        placed: The shape.
        other: One that it is compared with: of shapes that are not read only what differs is named.
    """
    geometry = placed.geometry
    lengths: list[float] = []
    if isinstance(geometry, Mesh):
        text = f"mesh {geometry.filename.rpartition('/')[2]}"
        if geometry.scale != (1, 1, 1):
            text, lengths = f"{text} ×", list(geometry.scale)
    elif isinstance(geometry, UnknownShape):
        text = _describe_content(geometry, other and other.geometry)
    elif isinstance(geometry, Plane):
        text = "plane"
        lengths = list(geometry.size or ()) if isinstance(placed.shape, Visual) else []
    else:
        facts = describe_shape(geometry)
        text = facts.pop("shape")
        lengths = [length for value in facts.values() for length in value]
    at = describe_pose(get_origin_matrix(placed.shape.origin))
    return " ".join((text, *(f"{length:.6g}" for length in lengths), "at", at))


def _describe_content(geometry: UnknownShape, other: Geometry | None) -> str:
    """Return the tag of a shape that is not read, and the first values that another lacks."""
    known = (isinstance(other, UnknownShape) and other.content) or {}
    texts = []
    for name, value in (geometry.content or {}).items():
        if known.get(name) != value:
            shown = value if isinstance(value, str) else " ".join(f"{n:.6g}" for n in value)
            texts.append(f"{name} {shown}")
    rest = f", … ({len(texts) - _SHOWN} more)" if len(texts) > _SHOWN else ""
    return f"{geometry.tag} {', '.join(texts[:_SHOWN])}{rest}".strip()
