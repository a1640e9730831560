"""Primitive shapes whose lengths are written in millimeters."""

from __future__ import annotations

import math
from collections.abc import Iterator

from .bounds import size_of
from .elements import Collision, Link, Visual

_LEAST = 1.0
"""Shortest length [m] of a shape in millimeters: a part of a millimeter is not built."""

_LARGEST = 10.0
"""Longest length [m] of a primitive shape of a robot."""

_SOLID = (5.0, 30_000.0)
"""Densities of bodies [kg/m³], from foam to more than the densest metal."""


def shapes_in_millimeters(link: Link) -> Iterator[Visual | Collision]:
    """Find the primitive shapes of a link that are a thousand times too large.

    A shape of more than ten meters may be meant. It is in millimeters where another shape of the
    link has a thousandth of its lengths, or where the mass of the link gives the density of a body
    in millimeters, and that of a vacuum in meters.
    """
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    sizes = [size_of(shape.geometry) for shape in shapes]
    for shape, size in zip(shapes, sizes, strict=True):
        if size is None or min(size) < _LEAST or max(size) < _LARGEST:
            continue
        thousandth = sorted(length / 1000 for length in size)
        if any(other is not None and _is_close(sorted(other), thousandth) for other in sizes) or (
            _SOLID[0] <= link.mass / math.prod(thousandth) <= _SOLID[1]
        ):
            yield shape


def _is_close(one: list[float], other: list[float]) -> bool:
    return all(math.isclose(a, b, rel_tol=0.01) for a, b in zip(one, other, strict=True))
