"""Shapes that no reader measures, by what is written of them; planes, by their drawn size."""

from __future__ import annotations

import numpy as np

from ..model.elements import Geometry, Mesh, Plane, UnknownShape
from .pair import Pair
from .tolerance import is_same
from .unread import is_one_text

_TOLERANCE = 1e-6
"""Relative tolerance of numbers of shapes that are not read; chosen, no source."""


def has_equal_content(
    pair: Pair, row: str, shapes: tuple[Geometry, Geometry], tolerance: float
) -> bool:
    """Tell whether two shapes that are not read, or two planes, are not known to differ.

    Planes have a size in the row ``visuals`` only.
    """
    one, two = shapes
    if isinstance(one, Plane) and isinstance(two, Plane):
        return row != "visuals" or _has_equal_extent(pair, one, two, tolerance)
    if not isinstance(one, UnknownShape) or not isinstance(two, UnknownShape):
        return True
    is_known = None not in (one.content, two.content) and pair.formats[0] == pair.formats[1]
    return not is_known or is_same(one.content, two.content, _TOLERANCE)


def _has_equal_extent(pair: Pair, one: Plane, two: Plane, tolerance: float) -> bool:
    """Tell whether two planes are drawn in equal size, as far as both files say one."""
    if one.size is None or two.size is None:
        return one.size is two.size or pair.formats[0] != pair.formats[1]
    return bool(np.allclose(one.size, two.size, rtol=0.0, atol=tolerance))


def explain_unknown(pair: Pair, shapes: tuple[UnknownShape, UnknownShape]) -> str:
    """Return why it is unknown whether two shapes, not read, are equal; empty if they are."""
    one, two = shapes
    robots = pair.a.robot, pair.b.robot
    if is_one_text(*robots):
        return ""
    if None in (one.content, two.content) or pair.formats[0] != pair.formats[1]:
        return "what it contains is not read"
    for names in zip(one.files, two.files, strict=False):
        files = Mesh(None, names[0]), Mesh(None, names[1])
        paths = [pair.meshes.find(*side) for side in zip(robots, files, strict=True)]
        digests = {None if path is None else pair.meshes.get_digest(path) for path in paths}
        if not pair.meshes.is_one_file(robots, files) and (None in digests or len(digests) > 1):
            return f"the content of {names[0]} is not compared"
    return ""
