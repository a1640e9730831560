"""What the bytes of a mesh file say, read without numpy or a mesh library.

A binary STL file is 80 bytes of anything, the number of triangles as a little-endian 32-bit
integer, and 50 bytes a triangle. Its size is therefore known from the header, and that, not the
word "solid" at the beginning, tells it from a text file: one binary file in fifteen begins so.
"""

from __future__ import annotations

import os
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from math import inf, isfinite
from pathlib import Path
from typing import BinaryIO

HEADER_BYTES = 84
TRIANGLE_BYTES = 50
LFS_MARK = b"version https://git-lfs.github.com/spec/"

_CHUNK = 20_000


@dataclass(frozen=True)
class StlFacts:
    """What an STL file is, judged from its first bytes and its size."""

    kind: str
    """``"binary"``, ``"ascii"``, ``"lfs-pointer"``, ``"empty"`` or ``"unknown"``."""
    bytes: int
    """Size of the file."""
    triangles: int | None = None
    """Number of triangles a binary header claims; None for any other kind."""
    begins_with_solid: bool = False
    """The file begins with the word that is the mark of the text form."""

    @property
    def expected_bytes(self) -> int | None:
        """The size a binary file must have for the triangles it claims."""
        if self.triangles is None:
            return None
        return HEADER_BYTES + TRIANGLE_BYTES * self.triangles

    @property
    def size_agrees(self) -> bool:
        """Whether a binary file is exactly as long as its header says; True for text."""
        return self.kind == "ascii" or self.bytes == self.expected_bytes


def stl_facts(path: str | Path) -> StlFacts:
    """What kind of STL file this is, how many triangles it claims and whether its size agrees.

    Raises:
        OSError: The file cannot be read.
    """
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size
        head = file.read(1024)
    if not size:
        return StlFacts("empty", 0)
    if head.startswith(LFS_MARK):
        return StlFacts("lfs-pointer", size)
    solid = head.lstrip().lower().startswith(b"solid")
    claimed = struct.unpack_from("<I", head, 80)[0] if len(head) >= HEADER_BYTES else None
    if claimed is not None and size == HEADER_BYTES + TRIANGLE_BYTES * claimed:
        return StlFacts("binary", size, claimed, solid)
    lines = head.lower()
    if solid and (b"facet" in lines or b"endsolid" in lines):
        return StlFacts("ascii", size, None, True)
    if claimed is None:
        return StlFacts("unknown", size, None, solid)
    return StlFacts("binary", size, claimed, solid)


def stl_bounds(
    path: str | Path,
) -> tuple[tuple[float, float, float], tuple[float, float, float]] | None:
    """Smallest and largest corner of a binary STL file's triangles, in the file's own unit.

    Returns:
        None for a text file, one without triangles, or one with a coordinate that is no number.

    Raises:
        OSError: The file cannot be read.
    """
    facts = stl_facts(path)
    if facts.kind != "binary" or not facts.triangles:
        return None
    low, high = [inf] * 3, [-inf] * 3
    with open(path, "rb") as file:
        file.seek(HEADER_BYTES)
        for axes in _coordinates(file, facts.triangles):
            for axis, values in enumerate(axes):
                smallest, largest = min(values), max(values)
                # a NaN may hide behind min and max, never from the sum
                if not isfinite(sum(values)) or not isfinite(smallest):
                    return None
                low[axis], high[axis] = min(low[axis], smallest), max(high[axis], largest)
    if low[0] > high[0]:
        return None
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])


def is_lfs_pointer(path: str | Path) -> bool:
    """Whether the file is the text that git-lfs leaves in place of a file it has not fetched.

    Raises:
        OSError: The file cannot be read.
    """
    with open(path, "rb") as file:
        return file.read(len(LFS_MARK)) == LFS_MARK


def _coordinates(file: BinaryIO, triangles: int) -> Iterator[list[tuple[float, ...]]]:
    """For each chunk of triangles its x, its y and its z coordinates."""
    left = triangles
    while left > 0:
        data = file.read(TRIANGLE_BYTES * min(left, _CHUNK))
        whole = len(data) // TRIANGLE_BYTES
        if not whole:
            return
        flat = list(struct.iter_unpack("<12x9f2x", data[: whole * TRIANGLE_BYTES]))
        columns = list(zip(*flat, strict=True))
        yield [columns[axis] + columns[axis + 3] + columns[axis + 6] for axis in range(3)]
        left -= whole
