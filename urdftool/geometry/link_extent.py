"""Bounding boxes of links, along the axes of a link."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from ..errors import UrdftoolError
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
    Robot,
    Sphere,
    Vector,
    Visual,
)
from ..model.pose import IDENTITY, Pose, make_pose
from .load import load_named

Array = npt.NDArray[np.float64]


def compute_box_size(robot: Robot, links: Iterable[tuple[Link, Pose]]) -> Vector | None:
    """Compute the edge lengths [m] of the bounding box of links with poses in its frame.

    Returns:
        Edges of the collision geometry, else of the visual geometry; None without geometry.
    """
    placed = list(links)
    for kind in ("collisions", "visuals"):
        boxes = []
        for link, pose in placed:
            turn, shift = np.array(pose.rotation), np.array(pose.translation)
            for shape in getattr(link, kind):
                points = get_shape_points(robot, shape)
                if points is not None:
                    boxes.append(points if pose is IDENTITY else points @ turn.T + shift)
        if boxes:
            x, y, z = np.ptp(np.concatenate(boxes), axis=0).tolist()
            return x, y, z
    return None


def get_shape_points(robot: Robot, shape: Visual | Collision) -> Array | None:
    """Return points [m] in the link's frame with the same extent as a shape along every axis.

    Return None if the shape has no size or its mesh cannot be read.
    """
    points = None if shape.geometry is None else _make_points(robot, shape.geometry)
    return None if points is None else transform_to_link(points, shape)


def transform_to_link(points: Array, shape: Visual | Collision) -> Array:
    """Transform points of a shape's geometry to the frame of its link [m], shape (n, 3)."""
    pose = make_pose(shape.origin)
    moved: Array = points @ np.array(pose.rotation).T + np.array(pose.translation)
    return moved


def _make_points(robot: Robot, geometry: Geometry) -> Array | None:
    if isinstance(geometry, Box):
        return _make_corners([edge / 2 for edge in geometry.size])
    if isinstance(geometry, Sphere):
        return _make_corners([geometry.radius] * 3)
    if isinstance(geometry, Cylinder | Cone):
        return _make_corners([geometry.radius, geometry.radius, geometry.length / 2])
    if isinstance(geometry, Ellipsoid):
        return _make_corners(geometry.radii)
    if isinstance(geometry, Capsule):
        reach = geometry.length / 2 + geometry.radius
        return _make_corners([geometry.radius, geometry.radius, reach])
    if isinstance(geometry, Mesh) and robot.source is not None:
        try:
            return load_named(robot.source, geometry.filename, geometry.scale).vertices
        except UrdftoolError:
            return None
    return None


def _make_corners(half: Sequence[float]) -> Array | None:
    if min(half) <= 0:
        return None
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners: Array = signs * np.array(half)
    return corners
