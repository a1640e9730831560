"""Solid of a link's geometry, assembled from its visuals or collisions in the link frame."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..diagnostic import Diagnostic
from ..errors import UrdftoolError
from ..geometry.mesh import Array
from ..mechanics.spatial_inertia import SpatialInertia
from ..model.elements import (
    Box,
    Capsule,
    Collision,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Link,
    Mesh,
    Plane,
    Sphere,
    UnknownShape,
    Visual,
)
from ..model.pose import make_pose
from ..model.shapes import get_shape_name
from . import solids
from .bodies import MeshBody
from .inertia_error import InertiaError
from .requirements import combine

SOURCES = ("collision", "visual")

_MIN, _MAX, _FAR = 1e-100, 1e100, 1e40
"""Volumes [m³], masses [kg] and distances [m] within which products do not overflow. Chosen, no
source.
"""

Meshes = Mapping[str, "MeshBody | UrdftoolError"]
Shape = Visual | Collision


@dataclass(frozen=True, eq=False)
class Piece:
    """One visual or collision at a density of 1 kg/m³, in the link frame."""

    shape: Shape
    what: str
    unit: SpatialInertia
    lower: Array
    upper: Array
    method: str = "exact"
    reliable: bool = True
    error: float = 0.0
    notes: tuple[Diagnostic, ...] = ()
    suspicion: Diagnostic | None = None

    @property
    def note_texts(self) -> tuple[str, ...]:
        """Return the notes and the message of the suspicion."""
        found = self.notes if self.suspicion is None else (*self.notes, self.suspicion)
        return tuple(note.message for note in found)


@dataclass(frozen=True)
class Lack:
    """A visual or collision whose volume is unknown, with the reason."""

    shape: Shape
    reason: str


@dataclass(frozen=True, eq=False)
class LinkBody:
    """All pieces of a link from one source.

    Attributes:
        source: ``"collision"`` or ``"visual"``.
        pieces: Shapes with a known volume.
        lacks: Shapes without one.
    """

    source: str
    pieces: tuple[Piece, ...]
    lacks: tuple[Lack, ...]

    @property
    def complete(self) -> bool:
        """Tell whether there is a piece and the volume of every shape is known."""
        return bool(self.pieces) and not self.lacks

    @property
    def reliable(self) -> bool:
        """Tell whether every piece is within about 3 % of the intended solid."""
        return self.complete and all(piece.reliable for piece in self.pieces)

    @property
    def unit(self) -> SpatialInertia:
        """Return all pieces as one body of 1 kg/m³; overlapping space counts twice."""
        return combine(piece.unit for piece in self.pieces)

    @property
    def volume(self) -> float:
        """Return the sum of the pieces' volumes [m³]."""
        return float(sum(piece.unit.mass for piece in self.pieces))

    @property
    def box(self) -> tuple[Array, Array]:
        """Return lower and upper corner [m] of the bounding box, along the link's axes."""
        return (
            np.min([piece.lower for piece in self.pieces], axis=0),
            np.max([piece.upper for piece in self.pieces], axis=0),
        )


def get_shapes(link: Link, source: str) -> Sequence[Shape]:
    """Return the visuals or collisions of a link."""
    return link.visuals if source == "visual" else link.collisions


def list_mesh_names(shapes: Sequence[Shape]) -> Iterator[str]:
    """Yield the mesh URIs of shapes, as written."""
    for shape in shapes:
        if isinstance(shape.geometry, Mesh):
            yield shape.geometry.filename


def link_body(link: Link, source: str, meshes: Meshes) -> LinkBody | None:
    """Assemble the solid of a link's collisions or visuals; None if there are none.

    Args:
        link: The link.
        source: ``"collision"`` or ``"visual"``.
        meshes: Body of each mesh, or the error, by its URI as written.
    """
    pieces, lacks = [], []
    for shape in get_shapes(link, source):
        try:
            pieces.append(_make_piece(shape, meshes))
        except ArithmeticError:
            lacks.append(Lack(shape, "it is beyond what numbers can hold"))
        except UrdftoolError as error:
            lacks.append(Lack(shape, str(error)))
    return LinkBody(source, tuple(pieces), tuple(lacks)) if pieces or lacks else None


def _make_piece(shape: Shape, meshes: Meshes) -> Piece:
    geometry = shape.geometry
    if geometry is None:
        raise InertiaError("it has no geometry")
    if isinstance(geometry, UnknownShape):
        raise InertiaError(f"<{geometry.tag}> is not a shape of URDF")
    if isinstance(geometry, Plane):
        raise InertiaError("a plane has no volume")
    if isinstance(geometry, Mesh):
        body = meshes.get(geometry.filename)
        if body is None:
            raise InertiaError("its mesh was not read")
        if isinstance(body, UrdftoolError):
            raise body
        body = body.scale(geometry.scale)
        placed, lower, upper = _transform_to_link(shape, body.unit, (body.lower, body.upper))
        name = Path(geometry.filename).name
        return Piece(
            shape,
            name,
            placed,
            lower,
            upper,
            body.method,
            body.reliable,
            body.error,
            body.notes,
            body.suspicion,
        )
    unit, half = _get_primitive(geometry)
    placed, lower, upper = _transform_to_link(shape, unit, (-half, half))
    return Piece(shape, get_shape_name(geometry), placed, lower, upper)


def _get_primitive(geometry: Geometry) -> tuple[SpatialInertia, Array]:
    """Return a primitive at 1 kg/m³ and half the edges [m] of its bounding box, in its frame."""
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
    Ellipsoid: (lambda g: solids.ellipsoid(g.radii, density=1.0), lambda g: g.radii),
    Cone: (
        lambda g: solids.cone(g.radius, g.length, density=1.0),
        lambda g: (g.radius, g.radius, g.length / 2),
    ),
}


def _transform_to_link(
    shape: Shape, unit: SpatialInertia, box: tuple[Array, Array]
) -> tuple[SpatialInertia, Array, Array]:
    """Transform a body and its bounding box into the link frame by the shape's ``<origin>``.

    Raises:
        ArithmeticError: A size, mass or position is beyond the range of floats.
    """
    pose = make_pose(shape.origin)
    rotation = np.array(pose.rotation, dtype=np.float64)
    xyz = np.array(pose.translation, dtype=np.float64)
    size = max(map(abs, unit.tensor))
    place = max(float(np.abs(values).max()) for values in (xyz, *box))
    # values beyond these would overflow or underflow in products
    if not (_MIN < size < _MAX and _MIN < unit.mass < _MAX and place < _FAR):
        raise ArithmeticError
    middle, half = (box[0] + box[1]) / 2, (box[1] - box[0]) / 2
    center, reach = rotation @ middle + xyz, np.abs(rotation) @ half
    return unit.transform(pose), center - reach, center + reach
