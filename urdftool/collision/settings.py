"""What is wanted of a collision geometry."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

METHODS = ("auto", "primitive", "hull", "coacd", "simplify")

FEW_HULLS = 32
"""Convex pieces that ``auto`` may make of a mesh."""

KILLED = "CoACD was killed, perhaps for want of memory"
"""Said of a process that was ended from outside; the next time it may be otherwise."""


@dataclass(frozen=True)
class Settings:
    """Choices for one mesh; together with its content they determine the result.

    Attributes:
        method: One of ``METHODS``.
        max_error: Largest distance of visual and collision, relative to the diagonal of the
            visual's bounding box. ``auto`` keeps to it; other methods are only judged by it.
        max_hulls: Convex pieces that CoACD may make of a mesh; None is no limit for the method
            ``coacd``, and ``FEW_HULLS`` for ``auto``.
        max_vertices: Vertices that a convex piece may have.
        max_triangles: Triangles that ``simplify`` and ``coacd`` may leave of a mesh, in all.
        threshold: CoACD's concavity, at which it stops to cut, for the method ``coacd``: a
            distance, relative to half the longest side.
        time_limit: Processor time [s] that CoACD may take for a mesh, in all of its runs.
    """

    method: str = "auto"
    max_error: float = 0.01
    max_hulls: int | None = None
    max_vertices: int = 64
    max_triangles: int = 1000
    threshold: float = 0.06
    time_limit: float = 120.0

    def changed(self, table: Mapping[str, Any]) -> Settings:
        """These settings with others in place of some."""
        return replace(self, **table)

    def as_dict(self) -> dict[str, Any]:
        """By name, for keys and messages between processes."""
        return asdict(self)
