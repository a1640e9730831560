"""Mesh points as arrays: transformed, selected, and read from STL and OBJ files without faces."""

from __future__ import annotations

import re
from collections.abc import Set
from pathlib import Path

import numpy as np

from .mesh import Array, Faces, Points
from .stl import read_corners
from .stl_header import read_stl_header

IDENTITY: Array = np.eye(4)


def transform_points(points: Points, matrix: Array) -> Points:
    """Map points, shape (n, 3), by an affine matrix, shape (4, 4)."""
    if np.array_equal(matrix, IDENTITY):
        return points
    # a matrix product would start threads on all cores
    mapped: Points = np.einsum("ij,kj->ki", matrix[:3, :3], points) + matrix[:3, 3]
    return mapped


def select_points(points: Points, rows: Set[int]) -> Points:
    """Select the points that faces use, given by their rows.

    Rows out of range are ignored; readers reject files with such faces.
    """
    used = np.fromiter(rows, dtype=np.int64, count=len(rows))
    is_used = np.zeros(len(points), dtype=bool)
    is_used[used[(used >= 0) & (used < len(points))]] = True
    return points if is_used.all() else points[is_used]


def select_used(points: Points, faces: Faces) -> tuple[Points, Faces]:
    """Select the points that faces use, in their order.

    The work grows with the faces, so that many parts may share the points of one file.

    Returns:
        The points and the faces as rows of them; both unchanged if a row is out of range.
    """
    if not faces.size or faces.min() < 0 or faces.max() >= len(points):
        return points, faces
    if faces.size * _SPARSE < len(points):
        rows, numbers = np.unique(faces, return_inverse=True)
        return points[rows], numbers.reshape(faces.shape).astype(np.int64)
    is_used = np.zeros(len(points), dtype=bool)
    is_used[faces.ravel()] = True
    if is_used.all():
        return points, faces
    return points[is_used], (np.cumsum(is_used) - 1)[faces]


_SPARSE = 16  # points per corner above which sorting the corners is faster than a mask


def as_points(values: object) -> Points:
    """Convert numbers or numeric strings, three per point, to an array of shape (n, 3).

    Raises:
        ValueError: One of them is not a number, or their count is not a multiple of three.
    """
    return np.array(values, dtype=np.float64).reshape(-1, 3)


def read_stl_points(path: Path) -> Points | None:
    """Read the corners of an STL file's triangles; None if it is not an STL file or is truncated.

    Raises:
        OSError: The file cannot be read.
        ValueError: A corner of a text file is not three numbers.
    """
    header = read_stl_header(path)
    whole = bool(header.triangles) and header.bytes >= (header.expected_bytes or 0)
    return read_corners(path, header) if header.kind == "ascii" or whole else None


def read_obj_points(path: Path) -> Points | None:
    """Read the points that the faces of an OBJ file use; None if there are none.

    Raises:
        OSError: The file cannot be read.
        ValueError: A point is not three numbers.
    """
    lines = _CONTINUED.sub(b" ", path.read_bytes()).splitlines()
    rows = [line.split(None, 4)[1:4] for line in lines if line.startswith((b"v ", b"v\t"))]
    return select_points(as_points(rows), _collect_obj_corners(lines)) if rows else None


_CONTINUED = re.compile(rb"\\\r?\n")
_CORNER = re.compile(rb"\s(-?\d+)")


def _collect_obj_corners(lines: list[bytes]) -> set[int]:
    """Collect the zero-based indices of the points that the faces of an OBJ file use.

    A corner is written ``point/texture/normal``; a negative index counts back from the last point
    above the face.
    """
    faces = [line for line in lines if line.startswith((b"f ", b"f\t"))]
    words = set(_CORNER.findall(b"\n".join([b"", *faces])))
    corners = {int(word) - 1 for word in words if not word.startswith(b"-")}
    if len(corners) == len(words):
        return corners
    above = 0
    for line in lines:
        if line.startswith((b"v ", b"v\t")):
            above += 1
        elif line.startswith((b"f ", b"f\t")):
            corners |= {above + int(word) for word in _CORNER.findall(line) if int(word) < 0}
    return corners
