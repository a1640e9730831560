"""Shapes with a closed form, and the sizes each requires: data, without numpy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ..mechanics.spatial_inertia import SpatialInertia

Sizes = Mapping[str, "float | tuple[float, ...]"]


class Size(NamedTuple):
    """One size of a shape, of one number or three."""

    name: str
    numbers: int
    metavar: str
    what: str


class Shape(NamedTuple):
    """A shape: its sizes, and whether it has a hollow version and end plates."""

    name: str
    what: str
    sizes: tuple[Size, ...]
    hollow: bool = False
    ends: bool = False

    @property
    def title(self) -> str:
        """Return the name with its indefinite article."""
        return f"an {self.name}" if self.name[0] in "aeiou" else f"a {self.name}"


_LENGTH = Size("length", 1, "L", "along Z [m]")
_RADIUS = Size("radius", 1, "R", "[m]")

SHAPES = (
    Shape(
        "box",
        "cuboid, centered at the origin",
        (Size("size", 3, "X Y Z", "edges along X, Y and Z [m]"),),
        True,
    ),
    Shape("cylinder", "axis along Z, centered at the origin", (_RADIUS, _LENGTH), True, True),
    Shape("sphere", "centered at the origin", (_RADIUS,), True),
    Shape(
        "capsule",
        "axis along Z, centered at the origin, with half spheres at both ends",
        (_RADIUS, Size("length", 1, "L", "of the cylinder between the half spheres [m]")),
    ),
    Shape(
        "ellipsoid",
        "centered at the origin",
        (Size("radii", 3, "A B C", "half axes along X, Y and Z [m]"),),
    ),
    Shape(
        "cone",
        "axis along Z, tip up, origin at half height",
        (Size("radius", 1, "R", "of the base [m]"), _LENGTH),
    ),
)

THICKNESS = Size("thickness", 1, "T", "of the wall, inward from the outer dimensions [m]")


_MIN, _MAX = 1e-200, 1e200
"""Masses [kg] and moments [kg·m²] within which products do not overflow. Chosen, no source."""


def find_shape(name: str) -> Shape | None:
    """Return the shape of this name, or None."""
    return next((shape for shape in SHAPES if shape.name == name), None)


def compute_shape_properties(
    shape: Shape,
    sizes: Sizes,
    *,
    thickness: float | None = None,
    closed: bool = False,
    mass: float | None = None,
    density: float | None = None,
) -> SpatialInertia:
    """Compute the mass properties of a shape in its own frame; see ``solids`` for the formulas.

    Args:
        shape: The shape.
        sizes: Its sizes [m] by name.
        thickness: Wall of a hollow shape [m]; None for a solid one.
        closed: Whether a hollow cylinder has end plates.
        mass: Mass [kg]; give this or ``density``.
        density: Density [kg/m³].

    Raises:
        InertiaError: A size, mass or density is not above zero or out of range, or the wall does
            not fit.
    """
    from . import solids
    from .inertia_error import InertiaError

    amount = {"mass": mass, "density": density}
    given = {**sizes, **amount}
    name = shape.name
    if thickness is not None:
        name = f"hollow_{name}"
        given |= {"thickness": thickness} | ({"closed": closed} if shape.ends else {})
    try:
        result: SpatialInertia = getattr(solids, name)(**given)
    except ArithmeticError:
        result = None  # type: ignore[assignment]
    if result is None or not (_MIN < result.mass < _MAX and _MIN < max(result.tensor) < _MAX):
        raise InertiaError(
            f"{shape.title} of this size and mass is too large for floating-point numbers"
        )
    return result
