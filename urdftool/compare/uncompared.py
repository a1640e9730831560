"""What a row could not compare, because a file was not read."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

MESHES = "mesh not read", "meshes not read"
"""Kind of the meshes whose surface was not measured: nothing is known of the shape then."""

UNREAD = "part not read", "parts not read"
"""Kind of what a reader did not read, and two files do not have in equal words."""

SETTINGS = "setting of the world", "settings of the world"
"""Kind of the settings of a world that decide what a simulator does with a part of one robot."""

OPEN = "closed loop", "closed loops"
"""Kind of the connections that close loops in one robot, and whose row is not compared."""

COUNTED = (MESHES, UNREAD, SETTINGS, OPEN)
"""Kinds that leave it unknown whether two robots are equal."""

COLORED = "mesh with colors of its own", "meshes with colors of their own"
"""Kind of the meshes whose file has colors and images, which are not read."""

IMAGES = "image not read", "images not read"
"""Kind of the images of materials."""


class Uncompared(NamedTuple):
    """A part of a row that was not compared."""

    row: str
    kind: tuple[str, str]
    name: str
    reason: str


def explain_row(parts: Iterable[Uncompared], row: str) -> str:
    """Return how many parts of a row were not compared, with the first; empty for none."""
    found: dict[tuple[str, str], list[Uncompared]] = {}
    for part in parts:
        if part.row == row:
            found.setdefault(part.kind, []).append(part)
    return "; ".join(_explain(kind, some) for kind, some in found.items())


def _explain(kind: tuple[str, str], parts: Sequence[Uncompared]) -> str:
    first, count = parts[0], len(parts)
    return f"{count} {kind[count > 1]}: {first.name}, {first.reason}"
