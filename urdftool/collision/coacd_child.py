"""Call of CoACD in an isolated process: on some inputs CoACD terminates its process."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..extras import make_missing_error
from ..geometry.mesh import Faces, Points


def decompose(vertices: Points, faces: Faces, options: dict[str, Any]) -> list[Points]:
    """Decompose a closed surface into convex pieces; return the points of each piece, shape (k, 3).

    Args:
        vertices: Points, shape (n, 3).
        faces: Triangles, shape (m, 3).
        options: Arguments of ``coacd.run_coacd``.

    Raises:
        MissingDependency: coacd is not installed.
    """
    try:
        import coacd
    except ModuleNotFoundError:
        raise make_missing_error("coacd", "convex decomposition") from None
    coacd.set_log_level("error")
    parts = coacd.run_coacd(coacd.Mesh(vertices, faces), **options)
    return [np.asarray(points, dtype=np.float64) for points, _ in parts]
