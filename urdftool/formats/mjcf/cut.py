"""Meshes that collide as convex pieces: what cuts them is given from outside."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...geometry.mesh import Faces, Points


@dataclass(frozen=True)
class Cut:
    """Convex pieces that stand for a mesh, unscaled.

    Attributes:
        pieces: Points and triangles of each.
        error: Largest distance of the surfaces, relative to the diagonal of the mesh's box.
    """

    pieces: Sequence[tuple[Points, Faces]]
    error: float


Cutter = Callable[[Sequence[Path]], Mapping[Path, Cut | str]]
"""Cuts mesh files; one that cannot be cut has the reason in words."""
