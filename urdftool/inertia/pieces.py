"""What the geometry of a link encloses: its pieces, put together in the link frame."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import UrdftoolError
from ..geometry.mesh import Array
from ..mechanics.spatial_inertia import SpatialInertia
from ..model.elements import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Geometry,
    Link,
    Mesh,
    Sphere,
    UnknownShape,
    Visual,
)
from ..model.pose import pose_of
from . import solids
from .bodies import MeshBody
from .inertia_error import InertiaError
from .requirements import combine

SOURCES = ("collision", "visual")

_MIN, _MAX, _FAR = 1e-100, 1e100, 1e40

Meshes = Mapping[str, "MeshBody | UrdftoolError"]
Shape = Visual | Collision


@dataclass(frozen=True, eq=False)
class Piece:
    """One visual or collision, at a density of 1 kg/m³, in the link frame."""

    shape: Shape
    what: str
    unit: SpatialInertia
    lower: Array
    upper: Array
    method: str = "exact"
    reliable: bool = True
    error: float = 0.0
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Lack:
    """A visual or collision that has no volume to weigh, and why."""

    shape: Shape
    reason: str


@dataclass(frozen=True, eq=False)
class LinkBody:
    """All pieces of a link from one source.

    Attributes:
        source: ``"collision"`` or ``"visual"``.
        pieces: Those that could be weighed.
        lacks: Those that could not.
    """

    source: str
    pieces: tuple[Piece, ...]
    lacks: tuple[Lack, ...]

    @property
    def complete(self) -> bool:
        """Whether every piece could be weighed, and there is one."""
        return bool(self.pieces) and not self.lacks

    @property
    def reliable(self) -> bool:
        """Whether every piece is within some 3 % of what was meant."""
        return self.complete and all(piece.reliable for piece in self.pieces)

    @property
    def unit(self) -> SpatialInertia:
        """All pieces as one body of 1 kg/m³; space that two share counts twice."""
        return combine(piece.unit for piece in self.pieces)

    @property
    def volume(self) -> float:
        """Sum of the pieces' volumes [m³]."""
        return float(sum(piece.unit.mass for piece in self.pieces))

    @property
    def box(self) -> tuple[Array, Array]:
        """Smallest and largest corner [m] of the box around them, along the link's axes."""
        return (
            np.min([piece.lower for piece in self.pieces], axis=0),
            np.max([piece.upper for piece in self.pieces], axis=0),
        )


def shapes_of(link: Link, source: str) -> Sequence[Shape]:
    """The visuals or collisions of a link."""
    return link.visuals if source == "visual" else link.collisions


def mesh_names(shapes: Sequence[Shape]) -> Iterator[str]:
    """The mesh files that shapes name, as they are written."""
    for shape in shapes:
        if isinstance(shape.geometry, Mesh):
            yield shape.geometry.filename


def link_body(link: Link, source: str, meshes: Meshes) -> LinkBody | None:
    """The body that a link's collisions or visuals make; None where it has none of them.

    Args:
        link: The link.
        source: ``"collision"`` or ``"visual"``.
        meshes: What each mesh file encloses, or why it is not known, by its name as written.
    """
    pieces, lacks = [], []
    for shape in shapes_of(link, source):
        try:
            pieces.append(_piece(shape, meshes))
        except ArithmeticError:
            lacks.append(Lack(shape, "it is beyond what numbers can hold"))
        except UrdftoolError as error:
            lacks.append(Lack(shape, str(error)))
    return LinkBody(source, tuple(pieces), tuple(lacks)) if pieces or lacks else None


def _piece(shape: Shape, meshes: Meshes) -> Piece:
    geometry = shape.geometry
    if geometry is None:
        raise InertiaError("it has no geometry")
    if isinstance(geometry, UnknownShape):
        raise InertiaError(f"<{geometry.element.tag}> is no shape of URDF")
    if isinstance(geometry, Mesh):
        body = meshes.get(geometry.filename)
        if body is None:
            raise InertiaError("its mesh was not read")
        if isinstance(body, UrdftoolError):
            raise body
        body = body.scaled(geometry.scale)
        placed, lower, upper = _placed(shape, body.unit, (body.lower, body.upper))
        name = Path(geometry.filename).name
        return Piece(
            shape, name, placed, lower, upper, body.method, body.reliable, body.error, body.notes
        )
    unit, half = _primitive(geometry)
    placed, lower, upper = _placed(shape, unit, (-half, half))
    return Piece(shape, geometry.element.tag, placed, lower, upper)


def _primitive(geometry: Geometry) -> tuple[SpatialInertia, Array]:
    """A primitive at 1 kg/m³ in its own frame, and half the edges [m] of the box around it."""
    make, half = _PRIMITIVES[type(geometry)]
    return make(geometry), np.array(half(geometry), dtype=np.float64)


_PRIMITIVES: dict[
    type, tuple[Callable[[Any], SpatialInertia], Callable[[Any], tuple[float, float, float]]]
] = {
    Box: (
        lambda g: solids.box(g.size, density=1.0),
        lambda g: (g.size[0] / 2, g.size[1] / 2, g.size[2] / 2),
    ),
    Cylinder: (
        lambda g: solids.cylinder(g.radius, g.length, density=1.0),
        lambda g: (g.radius, g.radius, g.length / 2),
    ),
    Sphere: (
        lambda g: solids.sphere(g.radius, density=1.0),
        lambda g: (g.radius, g.radius, g.radius),
    ),
    Capsule: (
        lambda g: solids.capsule(g.radius, g.length, density=1.0),
        lambda g: (g.radius, g.radius, g.length / 2 + g.radius),
    ),
}


def _placed(
    shape: Shape, unit: SpatialInertia, box: tuple[Array, Array]
) -> tuple[SpatialInertia, Array, Array]:
    """A body and its box, by the ``<origin>`` of its shape moved into the link frame."""
    pose = pose_of(shape.origin)
    rotation = np.array(pose.rotation, dtype=np.float64)
    xyz = np.array(pose.translation, dtype=np.float64)
    size = max(map(abs, unit.tensor))
    place = max(float(np.abs(values).max()) for values in (xyz, *box))
    # beyond these, numbers lose their meaning on the way
    if not (_MIN < size < _MAX and _MIN < unit.mass < _MAX and place < _FAR):
        raise ArithmeticError
    middle, half = (box[0] + box[1]) / 2, (box[1] - box[0]) / 2
    centre, reach = rotation @ middle + xyz, np.abs(rotation) @ half
    return unit.moved(pose), centre - reach, centre + reach
