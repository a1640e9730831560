"""Detection of primitive geometry written in millimeters."""

from __future__ import annotations

import math
from collections.abc import Iterator

from .bounds import compute_size
from .elements import Collision, Link, Visual

_LEAST = 1.0
"""Minimum length [m] of geometry in millimeters: no part is thinner than a millimeter."""

_LARGEST = 10.0
"""Maximum plausible length [m] of a primitive of a robot. Chosen, no source."""

_SOLID = (5.0, 30_000.0)
"""Range of plausible densities [kg/m³], from foam to above the densest metal. Chosen, no source."""


def find_shapes_in_millimeters(link: Link) -> Iterator[Visual | Collision]:
    """Yield the primitive visuals and collisions of a link that are 1000 times too large.

    Geometry of more than 10 m may be intended. It is in millimeters if other geometry of the link
    has a thousandth of its lengths, or if the mass of the link gives a plausible density only in
    millimeters.
    """
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    sizes = [compute_size(shape.geometry) for shape in shapes]
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
