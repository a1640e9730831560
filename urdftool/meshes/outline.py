"""How far a mesh reaches: its outermost points, read faster than its triangles.

``load`` reads a mesh for those who need its faces. A question of size or of contact needs points
alone, and of those only the outermost: what lies inside the convex hull changes neither the box
around a mesh nor the distance between two hulls. So this module reads positions straight from the
bytes and keeps, of as many as there may be, the extreme ones in some hundred directions. Units and
axes are those of :func:`urdftool.meshes.load.load_mesh`.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import MeshError
from .positions import Columns, columns_of, is_much, moved, obj_columns, stl_columns

if TYPE_CHECKING:
    from ..source.description import GltfUp

Vector = tuple[float, float, float]
Rotation = Sequence[Sequence[float]]

Reach = Callable[[float, float, float], float]
"""How far something reaches along a direction [m]."""

LARGEST = 64_000_000
"""Bytes of a file that is read; more is left to those who must."""

_DIRECTIONS = 90
_KEPT = 50_000  # points of a mesh that are all kept; of a larger one only the outermost
_ALIGNED = 1e-12


class Outline:
    """The points of a mesh in the frame of its file, unscaled.

    Attributes:
        low: The smallest corner of the box around it, along the axes of the file.
        high: The largest.
    """

    def __init__(self, columns: Columns) -> None:
        """Take the points; the outermost are looked for when they are asked for."""
        self._columns = columns
        self._points: list[Vector] | None = None
        self._boxes: dict[tuple[Sequence[float], Rotation], tuple[Vector, Vector]] = {}
        self.low, self.high = _box(columns)
        if len(columns[0]) > _KEPT:
            x, y, z = zip(*self.points, strict=True)
            self._columns = x, y, z

    @property
    def points(self) -> list[Vector]:
        """The outermost points; their hull lies inside that of the mesh, and is all but as large.

        The box around them is that around the mesh.
        """
        if self._points is None:
            self._points = extremes(self._columns)
        return self._points

    def box(self, scale: Sequence[float], rotation: Rotation, at: Vector) -> tuple[Vector, Vector]:
        """The box around the mesh, once scaled, turned and moved [m]: two corners."""
        key = tuple(scale), tuple(map(tuple, rotation))
        if key not in self._boxes:
            self._boxes[key] = self._box(*key)
        (a, b, c), (d, e, f) = self._boxes[key]
        x, y, z = at
        return (a + x, b + y, c + z), (d + x, e + y, f + z)

    def _box(self, scale: Sequence[float], rotation: Rotation) -> tuple[Vector, Vector]:
        rows = [[r * factor for r, factor in zip(row, scale, strict=True)] for row in rotation]
        if any(sum(abs(entry) > _ALIGNED for entry in row) > 1 for row in rotation):
            x, y, z = ((*row, 0.0) for row in rows)
            return _box(moved(self._columns, (x, y, z)))  # type: ignore[arg-type]
        low, high = [0.0] * 3, [0.0] * 3
        for axis, row in enumerate(rows):
            for factor, a, d in zip(row, self.low, self.high, strict=True):
                low[axis] += min(factor * a, factor * d)
                high[axis] += max(factor * a, factor * d)
        return (low[0], low[1], low[2]), (high[0], high[1], high[2])


def outline(path: str | Path, gltf_up: GltfUp = "y") -> Outline | None:
    """The points of a mesh file; of a glTF file with the axis up that is said to be.

    None where the file cannot be read, is larger than :data:`LARGEST`, or holds no finite point.
    """
    file = Path(path)
    try:
        if not file.is_file() or file.stat().st_size > LARGEST:
            return None  # a device or a pipe is read without end
        suffix = file.suffix.lower()
        columns = _gltf(file, gltf_up) if suffix in _GLTF else _READERS[suffix](file)
    # whatever a damaged file makes arithmetic raise: here it is only a file that says nothing
    except (MeshError, OSError, ValueError, LookupError, TypeError, AttributeError, struct.error):
        return None
    except (ArithmeticError, RecursionError):
        return None
    if columns is None or not len(columns[0]) or not all(map(_is_finite, columns)):
        return None
    return Outline(columns)


def _is_finite(column: Sequence[float]) -> bool:
    if is_much(0.013 * len(column)):
        import numpy as np

        return bool(np.isfinite(np.asarray(column)).all())
    return all(map(math.isfinite, column))


def _box(columns: Columns) -> tuple[Vector, Vector]:
    if is_much(0.08 * len(columns[0])):
        import numpy as np

        arrays = [np.asarray(column) for column in columns]
        a, b, c = (float(array.min()) for array in arrays)
        d, e, f = (float(array.max()) for array in arrays)
    else:
        a, b, c = map(min, columns)
        d, e, f = map(max, columns)
    return (a, b, c), (d, e, f)


def extremes(columns: Columns) -> list[Vector]:
    """Those points that reach furthest in some direction, all six along the axes among them."""
    if len(columns[0]) > _KEPT or is_much(0.2 * len(columns[0])):
        return _extremes_by_numpy(columns)
    points = list(dict.fromkeys(zip(*columns, strict=True)))
    if len(points) <= 2 * _DIRECTIONS:
        return points
    ways = directions()
    if is_much(0.056 * len(ways) * len(points)):
        return _extremes_by_numpy(columns)
    kept = set()
    for a, b, c in ways:
        reached = [a * x + b * y + c * z for x, y, z in points]
        kept.add(reached.index(max(reached)))
    return [points[row] for row in sorted(kept)]


def _extremes_by_numpy(columns: Columns) -> list[Vector]:
    import numpy as np

    from .extremes import extreme_points

    points = np.stack([np.asarray(column, dtype=np.float64) for column in columns], axis=1)
    return [(x, y, z) for x, y, z in extreme_points(points).tolist()]


@cache
def directions() -> list[Vector]:
    """Unit vectors: the axes, and a spiral that covers the sphere evenly."""
    ways = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
    ways += [(-x, -y, -z) for x, y, z in ways]
    for number in range(_DIRECTIONS):
        z = 1 - (2 * number + 1) / _DIRECTIONS
        turn = (number + 0.5) * math.pi * (1 + math.sqrt(5))
        radius = math.sqrt(1 - z * z)
        ways.append((radius * math.cos(turn), radius * math.sin(turn), z))
    return ways


def _dae(path: Path) -> Columns | None:
    from .collada_points import collada_columns

    return collada_columns(path)


def _gltf(path: Path, gltf_up: GltfUp) -> Columns | None:
    from .gltf_points import gltf_columns

    return gltf_columns(path, gltf_up)


def _ply(path: Path) -> Columns | None:
    from .load import load_mesh

    return columns_of(load_mesh(path).vertices)


_READERS = {
    ".stl": stl_columns,
    ".obj": obj_columns,
    ".ply": _ply,
    ".dae": _dae,
}
_GLTF = (".gltf", ".glb")


def reach_of(points: Sequence[Vector]) -> tuple[Vector, float, Reach]:
    """Points as a convex shape: their middle, the radius about it [m], and their support function.

    The function gives how far the hull reaches from the middle along a direction.
    """
    x, y, z = ((min(column) + max(column)) / 2 for column in zip(*points, strict=True))
    centred: list[Vector] = [(a - x, b - y, c - z) for a, b, c in points]
    radius = max(math.hypot(*point) for point in centred)

    def reach(x: float, y: float, z: float) -> float:
        return max([a * x + b * y + c * z for a, b, c in centred])

    return (x, y, z), radius, reach
