"""Comparison of the collision shapes that Newton imports of a stage with those of its source."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ...compare.check import Check
from ...errors import UrdftoolError
from ...geometry.load import load_named
from ...mechanics.reference import Mechanics, get_origin_matrix
from ...model.elements import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Ellipsoid,
    Geometry,
    Link,
    Mesh,
    Robot,
    Sphere,
)
from ...model.settings import get_number
from .declared_losses import SHAPES
from .verify_newton_source import FLOAT, Source

Array = npt.NDArray[np.float64]

HULL = 0.1
"""Tolerance for meshes, relative to the size: Newton reduces hulls to 64 vertices.

The largest difference among the robots of example-robot-data is 6 %.
"""

_DEFAULT_FRICTION = 1.0
"""Newton's coefficient of friction for shapes without a material."""

_LOST = (*SHAPES, "lossy-convex")


def compare_colliders(
    source: Source, shapes: list[dict[str, Any]], links: Mapping[str, str]
) -> list[Check]:
    """Compare number and extent of the colliders of each body, with those of its frames."""
    count = Check("Newton: colliders", "number of collision shapes of each body", 0.0)
    extent = Check(
        "Newton: shapes",
        "bounding box of the colliders of each body, relative; of hulls within 10 %",
        FLOAT,
    )
    friction = Check("Newton: friction", "coefficient of contact of each collider", FLOAT)
    read: dict[str, list[dict[str, Any]]] = {}
    for shape in shapes:
        if shape["collides"]:
            read.setdefault(links.get(shape["body"], ""), []).append(shape)
    frames = Mechanics(source.robot).compute_frames({})
    for body, parts in _group_by_body(source).items():
        name = f"link '{body}'" if body else "the world"
        own = [(link, shape) for link in parts for shape in link.collisions if shape.geometry]
        theirs = read.get(body, [])
        lost = any(source.losses.has_for(_LOST, link.name) for link in parts)
        count.compare(float(len(own) != len(theirs)), name, known=lost)
        if len(own) != len(theirs) or not own:
            continue
        ours = sorted(
            _DEFAULT_FRICTION if (value := get_number(shape.surface, "friction")) is None else value
            for _, shape in own
        )
        read_friction = sorted(shape["friction"] for shape in theirs)
        for one, two in zip(ours, read_friction, strict=True):
            friction.compare(abs(one - two), name, known=lost)
        root = frames[body] if body else np.eye(4)
        bounds = [_compute_bounds(source.robot, shape, np.linalg.inv(root) @ frames[link.name])
                  for link, shape in own]  # fmt: skip
        got = [shape["bounds"] for shape in theirs]
        if all(b is not None for b in bounds) and all(b is not None for b in got):
            has_mesh = any(isinstance(shape.geometry, Mesh | Ellipsoid) for _, shape in own)
            difference = _measure_difference(np.array(bounds), np.array(got))
            allowed = HULL if has_mesh else FLOAT
            extent.compare(difference * FLOAT / allowed, name, known=lost)
    return [count, extent, friction]


def _group_by_body(source: Source) -> dict[str, list[Link]]:
    """Return the links of each body by the name of the link with mass that carries them."""
    found: dict[str, list[Link]] = {}
    for link in source.robot.links:
        found.setdefault(source.body.get(link.name, ""), []).append(link)
    return found


def _measure_difference(ours: Array, theirs: Array) -> float:
    """Return the difference of the boxes around two sets of boxes, relative to the first."""
    one, two = (np.array([many[:, 0].min(0), many[:, 1].max(0)]) for many in (ours, theirs))
    size = max(float(np.ptp(one, axis=0).max()), float(np.abs(one).max()), 1e-9)
    return float(np.abs(one - two).max()) / size


def _compute_bounds(robot: Robot, shape: Collision, frame: Array) -> Array | None:
    """Return the corners [m] of the bounding box of a shape, of the link with a frame."""
    at = frame @ get_origin_matrix(shape.origin)
    turn, center = at[:3, :3], at[:3, 3]
    if isinstance(shape.geometry, Mesh):
        if robot.source is None:
            return None
        try:
            mesh = load_named(robot.source, shape.geometry.filename, shape.geometry.scale)
        except UrdftoolError:
            return None
        points = mesh.vertices @ turn.T + center
        return np.array([points.min(0), points.max(0)])
    reach = _compute_reach(shape.geometry, turn)
    return None if reach is None else np.array([center - reach, center + reach])


def _compute_reach(geometry: Geometry | None, turn: Array) -> Array | None:
    """Return half the edges [m] of the bounding box of a rotated primitive."""
    along, across = np.abs(turn[:, 2]), np.hypot(turn[:, 0], turn[:, 1])
    if isinstance(geometry, Box):
        return np.asarray(np.abs(turn) @ np.array(geometry.size) / 2)
    if isinstance(geometry, Sphere):
        return np.full(3, geometry.radius)
    if isinstance(geometry, Cylinder):
        return np.asarray(geometry.radius * across + geometry.length / 2 * along)
    if isinstance(geometry, Capsule):
        return np.asarray(geometry.radius + geometry.length / 2 * along)
    if isinstance(geometry, Ellipsoid):
        return np.asarray(np.linalg.norm(turn * np.array(geometry.radii), axis=1))
    return None
