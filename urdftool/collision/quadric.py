"""Fewer triangles for the same shape, by quadric error; closed surfaces stay closed.

By meshoptimizer, which collapses the cheapest edge first, leaves vertices where they are and never
joins or tears surfaces. (fast-simplification grows a limit of the error from pass to pass instead;
on meshes of machined parts it stops far above the target, with ten times the error.)
"""

from __future__ import annotations

import numpy as np

from ..errors import MissingDependency
from ..meshes.mesh import Faces, Points
from ..meshes.solid import collapsed

_ANY_ERROR = 1e9


def simplify(vertices: Points, faces: Faces, target: int) -> tuple[Points, Faces]:
    """The surface with at most so many triangles, or as few as its shape allows.

    Args:
        vertices: Points [m], each once.
        faces: Triangles.
        target: Triangles to keep.

    Raises:
        MissingDependency: meshoptimizer is not installed.
    """
    if len(faces) <= target:
        return vertices, faces
    try:
        import meshoptimizer
    except ImportError as error:
        raise MissingDependency(
            "meshoptimizer is not installed; pip install meshoptimizer"
        ) from error
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    # the library works in single precision, about the origin
    unit = (vertices - (low + high) / 2) / max(float((high - low).max()), 1e-300)
    kept = np.zeros(faces.size, dtype=np.uint32)
    count = meshoptimizer.simplify(
        kept,
        np.ascontiguousarray(faces.reshape(-1), dtype=np.uint32),
        np.ascontiguousarray(unit, dtype=np.float32),
        target_index_count=3 * int(target),
        target_error=_ANY_ERROR,
    )
    found = kept[:count].reshape(-1, 3).astype(np.int64)
    found = found[~collapsed(found)]
    if not len(found):
        return vertices, faces
    used = np.unique(found)
    number = np.full(len(vertices), -1)
    number[used] = np.arange(len(used))
    return vertices[used], number[found].astype(np.int64)
