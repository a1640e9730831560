"""Settings of a collision geometry."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

METHODS = ("auto", "primitive", "hull", "coacd", "simplify")

FEW_HULLS = 32
"""Largest number of convex pieces that ``auto`` creates from a mesh."""


@dataclass(frozen=True)
class Settings:
    """Settings for one mesh, which together with its content determine the result.

    Attributes:
        method: One of ``METHODS``.
        max_error: Largest distance between visual and collision, relative to the diagonal of the
            visual's bounding box: a limit for ``auto``, a criterion for other methods.
        max_hulls: Largest number of convex pieces that CoACD creates from a mesh; None for no limit
            with ``coacd``, and ``FEW_HULLS`` with ``auto``.
        max_vertices: Largest number of vertices of a convex piece.
        max_triangles: Largest total number of triangles from ``simplify`` and ``coacd``.
        threshold: CoACD's concavity threshold for ``coacd``: a distance relative to half the
            longest side.
        time_limit: Processor time limit [s] of all CoACD runs on a mesh.
    """

    method: str = "auto"
    max_error: float = 0.01
    max_hulls: int | None = None
    max_vertices: int = 64
    max_triangles: int = 1000
    threshold: float = 0.06
    time_limit: float = 120.0

    def changed(self, table: Mapping[str, Any]) -> Settings:
        """Return a copy with some settings replaced."""
        return replace(self, **table)

    def as_dict(self) -> dict[str, Any]:
        """Return the settings by name, for keys and messages between processes."""
        return asdict(self)
