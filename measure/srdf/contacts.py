"""Contacts of links at many poses: spheres around parts of the shapes first, then FCL.

Two links touch at a pose only if two of their spheres do, so all poses count, also those at which
FCL is not asked.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import fcl
import numpy as np

from urdftool.geometry.mesh import Array, Points
from urdftool.model.elements import Robot
from urdftool.srdf.shapes import LinkShape, Solid, make_collider, read_shapes

from .placement import Frames

PARTS = 24
"""Spheres around the triangles of a mesh, and largest number of cells of a primitive."""

SLACK = 1e-3
"""Distance of spheres [m] below which FCL is asked; above the rounding of single precision."""

_AT_ONCE = 4000


@dataclass(frozen=True)
class LinkSolids:
    """Shapes of a link.

    Attributes:
        centers: Centers of spheres that contain them [m], shape (k, 3).
        radii: Radii of the spheres [m], shape (k,).
        whole: Center and radius of a sphere that contains all of them [m].
        objects: Objects of FCL, with the pose of their shape in the link.
    """

    centers: Points
    radii: Array
    whole: tuple[Array, float]
    objects: list[tuple[Any, Array, Array]]


def make_solids(robot: Robot, name: str) -> LinkSolids | None:
    """Return the shapes of a link; None if one cannot be read."""
    shape: LinkShape = read_shapes(robot, name)
    if shape.problem or not shape.solids:
        return None
    spheres = [sphere for solid in shape.solids for sphere in _cover(solid)]
    objects = []
    for solid in shape.solids:
        geometry, rotation, translation = make_collider(solid)
        objects.append((fcl.CollisionObject(geometry, fcl.Transform()), rotation, translation))
    centers, radii = zip(*spheres, strict=True)
    spots, reach = np.array(centers), np.array(radii)
    middle = (spots.max(axis=0) + spots.min(axis=0)) / 2
    whole = middle, float((np.linalg.norm(spots - middle, axis=1) + reach).max())
    return LinkSolids(spots, reach, whole, objects)


def _cover(solid: Solid) -> Iterator[tuple[Array, float]]:
    """Yield spheres that contain a shape."""
    if solid.kind == "mesh":
        yield from _split(solid.vertices[solid.faces], PARTS)
        return
    size = np.array(solid.size)
    half = {
        "box": lambda: size / 2,
        "sphere": lambda: np.repeat(size, 3),
        "ellipsoid": lambda: size,
        "cylinder": lambda: np.array([size[0], size[0], size[1] / 2]),
        "cone": lambda: np.array([size[0], size[0], size[1] / 2]),
        "capsule": lambda: np.array([size[0], size[0], size[1] / 2 + size[0]]),
    }[solid.kind]()
    side = max(float(half.min()), float(half.max()) / 6)
    counts = np.ceil(half / side - 1e-9).astype(int)
    cell = half / counts
    for index in np.ndindex(*counts):
        center = -half + (2 * np.array(index) + 1) * cell
        yield solid.rotation @ center + solid.translation, float(np.linalg.norm(cell))


def _split(corners: Points, parts: int) -> Iterator[tuple[Array, float]]:
    """Yield spheres around halves of halves of triangles, shape (n, 3, 3)."""
    points = corners.reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    if parts > 1 and len(corners) > 1:
        middle = corners.mean(axis=1)
        order = np.argsort(middle[:, int(np.argmax(np.ptp(middle, axis=0)))])
        half, left = len(order) // 2, parts // 2
        yield from _split(corners[order[:half]], left)
        yield from _split(corners[order[half:]], parts - left)
        return
    center = (low + high) / 2
    yield center, float(np.linalg.norm(points - center, axis=1).max())


def measure_gaps(a: LinkSolids, b: LinkSolids, frames: Frames, names: tuple[str, str]) -> Array:
    """Return a lower bound of the distance of two links at each pose [m], shape (n,).

    It is that of the spheres around both; where these meet, that of the spheres of their parts.
    """
    ends = [
        frames[name][0] @ solids.whole[0] + frames[name][1]
        for solids, name in zip((a, b), names, strict=True)
    ]
    gaps: Array = np.linalg.norm(ends[0] - ends[1], axis=1) - a.whole[1] - b.whole[1]
    near = np.nonzero(gaps < SLACK)[0]
    placed = {name: (frames[name][0][near], frames[name][1][near]) for name in names}
    if len(near):
        gaps[near] = _measure_parts(a, b, placed, names)
    return gaps


def _measure_parts(a: LinkSolids, b: LinkSolids, frames: Frames, names: tuple[str, str]) -> Array:
    """Return the smallest distance of the spheres of two links at each pose [m], shape (n,)."""
    spots = []
    for solids, name in ((a, names[0]), (b, names[1])):
        rotation, translation = frames[name]
        spots.append(solids.centers @ rotation.transpose(0, 2, 1) + translation[:, None])
    reach = (a.radii[:, None] + b.radii[None]).astype(np.float32)
    gaps: Array = np.empty(len(spots[0]))
    for start in range(0, len(gaps), _AT_ONCE):
        one, other = (part[start : start + _AT_ONCE] for part in spots)
        middle = one.mean(axis=1, keepdims=True)
        one, other = (one - middle).astype(np.float32), (other - middle).astype(np.float32)
        squared = (one * one).sum(2)[:, :, None] + (other * other).sum(2)[:, None]
        squared -= 2 * (one @ other.transpose(0, 2, 1))
        distance = np.sqrt(np.maximum(squared, 0.0)) - reach
        gaps[start : start + _AT_ONCE] = distance.reshape(len(one), -1).min(axis=1)
    return gaps


_REQUEST, _DISTANCE = fcl.CollisionRequest(), fcl.DistanceRequest()


def put(solids: LinkSolids, frame: tuple[Array, Array], row: int) -> None:
    """Put the objects of FCL of a link at one of its poses."""
    rotation, translation = frame[0][row], frame[1][row]
    for item, turn, shift in solids.objects:
        item.setTransform(fcl.Transform(rotation @ turn, rotation @ shift + translation))


def is_contact(a: LinkSolids, b: LinkSolids) -> bool:
    """Tell whether two links touch where they were put."""
    return any(
        fcl.collide(one, other, _REQUEST, fcl.CollisionResult()) > 0
        for one, _, _ in a.objects
        for other, _, _ in b.objects
    )


def measure_distance(a: LinkSolids, b: LinkSolids) -> float:
    """Return the distance of two links where they were put [m]; at most 0 in contact."""
    return min(
        float(fcl.distance(one, other, _DISTANCE, fcl.DistanceResult()))
        for one, _, _ in a.objects
        for other, _, _ in b.objects
    )
