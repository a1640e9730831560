"""Where the points of a mesh are, as three columns of numbers: read without numpy.

numpy takes as long to import as a small robot takes to be checked. So points are columns of plain
numbers here, and numpy does the arithmetic only where there is so much of it that this pays.
"""

from __future__ import annotations

import re
import struct
import sys
from array import array
from collections.abc import Iterable, Sequence, Set
from operator import neg
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .facts import HEADER_BYTES, TRIANGLE_BYTES, stl_facts

if TYPE_CHECKING:
    from .mesh import Points

Columns = tuple[Sequence[float], Sequence[float], Sequence[float]]
"""The x, the y and the z of points."""

Affine = tuple[tuple[float, float, float, float], ...]
"""Three rows ``(a, b, c, t)`` that map a point to ``(a, b, c) · point + t``."""

UPRIGHT: Affine = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))

_patience = [60_000.0]  # [µs] that plain Python may take in all: what the import of numpy takes
_FEW = 100.0


def is_much(microseconds: float) -> bool:
    """Whether what would take plain Python so long is to be done by numpy."""
    if "numpy" in sys.modules:
        return microseconds > _FEW
    _patience[0] -= microseconds
    return _patience[0] < 0


def expect(microseconds: float) -> None:
    """Say beforehand what plain Python would take for all that is to come."""
    if microseconds > _patience[0]:
        _patience[0] = 0.0


def joined(found: Sequence[Columns]) -> Columns:
    """The points of several."""
    if len(found) == 1:
        return found[0]
    x, y, z = (array("d") for _ in range(3))
    for columns in found:
        for whole, part in zip((x, y, z), columns, strict=True):
            whole.extend(part)
    return x, y, z


def moved(columns: Columns, matrix: Affine) -> Columns:
    """Points that are mapped."""
    if matrix == UPRIGHT:
        return columns
    aligned = all(sum(map(bool, row[:3])) == 1 for row in matrix)
    if is_much((0.08 if aligned else 0.22) * len(columns[0])):
        import numpy as np

        points = np.stack([np.asarray(column, dtype=np.float64) for column in columns])
        rows = np.array(matrix)
        # einsum, as a product of matrices wakes the other cores for nothing
        return columns_of((np.einsum("ij,jk->ik", rows[:, :3], points) + rows[:, 3:]).T)
    x, y, z = (_row(columns, row) for row in matrix)
    return x, y, z


def _row(columns: Columns, row: tuple[float, float, float, float]) -> Sequence[float]:
    a, b, c, t = row
    some = [(factor, column) for factor, column in zip((a, b, c), columns, strict=True) if factor]
    if len(some) == 1:
        ((factor, column),) = some
        if t == 0.0 and abs(factor) == 1.0:
            return column if factor > 0 else array("d", map(neg, column))
        return array("d", [factor * value + t for value in column])
    return array("d", [a * x + b * y + c * z + t for x, y, z in zip(*columns, strict=True)])


def product(one: Affine, other: Affine) -> Affine:
    """The map that applies ``other`` first and ``one`` then."""
    below = (*other, (0.0, 0.0, 0.0, 1.0))
    return tuple(
        tuple(sum(row[k] * below[k][j] for k in range(4)) for j in range(4))  # type: ignore[misc]
        for row in one
    )


def columns_of(points: Points) -> Columns:
    """The columns of an array of shape (n, 3)."""
    x, y, z = (array("d", points[:, axis].astype(float).tobytes()) for axis in range(3))
    return x, y, z


def every_third(values: Sequence[float]) -> Columns:
    """The columns of numbers that stand point after point: x, y, z, x, y, z."""
    return values[0::3], values[1::3], values[2::3]


def numbers(words: Iterable[Any]) -> array[float]:
    """Words as numbers.

    Raises:
        ValueError: One is none.
    """
    return array("d", map(float, words))


def stl_columns(path: Path) -> Columns | None:
    """The corners of an STL file's triangles; None for one that is none, or cut off.

    Raises:
        OSError: It cannot be read.
        ValueError: A corner of a text file is not three numbers.
    """
    facts = stl_facts(path)
    if facts.kind == "ascii":
        rows = _VERTEX.findall(path.read_bytes())
        return every_third(numbers(word for row in rows for word in row))
    if facts.kind != "binary" or not facts.triangles or facts.bytes < (facts.expected_bytes or 0):
        return None
    if is_much(0.3 * facts.triangles):
        import numpy as np

        count = TRIANGLE_BYTES * facts.triangles
        raw = np.fromfile(path, dtype=np.uint8, count=count, offset=HEADER_BYTES)
        corners = raw.reshape(-1, TRIANGLE_BYTES)[:, 12:48].copy().view("<f4")
        return columns_of(corners.reshape(-1, 3))
    data = path.read_bytes()[HEADER_BYTES : HEADER_BYTES + TRIANGLE_BYTES * facts.triangles]
    nine = list(zip(*struct.iter_unpack("<12x9f2x", data), strict=True))
    return (
        nine[0] + nine[3] + nine[6],
        nine[1] + nine[4] + nine[7],
        nine[2] + nine[5] + nine[8],
    )


_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


def chosen(columns: Columns, rows: Set[int]) -> Columns:
    """Select the points of which a face has a corner, given by their numbers.

    Numbers beyond the points are left out: a file with such faces is refused by those that draw it.
    """
    count = len(columns[0])
    if len(rows) == count and min(rows, default=0) >= 0 and max(rows, default=0) < count:
        return columns
    kept = sorted(row for row in rows if 0 <= row < count)
    if len(kept) == count:
        return columns
    x, y, z = (array("d", [column[row] for row in kept]) for column in columns)
    return x, y, z


def obj_columns(path: Path) -> Columns | None:
    """The points of an OBJ file's faces; None where there are none.

    Raises:
        OSError: It cannot be read.
        ValueError: A point is not three numbers.
    """
    lines = _CONTINUED.sub(b" ", path.read_bytes()).splitlines()
    rows = [line.split(None, 4)[1:4] for line in lines if line.startswith((b"v ", b"v\t"))]
    if not rows:
        return None
    x, y, z = (numbers(column) for column in zip(*rows, strict=True))
    return chosen((x, y, z), _obj_corners(lines))


_CONTINUED = re.compile(rb"\\\r?\n")
_CORNER = re.compile(rb"\s(-?\d+)")


def _obj_corners(lines: list[bytes]) -> set[int]:
    """The numbers of the points that the faces of an OBJ file have, from 0.

    A corner is written ``point/texture/normal``; a negative number counts back from the last point
    above the face.
    """
    faces = [line for line in lines if line.startswith((b"f ", b"f\t"))]
    words = set(_CORNER.findall(b"\n".join([b"", *faces])))
    found = {int(word) - 1 for word in words if not word.startswith(b"-")}
    if len(found) == len(words):
        return found
    above = 0
    for line in lines:
        if line.startswith((b"v ", b"v\t")):
            above += 1
        elif line.startswith((b"f ", b"f\t")):
            found |= {above + int(word) for word in _CORNER.findall(line) if int(word) < 0}
    return found
