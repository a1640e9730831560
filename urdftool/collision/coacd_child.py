"""The call of CoACD, made in an isolated process: on some inputs CoACD ends the one it runs in."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..extras import missing
from ..geometry.mesh import Faces, Points


def decompose(vertices: Points, faces: Faces, options: dict[str, Any]) -> list[Points]:
    """Decompose a closed surface.

    Args:
        vertices: Shape (n, 3).
        faces: Shape (m, 3).
        options: Of ``coacd.run_coacd``.

    Returns:
        The points of each piece, shape (k, 3).

    Raises:
        MissingDependency: coacd is not installed.
    """
    try:
        import coacd
    except ModuleNotFoundError:
        raise missing("coacd", "convex decomposition") from None
    coacd.set_log_level("error")
    parts = coacd.run_coacd(coacd.Mesh(vertices, faces), **options)
    return [np.asarray(points, dtype=np.float64) for points, _ in parts]
