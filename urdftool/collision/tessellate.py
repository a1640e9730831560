"""Primitives as pieces, with triangles fine enough to measure distances to."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..meshes.mesh import Points
from ..meshes.tessellate import tessellate
from .piece import Piece


def primitive(
    kind: str, size: Sequence[float], rotation: Points, centre: Sequence[float] | Points
) -> Piece:
    """A box, cylinder, capsule or sphere, with its triangles.

    Args:
        kind: ``"box"``, ``"cylinder"``, ``"capsule"`` or ``"sphere"``.
        size: Lengths [m], as ``Piece.size``.
        rotation: Its axes, as columns.
        centre: Its centre [m].
    """
    vertices, faces = tessellate(kind, size)
    turned = np.asarray(rotation, dtype=np.float64)
    middle = np.asarray(centre, dtype=np.float64)
    return Piece(kind, tuple(size), turned, middle, vertices @ turned.T + middle, faces)
