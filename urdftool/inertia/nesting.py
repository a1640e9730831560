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
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Array
from .crossings import crossing_numbers
from .sampling import spread_points
from .winding import boxes_of, winding_numbers

PROBES = 24
"""Corners of a body that are looked at to tell whether it lies within another."""


_ASIDE = np.array([3.7e-7, 6.1e-7, 5.3e-7])
"""By how much of a body's size corners are moved, so that no ray meets an edge that is above."""


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
    bodies = [_Body(body, body.min(axis=1), body.max(axis=1)) for body in corners]
    for outer in range(count):
        meets = (low < high[outer]).all(axis=1) & (high > low[outer]).all(axis=1)
        meets &= np.abs(volumes) <= abs(volumes[outer])
        meets[outer] = False
        inners = np.flatnonzero(meets).tolist()
        for inner, number in zip(inners, _probed(outer, inners, bodies, low, high), strict=True):
            shared = np.maximum(low[outer], low[inner]), np.minimum(high[outer], high[inner])
            state = _relation(number, (bodies[inner], bodies[outer]), *shared)
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


class _Body(NamedTuple):
    """A closed body: its triangles, and the box around each of them."""

    corners: Array
    low: Array
    high: Array


def _probed(
    outer: int, inners: list[int], bodies: list[_Body], low: Array, high: Array
) -> list[Array]:
    """How often a body winds round some corners of others, for each of them.

    Crossings tell for a fraction of the work of whom no corner is inside; only for the others are
    solid angles looked at, which know what lies on the surface.
    """
    if not inners:
        return []
    probes = []
    for inner in inners:
        points = bodies[inner].corners.reshape(-1, 3)
        probes.append(points[:: max(1, len(points) // PROBES)])
    points = np.concatenate(probes)
    numbers = np.zeros(len(points))
    near = ((points >= low[outer]) & (points <= high[outer])).all(axis=1)
    if near.any():
        beside = points[near] + _ASIDE * float((high[outer] - low[outer]).max())
        owner = np.repeat(np.arange(len(probes)), [len(some) for some in probes])
        met = owner[near][crossing_numbers(beside, bodies[outer].corners) != 0]
        near &= np.isin(owner, met)
    if near.any():
        numbers[near] = np.abs(winding_numbers(points[near], boxes_of(bodies[outer].corners)))
    return np.split(numbers, np.cumsum([len(some) for some in probes])[:-1])


def _relation(number: Array, pair: tuple[_Body, _Body], low: Array, high: Array) -> str:
    """``"within"``, ``"overlap"`` or ``"apart"``, of two bodies whose bounding boxes meet.

    Args:
        number: How often the outer winds round some corners of the inner.
        pair: The inner and the outer body.
        low: Smallest corner of the space that both boxes share.
        high: Its largest corner.
    """
    # near one half the probe lies on the other's surface and says nothing
    inside, outside = np.any(number > 0.9), np.any(number < 0.1)
    if inside and outside:
        return "overlap"
    if inside:
        return "within"
    points = spread_points(256, low, high)
    for body in pair:
        near = ((body.high >= low) & (body.low <= [high[0], high[1], np.inf])).all(axis=1)
        if len(points):
            points = points[crossing_numbers(points, body.corners[near]) != 0]
    return "overlap" if len(points) > 1 else "apart"
