"""Mass properties that the geometry of a link implies: bounding box, volume and moments."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from ...mechanics.tensor import SymmetricTensor, rotate_tensor
from ...model.bounds import Bounds, compute_bounds
from ...model.elements import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Geometry,
    Link,
    Sphere,
    Vector,
    Visual,
)
from ...model.pose import make_pose, multiply_matrices, transpose
from ...model.shapes import get_shape_name

DENSITY = 1000.0
"""Density [kg/m³] of links without a mass: that of water. Chosen, no source."""


def compute_box(link: Link) -> Bounds | None:
    """Compute the bounding box of a link in its frame; None if not all shapes are primitives."""
    found: Bounds | None = None
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    for shape in shapes:
        bounds = compute_bounds(shape)
        if bounds is None:
            return None
        found = bounds if found is None else found.join(bounds)
    return found if found is not None and any(found.size) else None


def compute_volume(geometry: Geometry | None) -> float:
    """Compute the volume [m³]; 0 if it is not a primitive."""
    if isinstance(geometry, Box):
        return abs(math.prod(geometry.size))
    if isinstance(geometry, Sphere):
        return 4 / 3 * _compute_ball_volume(geometry.radius)
    if isinstance(geometry, Cylinder):
        return _compute_disc_area(geometry.radius) * geometry.length
    if isinstance(geometry, Capsule):
        return _compute_disc_area(geometry.radius) * geometry.length + 4 / 3 * _compute_ball_volume(
            geometry.radius
        )
    return 0.0


def compute_solid_center(link: Link) -> Vector | None:
    """Compute the center of mass [m] in the link frame, as if all shapes were solid and alike.

    Collision geometry counts, or visual geometry if there is none.

    Returns:
        None if not all are primitives.
    """
    shapes: list[Visual | Collision] = [*(link.collisions or link.visuals)]
    volumes = [compute_volume(shape.geometry) for shape in shapes]
    whole = sum(volumes)
    if not whole or not all(volumes):
        return None
    places = [make_pose(shape.origin).translation for shape in shapes]
    x, y, z = (
        sum(volume * place[i] for volume, place in zip(volumes, places, strict=True)) / whole
        for i in range(3)
    )
    return x, y, z


def _compute_disc_area(radius: float) -> float:
    return math.pi * radius * radius  # ** raises OverflowError where * returns infinity


def _compute_ball_volume(radius: float) -> float:
    return _compute_disc_area(radius) * radius


def compute_solid_moments(link: Link) -> Vector | None:
    """Compute the moments [kg·m²] of a link's only shape as a solid, along the inertial's axes.

    Returns:
        None if the link has several shapes, no primitive, or one that is rotated relative to the
        ``<inertial>``.
    """
    inertial = link.inertial
    shape = get_only_shape(link)
    if inertial is None or shape is None or not inertial.mass:
        return None
    if make_pose(inertial.origin).rotation != make_pose(shape.origin).rotation:
        return None
    return _compute_moments(shape.geometry, inertial.mass)


def compute_solid_tensor(link: Link) -> SymmetricTensor | None:
    """Compute the tensor [kg·m²] of a link's only shape as a solid, along the inertial's axes.

    Returns:
        None if the link has several shapes, or no primitive.
    """
    inertial, shape = link.inertial, get_only_shape(link)
    if inertial is None or shape is None or not inertial.mass:
        return None
    moments = _compute_moments(shape.geometry, inertial.mass)
    if moments is None:
        return None
    x, y, z = moments
    there, here = make_pose(shape.origin).rotation, make_pose(inertial.origin).rotation
    if there == here:
        return x, 0.0, 0.0, y, 0.0, z
    return rotate_tensor((x, 0.0, 0.0, y, 0.0, z), multiply_matrices(transpose(here), there))


def get_only_shape(link: Link) -> Visual | Collision | None:
    """Get the link's only collision, or else its only visual; None if there are several."""
    shapes: Sequence[Visual | Collision] = link.collisions or link.visuals
    return shapes[0] if len(shapes) == 1 else None


def _compute_moments(geometry: Geometry | None, mass: float) -> Vector | None:
    if isinstance(geometry, Box):
        x, y, z = (side * side for side in geometry.size)
        return mass / 12 * (y + z), mass / 12 * (x + z), mass / 12 * (x + y)
    if isinstance(geometry, Sphere):
        moment = 0.4 * mass * geometry.radius * geometry.radius
        return moment, moment, moment
    if isinstance(geometry, Cylinder):
        radius, length = geometry.radius * geometry.radius, geometry.length * geometry.length
        across = mass / 12 * (3 * radius + length)
        return across, across, mass / 2 * radius
    return None


def is_dummy(link: Link, *, largest: float = 0.005) -> bool:
    """Tell whether a link's geometry is at most a few millimeters large, as that of a placeholder.

    The inertia of a solid of that size is so small that no joint should move it alone.
    """
    box = compute_box(link)
    return box is not None and max(box.size) <= largest * (1 + 1e-6)


_HELPER = re.compile(r"fake|dummy|marker|virtual", re.IGNORECASE)
_MARKER = 0.01
"""Maximum size [m] of geometry that marks the place of a link without a body; chosen, no source."""


def is_helper(link: Link) -> bool:
    """Tell whether a link only helps to build the tree: so it is named, and its shape is tiny."""
    return _HELPER.search(link.name) is not None and is_dummy(link, largest=_MARKER)


def get_solid_kind(link: Link) -> str:
    """Name the element of the solid of :func:`describe_solid`; empty if there is none."""
    shape = get_only_shape(link)
    if compute_solid_moments(link) is None or shape is None or shape.geometry is None:
        return ""
    return shape.geometry.tag


def describe_solid(link: Link) -> str:
    """Describe the inertia to write: ``; a solid box of 2 kg has ixx 1, …``; may be empty."""
    moments, shape = compute_solid_moments(link), get_only_shape(link)
    if moments is None or shape is None or shape.geometry is None:
        return ""
    x, y, z = moments
    tag = get_shape_name(shape.geometry)
    return f"; a solid {tag} of {link.mass:g} kg has ixx {x:.4g}, iyy {y:.4g}, izz {z:.4g}"
