"""Points and triangles as bytes, for caches; they are checked when they are read."""

from __future__ import annotations

import numpy as np

from .mesh import Faces, Points


def encode_triangles(points: Points, faces: Faces) -> list[bytes]:
    """Return points (n, 3) and triangles of them (m, 3) as bytes."""
    return [np.ascontiguousarray(points, "<f8").tobytes(), faces.astype("<i4").tobytes()]


def decode_triangles(points: bytes, faces: bytes) -> tuple[Points, Faces]:
    """Return the points and triangles of :func:`encode_triangles`.

    Raises:
        ValueError: A coordinate is not finite, or a triangle has a point that does not exist.
    """
    vertices = decode_numbers(points, 3)
    triangles = np.frombuffer(faces, "<i4").reshape(-1, 3).astype(np.int64)
    check_triangles(vertices, triangles)
    return vertices, triangles


def check_triangles(points: Points, faces: Faces) -> None:
    """Check that points are finite, and that triangles have no others.

    Raises:
        ValueError: They are not.
    """
    if not np.isfinite(points).all():
        raise ValueError("a number is not finite")
    if len(faces) and not 0 <= faces.min() <= faces.max() < len(points):
        raise ValueError("a triangle has a point that does not exist")


def decode_numbers(data: bytes, *shape: int) -> Points:
    """Return the rows of an array of finite numbers.

    Raises:
        ValueError: A number is not finite, or the bytes are not a number of rows.
    """
    numbers: Points = np.frombuffer(data, "<f8").reshape(-1, *shape).copy()
    if not np.isfinite(numbers).all():
        raise ValueError("a number is not finite")
    return numbers
