"""A triangle mesh and the pieces it is made of."""

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
    """A run of a mesh's faces that share an object and a material."""

    name: str
    """The object's or material's name in the file; empty where it has none."""
    first: int
    """Row of ``Mesh.faces`` at which the part begins."""
    count: int
    """How many faces it has."""
    rgba: tuple[float, float, float, float] | None = None
    """Diffuse colour, each in 0 … 1; None where the file gives none."""
    texture: Path | None = None
    """Image of the diffuse colour beside the mesh; None where there is none or it is embedded."""
    image: bytes | None = field(default=None, repr=False)
    """The image itself where it is embedded in the mesh file."""
    uv: Points | None = field(default=None, repr=False, compare=False)
    """Where each corner lies in the image, shape (count, 3, 2): from its lower left corner, which
    is 0 0, to its upper right one, which is 1 1. None where the file does not say."""


class MeshNote(NamedTuple):
    """Something a user should know of how a mesh file was read or converted.

    Attributes:
        code: What kind of thing, such as ``obj-without-materials``. Code reads this.
        message: A complete sentence for people.
        lossy: Whether something of the file is lost or changed.
    """

    code: str
    message: str
    lossy: bool = False


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles in the frame of the URDF ``<geometry>``, scaled."""

    vertices: Points
    """Points [m], shape (n, 3). Equal points may occur more than once."""
    faces: Faces
    """Indices into ``vertices``, shape (m, 3), counter-clockwise seen from outside."""
    parts: tuple[Part, ...]
    """Pieces by object and material, in the order of ``faces``, which they cover."""
    format: str
    """Suffix of the format in lower case, without its dot: ``"stl"``, ``"dae"`` …"""
    path: Path
    """The file it was read from."""
    notes: tuple[MeshNote, ...] = ()
    """What a user should know of how the file was read."""

    @property
    def note_texts(self) -> tuple[str, ...]:
        """Return the messages of the notes."""
        return tuple(note.message for note in self.notes)

    def part_faces(self, part: Part) -> Faces:
        """The faces of one of ``parts``."""
        return self.faces[part.first : part.first + part.count]


@dataclass(frozen=True, eq=False)
class Piece:
    """What a reader of one format found: a part with its own vertices, unscaled."""

    vertices: Points
    faces: Faces
    name: str = ""
    rgba: tuple[float, float, float, float] | None = None
    texture: Path | None = None
    image: bytes | None = None
    uv: Points | None = None


@dataclass(frozen=True)
class Reading:
    """All that a reader of one format found: pieces in metres, and what should be said of them."""

    pieces: list[Piece]
    notes: list[MeshNote]
