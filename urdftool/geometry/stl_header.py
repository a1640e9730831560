"""First bytes of a mesh file: kind and claimed size of an STL file, git-LFS pointers.

A binary STL file is 80 arbitrary bytes, the number of triangles as a little-endian 32-bit integer,
and 50 bytes per triangle. The header thus implies the file size, which distinguishes it from a text
file. The word "solid" does not: one binary file in fifteen begins with it.
"""

from __future__ import annotations

import os
import struct
from dataclasses import dataclass
from pathlib import Path

HEADER_BYTES = 84  # 80 of text, 4 of the count; definition of binary STL
TRIANGLE_BYTES = 50  # 12 numbers of 4 bytes, 2 of attributes; definition of binary STL
LFS_MARK = b"version https://git-lfs.github.com/spec/"


@dataclass(frozen=True)
class StlHeader:
    """Kind and size of an STL file, from its first bytes and its length."""

    kind: str
    """``"binary"``, ``"ascii"``, ``"lfs-pointer"``, ``"empty"`` or ``"unknown"``."""
    bytes: int
    """File size."""
    triangles: int | None = None
    """Number of triangles that a binary header claims; None for other kinds."""
    begins_with_solid: bool = False
    """Whether the file begins with "solid", as text files do."""

    @property
    def expected_bytes(self) -> int | None:
        """Return the size that a binary file must have for its claimed triangles."""
        if self.triangles is None:
            return None
        return HEADER_BYTES + TRIANGLE_BYTES * self.triangles

    @property
    def size_agrees(self) -> bool:
        """Tell whether a binary file is exactly as long as its header implies; True for text."""
        return self.kind == "ascii" or self.bytes == self.expected_bytes


def read_stl_header(path: str | Path) -> StlHeader:
    """Read the kind of an STL file, its claimed number of triangles and its size.

    Raises:
        OSError: The file cannot be read.
    """
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size
        head = file.read(1024)
    if not size:
        return StlHeader("empty", 0)
    if head.startswith(LFS_MARK):
        return StlHeader("lfs-pointer", size)
    solid = head.lstrip().lower().startswith(b"solid")
    claimed = struct.unpack_from("<I", head, 80)[0] if len(head) >= HEADER_BYTES else None
    if claimed is not None and size == HEADER_BYTES + TRIANGLE_BYTES * claimed:
        return StlHeader("binary", size, claimed, solid)
    lines = head.lower()
    if solid and (b"facet" in lines or b"endsolid" in lines):
        return StlHeader("ascii", size, None, True)
    if claimed is None:
        return StlHeader("unknown", size, None, solid)
    return StlHeader("binary", size, claimed, solid)


def is_lfs_pointer(path: str | Path) -> bool:
    """Tell whether the file is a git-LFS pointer, which stands for a file that was not fetched.

    Raises:
        OSError: The file cannot be read.
    """
    with open(path, "rb") as file:
        return file.read(len(LFS_MARK)) == LFS_MARK
