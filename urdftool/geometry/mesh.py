"""Triangle meshes and their parts."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Points = npt.NDArray[np.float64]
Faces = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Part:
    """A range of a mesh's faces that share an object and a material."""

    name: str
    """Name of the object or material in the file; may be empty."""
    first: int
    """First row of the part in ``Mesh.faces``."""
    count: int
    """Number of faces."""
    rgba: tuple[float, float, float, float] | None = None
    """Diffuse color in sRGB, each component in 0 … 1; None if the file has none."""
    texture: Path | None = None
    """Path of the image of the diffuse color; None if there is none or it is embedded."""
    image: bytes | None = field(default=None, repr=False)
    """Content of the image if it is embedded in the mesh file."""
    uv: Points | None = field(default=None, repr=False, compare=False)
    """Texture coordinates of each corner, shape (count, 3, 2), from the lower left (0, 0) to the
    upper right (1, 1) of the image. None if the file has none."""


class MeshNote(NamedTuple):
    """A note to the user on how a mesh file was read or converted.

    Attributes:
        code: Identifier such as ``obj-without-materials``, for code.
        message: A complete sentence for people.
        lossy: Whether a part of the file is lost or changed.
    """

    code: str
    message: str
    lossy: bool = False


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles in the frame of the URDF ``<geometry>``, scaled."""

    vertices: Points
    """Points [m], shape (n, 3). Points may occur more than once."""
    faces: Faces
    """Indices into ``vertices``, shape (m, 3), counter-clockwise seen from outside."""
    parts: tuple[Part, ...]
    """Parts by object and material, in the order of ``faces``; together they cover all faces."""
    format: str
    """Suffix of the format in lower case, without its dot: ``"stl"``, ``"dae"`` …"""
    path: Path
    """The file from which it was read."""
    notes: tuple[MeshNote, ...] = ()
    """Notes on how the file was read."""

    @property
    def note_texts(self) -> tuple[str, ...]:
        """Return the messages of the notes."""
        return tuple(note.message for note in self.notes)

    def get_part_faces(self, part: Part) -> Faces:
        """Return the faces of one of ``parts``, shape (count, 3)."""
        return self.faces[part.first : part.first + part.count]


@dataclass(frozen=True, eq=False)
class Piece:
    """A part with its own vertices, unscaled, as a reader of one format returns it."""

    vertices: Points
    faces: Faces
    name: str = ""
    rgba: tuple[float, float, float, float] | None = None
    texture: Path | None = None
    image: bytes | None = None
    uv: Points | None = None


@dataclass(frozen=True)
class Reading:
    """Result of a reader of one format: pieces [m] and notes."""

    pieces: list[Piece]
    notes: list[MeshNote]
