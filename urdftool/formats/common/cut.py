"""Interface to the convex decomposition of collision meshes; the caller supplies the algorithm."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...geometry.mesh import Faces, Points


@dataclass(frozen=True)
class Cut:
    """Convex decomposition of a mesh, unscaled.

    Attributes:
        pieces: Vertices and triangles of each convex piece.
        error: Largest distance between the surfaces, relative to the diagonal of the mesh's
            bounding box.
    """

    pieces: Sequence[tuple[Points, Faces]]
    error: float


Cutter = Callable[[Sequence[Path]], Mapping[Path, Cut | str]]
"""Decomposes mesh files; a mesh that cannot be decomposed has a message instead."""
