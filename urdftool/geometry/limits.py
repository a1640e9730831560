"""Limits of what a mesh file may make in memory; each is checked before the memory is taken.

A small file can describe an immense mesh by repeating what it stores: instances of nodes, accessors
without data or with the data of others, elements of an XML or JSON tree. What a file stores once
is limited by its size alone, so that every file whose triangles have bytes of their own is read.

The largest of 1,563 meshes of real robots has 124,789 triangles, and another one 127 parts; none
has more than a triangle for 10 bytes.
"""

from __future__ import annotations

from pathlib import Path

from ..errors import MeshError

MAX_TRIANGLES = 500_000
"""Number of triangles, instances included, that a file of any size may have. Chosen, no source."""

BYTES_PER_TRIANGLE = 10
"""Size [bytes] per triangle of a file with more than :data:`MAX_TRIANGLES`; measured, see above."""

MAX_PARTS = 10_000
"""Number of parts, instances included: runs of triangles of one material. Chosen, no source."""

MAX_NODES = 100_000
"""Number of nodes of a scene, instances included. Chosen, no source."""

MAX_TREE = 4_000_000
"""Number of elements of an XML tree, or of values of a JSON tree. Chosen, no source."""


def check_instances(
    path: Path, size: int, *, triangles: int = 0, parts: int = 0, nodes: int = 0
) -> None:
    """Raise MeshError if a mesh with all its instances exceeds a limit."""
    if triangles <= MAX_TRIANGLES and parts <= MAX_PARTS and nodes <= MAX_NODES:
        return
    for count, limit, what in (
        (nodes, MAX_NODES, "nodes"),
        (parts, MAX_PARTS, "parts"),
        (triangles, max(MAX_TRIANGLES, size // BYTES_PER_TRIANGLE), "triangles"),
    ):
        if count > limit:
            raise MeshError(
                f"with all instances the mesh has {_format_count(count)} {what}, more than the "
                f"limit of {limit}; export fewer {what}",
                path=path,
            )


def check_tree(path: Path, data: bytes, *marks: bytes) -> None:
    """Raise MeshError if a text has too many elements or values, before it is parsed.

    Args:
        path: The mesh file.
        data: The text.
        marks: Characters of which each element or value has at least one.
    """
    count = sum(map(data.count, marks))
    if count > MAX_TREE:
        raise MeshError(
            f"the file has {count} elements, more than the limit of {MAX_TREE}; export them in "
            "fewer and longer lists",
            path=path,
        )


def _format_count(count: int) -> str:
    return str(count) if count < 10**12 else f"more than 10^{len(str(count)) - 1}"
