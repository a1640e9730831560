"""Several closed bodies in one mesh: solids, cavities, nested bodies.

Space is solid where the winding number, summed over all bodies, is above zero:

- a body that lies in no other is solid, even if it is inverted, which is treated as an error;
- a body within another, wound the opposite way, is a cavity;
- a body within another, wound the same way, adds nothing, as that space is already solid (a sum of
  volumes would count it twice);
- a solid within a cavity counts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Array
from .crossings import compute_crossing_numbers
from .sampling import spread_points
from .winding import compute_winding_numbers, sort_into_boxes

PROBES = 24
"""Number of corners of a body that are tested for lying within another. Chosen, no source."""


_ASIDE = np.array([3.7e-7, 6.1e-7, 5.3e-7])
"""Offset of tested corners, relative to the size of the outer body, so that no ray hits an edge."""


@dataclass(frozen=True, eq=False)
class Nesting:
    """Contribution of each closed body to the solid."""

    share: npt.NDArray[np.int64]
    """+1 for a solid, −1 for a cavity, 0 for no contribution."""
    overlaps: bool
    """Whether two bodies overlap partly."""
    turned: int
    """Number of inverted bodies."""
    swallowed: int
    """Number of bodies within the solid of another, which add nothing."""
    cavities: int
    """Number of cavities."""


MAX_BODIES, MAX_RELATIONS = 5000, 10_000
"""Number of closed bodies, and of pairs whose bounding boxes meet, up to which each pair is looked
at, about 10 s of processor time; above, bodies count as overlapping."""


def nest(corners: list[Array], volumes: Array) -> Nesting:
    """Determine how closed bodies are nested.

    Args:
        corners: Triangles [m] of each body, shape (m, 3, 3).
        volumes: Signed volume [m³] of each body.
    """
    count = len(corners)
    unknown = Nesting(np.ones(count, dtype=np.int64), True, 0, 0, 0)
    if count > MAX_BODIES:
        return unknown
    low = np.array([body.reshape(-1, 3).min(axis=0) for body in corners])
    high = np.array([body.reshape(-1, 3).max(axis=0) for body in corners])
    sign = np.where(volumes < 0, -1, 1)
    within = np.zeros((count, count), dtype=bool)
    overlaps = False
    bodies = [_Body(body, body.min(axis=1), body.max(axis=1)) for body in corners]
    relations = 0
    for outer in range(count):
        meets = (low < high[outer]).all(axis=1) & (high > low[outer]).all(axis=1)
        meets &= np.abs(volumes) <= abs(volumes[outer])
        meets[outer] = False
        inners = np.flatnonzero(meets).tolist()
        relations += len(inners)
        if relations > MAX_RELATIONS:
            return unknown
        for inner, number in zip(
            inners, _probe_corners(outer, inners, bodies, low, high), strict=True
        ):
            shared = np.maximum(low[outer], low[inner]), np.minimum(high[outer], high[inner])
            state = _get_relation(number, (bodies[inner], bodies[outer]), *shared)
            within[inner, outer] = state == "within"
            overlaps = overlaps or state == "overlap"
    # largest first, so that enclosing bodies are settled before enclosed ones
    share = np.zeros(count, dtype=np.int64)
    settled = sign.copy()
    turned = 0
    for body in np.argsort(-np.abs(volumes)):
        outside = int(settled[within[body]].sum())
        root_sign = _get_outermost_sign(within, sign, int(body))
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


def _get_outermost_sign(
    within: npt.NDArray[np.bool_], sign: npt.NDArray[np.int64], body: int
) -> int:
    """Return the winding of the outermost body around this one, or its own if there is none."""
    hosts = np.flatnonzero(within[body])
    roots = [host for host in hosts if not within[host].any()]
    return int(sign[roots[0]] if roots else sign[body])


class _Body(NamedTuple):
    """A closed body: its triangles and the bounding box of each."""

    corners: Array
    low: Array
    high: Array


def _probe_corners(
    outer: int, inners: list[int], bodies: list[_Body], low: Array, high: Array
) -> list[Array]:
    """Compute the winding number of a body at some corners of each other body.

    Ray crossings are fast and exclude most bodies that have no corner inside. Only for the others
    are solid angles computed, which are also valid for points on the surface.
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
        met = owner[near][compute_crossing_numbers(beside, bodies[outer].corners) != 0]
        near &= np.isin(owner, met)
    if near.any():
        numbers[near] = np.abs(
            compute_winding_numbers(points[near], sort_into_boxes(bodies[outer].corners))
        )
    return np.split(numbers, np.cumsum([len(some) for some in probes])[:-1])


def _get_relation(number: Array, pair: tuple[_Body, _Body], low: Array, high: Array) -> str:
    """Return ``"within"``, ``"overlap"`` or ``"apart"`` for two bodies whose bounding boxes meet.

    ``low`` and ``high`` are the corners of the intersection of the boxes.
    """
    # a value near one half is on the other's surface and is inconclusive
    inside, outside = np.any(number > 0.9), np.any(number < 0.1)
    if inside and outside:
        return "overlap"
    if inside:
        return "within"
    points = spread_points(256, low, high)
    for body in pair:
        near = ((body.high >= low) & (body.low <= [high[0], high[1], np.inf])).all(axis=1)
        if len(points):
            points = points[compute_crossing_numbers(points, body.corners[near]) != 0]
    return "overlap" if len(points) > 1 else "apart"
