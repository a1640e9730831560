"""Geometry of links: primitives and meshes."""

from __future__ import annotations

import math
from collections import Counter, deque
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, Union

from .part import ZERO, Part, Vector

if TYPE_CHECKING:
    from ..source.document import Element

PLANE_SIZE = 100.0
"""Edge [m] of an unlimited plane where it is drawn, as in USD. Chosen, no source."""


@dataclass(slots=True)
class Box(Part):
    """Box centered on its origin; ``size`` [m] along x, y, z."""

    size: Vector = ZERO


@dataclass(slots=True)
class Cylinder(Part):
    """Cylinder along z, centered on its origin; radius and length [m]."""

    radius: float = 0.0
    length: float = 0.0


@dataclass(slots=True)
class Sphere(Part):
    """Sphere centered on its origin; radius [m]."""

    radius: float = 0.0


@dataclass(slots=True)
class Capsule(Part):
    """Capsule along z, centered on its origin; ``length`` [m] excludes the caps (URDF 1.1)."""

    radius: float = 0.0
    length: float = 0.0


@dataclass(slots=True)
class Ellipsoid(Part):
    """Ellipsoid centered on its origin; ``radii`` [m] along x, y, z (SDF, MJCF)."""

    radii: Vector = ZERO


@dataclass(slots=True)
class Cone(Part):
    """Cone along z, its tip up, with the origin at half its length (SDF 1.11); lengths [m]."""

    radius: float = 0.0
    length: float = 0.0


@dataclass(slots=True)
class Plane(Part):
    """Plane through its origin, normal to z (SDF, MJCF).

    ``size`` [m] is its extent along x and y where it is drawn, None if not limited. As a collision
    a plane is infinite and everything below it is inside.
    """

    size: tuple[float, float] | None = None


@dataclass(slots=True)
class Mesh(Part):
    """Mesh file and its scale factors along x, y, z."""

    filename: str = ""
    scale: Vector = (1.0, 1.0, 1.0)


@dataclass(slots=True)
class UnknownShape(Part):
    """Geometry that the model does not have, such as a heightfield.

    Attributes:
        tag: Tag of its element, or its type, in the source.
        content: What the source writes of it, as numbers and texts by name; None if unknown.
        files: Names of the files in the content, which are not read.
    """

    tag: str = ""
    content: dict[str, Any] | None = None
    files: tuple[str, ...] = ()


Geometry = Union[  # noqa: UP007 -- runtime alias
    Box, Cylinder, Sphere, Capsule, Ellipsoid, Cone, Plane, Mesh, UnknownShape
]

_NAMES: dict[type, str] = {
    Box: "box",
    Cylinder: "cylinder",
    Sphere: "sphere",
    Capsule: "capsule",
    Ellipsoid: "ellipsoid",
    Cone: "cone",
    Plane: "plane",
    Mesh: "mesh",
}


def has_equal_values(one: Geometry | None, other: Geometry | None) -> bool:
    """Tell whether two geometries have one type and equal sizes and files, from any places."""
    if one is None or other is None or type(one) is not type(other):
        return False
    return replace(one, provenance=None) == replace(other, provenance=None)


def get_shape_name(geometry: Geometry) -> str:
    """Return the name of a shape's type: the tag of its element in URDF and SDF."""
    return geometry.tag if isinstance(geometry, UnknownShape) else _NAMES[type(geometry)]


def describe_shape(geometry: Geometry | None) -> dict[str, Any]:
    """Return geometry as data: its type, and its lengths [m] as tuples, or its file."""
    if geometry is None:
        return {"shape": None}
    if isinstance(geometry, UnknownShape):
        return {"shape": geometry.tag, **(geometry.content or {})}
    facts: dict[str, Any] = {"shape": get_shape_name(geometry)}
    for field in fields(geometry):
        value = getattr(geometry, field.name)
        if field.name != "provenance":
            facts[field.name] = (value,) if isinstance(value, int | float) else value
    return facts


def collect_content(element: Element) -> dict[str, Any]:
    """Return the attributes and texts in an element by path: numbers as tuples, others as text."""
    content: dict[str, Any] = {}
    todo = deque([(element, "")])
    while todo:
        one, path = todo.popleft()
        for name, text in one.attributes.items():
            content[f"{path}@{name}"] = _parse_numbers(text)
        if path and one.text.strip():
            content[path] = _parse_numbers(one.text)
        counts: Counter[str] = Counter()
        for child in one.children:
            counts[child.tag] += 1
            count = counts[child.tag]
            step = child.tag if count == 1 else f"{child.tag}({count})"
            todo.append((child, f"{path}/{step}" if path else step))
    return content


def _parse_numbers(text: str) -> tuple[float, ...] | str:
    """Return the numbers of a text; the text if it has others than finite ones."""
    words = text.split()
    try:
        numbers = tuple(map(float, words))
    except ValueError:
        numbers = (math.nan,)
    return numbers if all(map(math.isfinite, numbers)) else " ".join(words)
