"""Several closed bodies in one mesh: solids, cavities, bodies within bodies.

What counts as solid is where the winding number, added up over all bodies, is above zero:

- a body that lies in no other is solid, also when it is inside out, which is taken as a slip;
- a body within another, wound the opposite way, is a cavity;
- a body within another, wound the same way, adds nothing: that space is solid already, and one
  density cannot be there twice. (Adding volumes instead would count it twice.)
- a solid within a cavity counts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .crossings import crossing_numbers
from .sampling import spread_points
from .tensor import Array
from .winding import Boxes, boxes_of, winding_numbers

PROBES = 24
"""Corners of a body that are looked at to tell whether it lies within another."""


@dataclass(frozen=True, eq=False)
class Nesting:
    """What each closed body contributes to the solid."""

    share: npt.NDArray[np.int64]
    """+1 solid, −1 cavity, 0 nothing."""
    overlaps: bool
    """Whether two bodies reach into each other in part."""
    turned: int
    """How many bodies were inside out."""
    swallowed: int
    """How many lie in the solid of another and add nothing."""
    cavities: int
    """How many are cavities."""


def nest(corners: list[Array], volumes: Array) -> Nesting:
    """How closed bodies lie within each other.

    Args:
        corners: The triangles [m] of each body, shape (m, 3, 3).
        volumes: The signed volume [m³] of each body.
    """
    count = len(corners)
    low = np.array([body.reshape(-1, 3).min(axis=0) for body in corners])
    high = np.array([body.reshape(-1, 3).max(axis=0) for body in corners])
    sign = np.where(volumes < 0, -1, 1)
    within = np.zeros((count, count), dtype=bool)
    overlaps = False
    boxes: dict[int, Boxes] = {}
    for outer in range(count):
        meets = (low < high[outer]).all(axis=1) & (high > low[outer]).all(axis=1)
        meets[outer] = False
        for inner in np.flatnonzero(meets):
            if abs(volumes[inner]) > abs(volumes[outer]):
                continue
            state = _relation(outer, int(inner), corners, low, high, boxes)
            within[inner, outer] = state == "within"
            overlaps = overlaps or state == "overlap"
    # the largest first, so that a body's hosts are settled before it
    share = np.zeros(count, dtype=np.int64)
    settled = sign.copy()
    turned = 0
    for body in np.argsort(-np.abs(volumes)):
        outside = int(settled[within[body]].sum())
        root_sign = _outermost_sign(within, sign, int(body))
        settled[body] = sign[body] * root_sign
        if outside + settled[body] < 0:
            settled[body] = 1
        turned += int(settled[body] != sign[body])
        share[body] = int(outside + settled[body] > 0) - int(outside > 0)
    return Nesting(
        share,
        overlaps,
        turned,
        int(np.count_nonzero(share == 0)),
        int(np.count_nonzero(share < 0)),
    )


def _outermost_sign(within: npt.NDArray[np.bool_], sign: npt.NDArray[np.int64], body: int) -> int:
    """The winding of the body that lies around all others around this one, or its own."""
    hosts = np.flatnonzero(within[body])
    roots = [host for host in hosts if not within[host].any()]
    return int(sign[roots[0]] if roots else sign[body])


def _relation(
    outer: int, inner: int, corners: list[Array], low: Array, high: Array, boxes: dict[int, Boxes]
) -> str:
    """``"within"``, ``"overlap"`` or ``"apart"``, of two bodies whose bounding boxes meet."""
    if outer not in boxes:
        boxes[outer] = boxes_of(corners[outer])
    points = corners[inner].reshape(-1, 3)
    probes = points[:: max(1, len(points) // PROBES)]
    number = np.abs(winding_numbers(probes, boxes[outer]))
    # near one half the probe lies on the other's surface and says nothing
    inside, outside = np.any(number > 0.9), np.any(number < 0.1)
    if inside and outside:
        return "overlap"
    if inside:
        return "within"
    shared_low = np.maximum(low[outer], low[inner])
    shared_high = np.minimum(high[outer], high[inner])
    points = spread_points(256, shared_low, shared_high)
    for body in (inner, outer):
        points = points[crossing_numbers(points, corners[body]) != 0] if len(points) else points
    return "overlap" if len(points) > 1 else "apart"
