"""Extreme points of a mesh, read without its faces.

``load`` reads a mesh with its faces. Size and contact depend on the convex hull alone: points
inside it change neither the bounding box nor the distance between two hulls. So this module reads
positions directly from the bytes and keeps the extreme ones in about a hundred directions. Units
and axes are those of :func:`load.load_mesh`.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..errors import MeshError
from .mesh import Points
from .penetration import SupportFunction
from .points import read_obj_points, read_stl_points

if TYPE_CHECKING:
    from ..source.description import GltfUp

Vector = tuple[float, float, float]
Rotation = Sequence[Sequence[float]]

LARGEST = 64_000_000
"""Size of the largest file that is read [bytes]. Chosen, no source."""

_DIRECTIONS = 90
"""Points of the unit sphere in whose directions extreme points are kept; chosen, no source."""
_MANY = 50_000  # larger meshes keep each position once, of which an STL file has about six; chosen
_FEW = 3_000  # meshes up to this size are deduplicated first; chosen
_ALIGNED = 1e-12
"""Component of a unit vector [1] below which it is rounding of zero: 10^4 times that of doubles.
Chosen, no source."""
_BLOCK = 2048  # small enough that the product with 32 directions stays on one core; chosen


class ConvexPoints:
    """Points of a mesh in the frame of its file, unscaled.

    Attributes:
        low: Lower corner of the bounding box, along the axes of the file.
        high: Upper corner.
    """

    def __init__(self, points: Points) -> None:
        """Store the points, shape (n, 3); extreme points are selected on demand."""
        self._all = drop_repeated(points) if len(points) > _MANY else points
        self._outermost: list[Vector] | None = None
        self._boxes: dict[tuple[Sequence[float], Rotation], tuple[Vector, Vector]] = {}
        self.low, self.high = _compute_box(points)

    @property
    def points(self) -> list[Vector]:
        """Return the extreme points; their hull lies inside the mesh's hull and is nearly as large.

        Both have the same bounding box.
        """
        if self._outermost is None:
            points = self._all
            if len(points) <= _FEW:
                points = drop_repeated(points)
            self._outermost = [(x, y, z) for x, y, z in select_extreme_points(points).tolist()]
        return self._outermost

    def compute_box(
        self, scale: Sequence[float], rotation: Rotation, at: Vector
    ) -> tuple[Vector, Vector]:
        """Compute lower and upper corner of the transformed mesh's bounding box [m].

        Args:
            scale: Factors along the axes of the file, applied first.
            rotation: Rotation matrix.
            at: Translation [m].
        """
        key = tuple(scale), tuple(map(tuple, rotation))
        if key not in self._boxes:
            self._boxes[key] = self._transform_box(*key)
        (a, b, c), (d, e, f) = self._boxes[key]
        x, y, z = at
        return (a + x, b + y, c + z), (d + x, e + y, f + z)

    def find_outermost(self, scale: Sequence[float], direction: Sequence[float]) -> Vector:
        """Find the point that is farthest in a direction, scaled.

        Args:
            scale: Factors along the axes of the file, applied first.
            direction: The direction, along the axes of the file.
        """
        factors = np.array(scale)
        x, y, z = self._all[int((self._all @ (factors * np.array(direction))).argmax())] * factors
        return float(x), float(y), float(z)

    def _transform_box(self, scale: Sequence[float], rotation: Rotation) -> tuple[Vector, Vector]:
        rows = [[r * factor for r, factor in zip(row, scale, strict=True)] for row in rotation]
        if any(sum(abs(entry) > _ALIGNED for entry in row) > 1 for row in rotation):
            return _compute_box(np.einsum("ij,kj->ki", np.array(rows), self._all))
        low, high = [0.0] * 3, [0.0] * 3
        for axis, row in enumerate(rows):
            for factor, a, d in zip(row, self.low, self.high, strict=True):
                low[axis] += min(factor * a, factor * d)
                high[axis] += max(factor * a, factor * d)
        return (low[0], low[1], low[2]), (high[0], high[1], high[2])


def read_convex_points(path: str | Path, gltf_up: GltfUp = "y") -> ConvexPoints | None:
    """Read the points of a mesh file.

    Returns:
        None if the file cannot be read, is larger than :data:`LARGEST`, or has no points or a point
        that is not finite.
    """
    file = Path(path)
    try:
        if not file.is_file() or file.stat().st_size > LARGEST:
            return None  # reading a device or a pipe would not end
        suffix = file.suffix.lower()
        points = _read_gltf(file, gltf_up) if suffix in _GLTF else _READERS[suffix](file)
    # parsers raise arbitrary exceptions for damaged files, which have no points
    except (MeshError, OSError, ValueError, LookupError, TypeError, AttributeError, struct.error):
        return None
    except (ArithmeticError, RecursionError):
        return None
    if points is None or not len(points) or not np.isfinite(points).all():
        return None
    return ConvexPoints(points)


def _compute_box(points: Points) -> tuple[Vector, Vector]:
    (a, b, c), (d, e, f) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    return (a, b, c), (d, e, f)


def drop_repeated(points: Points) -> Points:
    """Return the first of equal points, shape (n, 3), in their order."""
    key = points @ (1.0, math.e, math.pi)  # equal points are neighbors in its order, but for chance
    order = key.argsort(kind="stable")
    is_first = np.ones(len(points), dtype=bool)
    is_first[1:] = (points[order[1:]] != points[order[:-1]]).any(axis=1)
    return points[np.sort(order[is_first])]


def select_extreme_points(points: Points) -> Points:
    """Select the extreme points of many directions, including all six along the axes.

    Args:
        points: Shape (n, 3); returned unchanged if at most twice as many as the directions.
    """
    if len(points) <= 2 * len(compute_directions()):
        return points
    points = np.ascontiguousarray(points)
    while len(points) > _BLOCK:
        blocks = [points[first : first + _BLOCK] for first in range(0, len(points), _BLOCK)]
        points = np.concatenate([_select_outermost(block) for block in blocks])
        if len(points) > 0.7 * sum(map(len, blocks)):
            break
    return _select_outermost(points) if len(points) <= _BLOCK else points


def _select_outermost(points: Points) -> Points:
    ways = np.array(compute_directions(), dtype=np.float32)
    centered = (points - points.mean(axis=0)).astype(np.float32)
    is_outermost = np.zeros(len(points), dtype=bool)  # np.unique would import numpy.ma
    for first in range(0, len(ways), 32):
        is_outermost[(centered @ ways[first : first + 32].T).argmax(axis=0)] = True
    return np.asarray(points[is_outermost])


@cache
def compute_directions() -> list[Vector]:
    """Return unit vectors: both directions of each axis, and an even spiral over the sphere."""
    ways = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
    ways += [(-x, -y, -z) for x, y, z in ways]
    for number in range(_DIRECTIONS):
        z = 1 - (2 * number + 1) / _DIRECTIONS
        turn = (number + 0.5) * math.pi * (1 + math.sqrt(5))
        radius = math.sqrt(1 - z * z)
        ways.append((radius * math.cos(turn), radius * math.sin(turn), z))
    return ways


def _read_dae(path: Path) -> Points | None:
    from .collada import read_points

    return read_points(path)


def _read_gltf(path: Path, gltf_up: GltfUp) -> Points | None:
    from .gltf import read_points

    return read_points(path, gltf_up)


def _read_ply(path: Path) -> Points | None:
    from .load import load_mesh

    return load_mesh(path).vertices


_READERS = {
    ".stl": read_stl_points,
    ".obj": read_obj_points,
    ".ply": _read_ply,
    ".dae": _read_dae,
}
_GLTF = (".gltf", ".glb")


def support_function_of(points: Sequence[Vector]) -> tuple[Vector, float, SupportFunction]:
    """Describe the convex hull of points by its support function.

    Returns:
        The center of the bounding box, the radius about it [m], and the support function relative
        to it [m].
    """
    x, y, z = ((min(column) + max(column)) / 2 for column in zip(*points, strict=True))
    centered: list[Vector] = [(a - x, b - y, c - z) for a, b, c in points]
    radius = max(math.hypot(*point) for point in centered)

    def reach(x: float, y: float, z: float) -> float:
        return max([a * x + b * y + c * z for a, b, c in centered])

    return (x, y, z), radius, reach
