"""Whether the surface of a mesh is closed, looks outwards and has no slivers.

Small files are looked at in plain Python, sooner than numpy is imported; large ones by
:mod:`urdftool.meshes.surface_arrays`, which says the same. :mod:`urdftool.meshes.solid` says more
of a mesh, for those who compute with it.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from ..errors import MeshError
from .facts import HEADER_BYTES, TRIANGLE_BYTES, stl_facts
from .positions import is_much
from .wavefront_text import parse

LARGEST = 32_000_000
"""Bytes of a file whose surface is looked at."""

WELD_TOLERANCE = 1e-6
"""Points nearer than this part of the mesh's largest extent may be rounded copies of one."""

Point = tuple[float, ...]
Triangle = tuple[Point, Point, Point]


class Surface(NamedTuple):
    """What can be said of the surface of a mesh.

    Attributes:
        faces: Triangles.
        open_edges: Edges with an odd number of triangles; 0 for a closed surface.
        flat: Triangles without an area.
        consistent: Whether neighbours are wound the same way round.
        volume: Signed volume in the file's unit cubed; of no meaning for an open surface.
    """

    faces: int
    open_edges: int
    flat: int
    consistent: bool
    volume: float

    @property
    def inside_out(self) -> bool:
        """Whether a closed surface looks inwards."""
        return not self.open_edges and self.consistent and self.volume < 0


def surface(path: str | Path) -> Surface | None:
    """The surface of a mesh file; None where it cannot be read or is larger than LARGEST."""
    file = Path(path)
    try:
        size = file.stat().st_size
        if size > LARGEST:
            return None
        reader = _READERS.get(file.suffix.lower())
        if reader is not None and not is_much(0.1 * size):
            triangles = reader(file)
            if triangles and _are_finite(triangles):
                return surface_of(triangles)
    except (MeshError, OSError, ValueError, LookupError, OverflowError):
        pass  # what is wrong with it is for the others to say
    from .surface_arrays import surface_by_arrays

    return surface_by_arrays(file)


def surface_of(triangles: Sequence[Triangle]) -> Surface:
    """The surface that triangles make, in plain Python."""
    points = {point for triangle in triangles for point in triangle}
    extent = max(max(column) - min(column) for column in zip(*points, strict=True))
    grid = (WELD_TOLERANCE * extent) or 1.0
    best = _Welded(triangles, None, grid)
    for shift in (0.0, 0.5):
        # two points of one place may lie on two sides of a cell's border, but not of both grids'
        if not best.open_edges:
            break
        welded = _Welded(triangles, shift, grid)
        if welded.open_edges < best.open_edges:
            best = welded
    return Surface(len(triangles), best.open_edges, *best.measured(1e-12 * extent**2))


class _Welded:
    """Triangles on points that occur once each: equal ones are one, or those in one cell."""

    def __init__(self, triangles: Sequence[Triangle], shift: float | None, grid: float) -> None:
        number: dict[Point, int] = {}
        self.points: list[Point] = []
        rows = {}
        for point in dict.fromkeys(point for triangle in triangles for point in triangle):
            cell = point
            if shift is not None:
                cell = tuple(math.floor(value / grid + shift) for value in point)
            row = rows[point] = number.setdefault(cell, len(number))
            if row == len(self.points):
                self.points.append(point)
        self.faces = [(rows[a], rows[b], rows[c]) for a, b, c in triangles]
        self.walked: dict[tuple[int, int], int] = {}
        for a, b, c in self.faces:
            if a != b and b != c and c != a:
                for edge in ((a, b), (b, c), (c, a)):
                    self.walked[edge] = self.walked.get(edge, 0) + 1
        odd = sum(
            (times + self.walked.get((b, a), 0)) % 2 * (1 if (b, a) not in self.walked else 0.5)
            for (a, b), times in self.walked.items()
        )
        self.open_edges = int(odd)

    def measured(self, least: float) -> tuple[int, bool, float]:
        """Triangles with no area, whether all are wound the same way round, and the volume."""
        x, y, z = (
            math.fsum(column) / len(self.points) for column in zip(*self.points, strict=True)
        )
        centred = [(a - x, b - y, c - z) for a, b, c in self.points]
        flat, volume = 0, 0.0
        for one, two, three in self.faces:
            a, b, c = centred[one]
            d, e, f = centred[two]
            g, h, i = centred[three]
            volume += a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g)
            d, e, f, g, h, i = d - a, e - b, f - c, g - a, h - b, i - c
            flat += math.hypot(e * i - f * h, f * g - d * i, d * h - e * g) <= least
        cycle = all(self.walked.get((b, a)) == times for (a, b), times in self.walked.items())
        return flat, cycle, volume / 6


def _are_finite(triangles: Sequence[Triangle]) -> bool:
    return all(math.isfinite(sum(point)) for triangle in triangles for point in triangle)


def _stl(path: Path) -> list[Triangle]:
    """The triangles of a binary file; none for any other."""
    facts = stl_facts(path)
    if not facts.triangles or facts.bytes < (facts.expected_bytes or 0):
        return []
    data = path.read_bytes()[HEADER_BYTES : HEADER_BYTES + TRIANGLE_BYTES * facts.triangles]
    return [(v[0:3], v[3:6], v[6:9]) for v in struct.iter_unpack("<12x9f2x", data)]


def _obj(path: Path) -> list[Triangle]:
    written = parse(path)
    points: list[Point] = []
    for text in written.points:
        x, y, z = text.split()[:3]
        points.append((float(x), float(y), float(z)))
    corners = [points[row] for run in written.runs for row in run.corners]
    return list(zip(corners[0::3], corners[1::3], corners[2::3], strict=True))


_READERS = {".stl": _stl, ".obj": _obj}
