"""Bodies swept about the joints at their ends, so that a proof has fewer joints.

The joint next to a body turns it about an axis. All positions of the body are within the surface of
revolution that its points describe in a full turn. If that does not touch the other body at any
position of the other joints, the position of this joint does not matter. Most links are nearly
round about the joints at their ends, so little space is added; where it is too much, nothing is
proved.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..geometry.mesh import Array
from .chain import Chain, Step
from .cover import Cover, Piece, make_cover, make_hull

Covers = tuple[Cover, Cover]
Frame = tuple[Array, Array]
"""Rotation, shape (3, 3), and translation [m], shape (3,)."""

SLICES = 4
"""Convex pieces along the axis of a swept link; chosen, no source."""

CORNERS = 16
"""Corners of a circle around the axis, which they enclose; chosen, no source."""

ROUND = 1e-4
"""Inflation below which pieces are sliced together [m]; chosen, no source."""


def list_simpler(chain: Chain, covers: Covers) -> Iterator[tuple[Chain, Covers]]:
    """Yield proofs with fewer joints that imply the one of a chain, the simplest first.

    Args:
        chain: Joints between A and B.
        covers: Covers of A and of B.
    """
    first, last = (_remove_end(chain, covers, end) for end in (0, 1))
    both = None if last is None else _remove_end(*last, 0)
    for simpler in (both, last, first):
        if simpler is not None:
            yield simpler


def _remove_end(chain: Chain, covers: Covers, end: int) -> tuple[Chain, Covers] | None:
    """Remove the joint next to a body, and sweep the body; None if that cannot be done.

    It cannot for the last coordinate, a joint that translates, and one that another follows.

    Args:
        chain: Joints between A and B.
        covers: Covers of A and of B.
        end: 0 for A, 1 for B.
    """
    found = _find_end(chain, end)
    if found is None:
        return None
    step, frame, sides, place = found
    columns = [one.column for one in chain.steps]
    if step.slide or not step.turn or columns.count(step.column) > 1 or len(set(columns)) < 2:
        return None
    kept = [index for index in range(len(chain.coordinates)) if index != step.column]
    number = {old: new for new, old in enumerate(kept)}
    left, right = (tuple(replace(one, column=number[one.column]) for one in side) for side in sides)
    ends, swept = list(chain.ends), list(covers)
    ends[end], swept[end] = place, sweep_cover(covers[end], step.axis, frame)
    coordinates = tuple(chain.coordinates[index] for index in kept)
    simpler = replace(chain, sides=(left, right), ends=(ends[0], ends[1]), coordinates=coordinates)
    return simpler, (swept[0], swept[1])


def _find_end(chain: Chain, end: int) -> tuple[Step, Frame, list[tuple[Step, ...]], Frame] | None:
    """Find the joint next to a body.

    Returns:
        The joint; the pose of the body in the frame of the joint; the joints of both sides without
        it; and the pose of that frame after the joint that is then the last. None without a joint.
    """
    sides = list(chain.sides)
    if sides[end]:
        *before, step = sides[end]
        sides[end] = tuple(before)
        return step, chain.ends[end], sides, step.before
    other = sides[1 - end]
    if not other:
        return None
    step = other[0]
    sides[1 - end] = other[1:]
    (turn, shift), (rotation, translation) = step.before, chain.ends[end]
    frame = turn.T @ rotation, turn.T @ (translation - shift)
    return step, frame, sides, (np.eye(3), np.zeros(3))


def sweep_cover(cover: Cover, axis: Array, frame: Frame) -> Cover:
    """Cover what pieces sweep in a full turn.

    Args:
        cover: The pieces, in the frame of their body.
        axis: Unit vector through the origin, shape (3,).
        frame: Pose of the body in the frame of the axis.

    Returns:
        Pieces in the frame of the axis, with the links of the given ones.
    """
    key = b"".join(part.tobytes() for part in (axis, *frame))
    if key not in cover.swept:
        cover.swept[key] = make_cover(list(_list_drums(cover, axis, frame)))
    return cover.swept[key]


def _list_drums(cover: Cover, axis: Array, frame: Frame) -> Iterator[tuple[Piece, int]]:
    """Yield the swept pieces, with the index of their link."""
    rotation, translation = frame
    groups: dict[tuple[int, float], list[Array]] = {}
    for piece, owner in zip(cover.pieces, cover.owner.tolist(), strict=True):
        points = piece.points @ rotation.T + translation
        along = points @ axis
        from_axis = points - along[:, None] * axis
        profile = np.stack([along, np.sqrt((from_axis * from_axis).sum(axis=1))], axis=1)
        radius = 0.0 if piece.inflation < ROUND else piece.inflation
        groups.setdefault((owner, radius), []).append(_find_envelope(profile))
    thin = float(cover.inflation[cover.inflation < ROUND].max(initial=0.0))
    for (owner, radius), profiles in groups.items():
        for envelope in _slice(profiles):
            yield make_hull(_turn(envelope, axis), radius or thin), owner


def _find_envelope(profile: Array) -> Array:
    """Return the upper convex hull of points (along the axis, from the axis), by the first.

    Andrew's monotone chain (Inf. Process. Lett. 9, 1979).
    """
    hull: list[Array] = []
    for point in profile[np.lexsort((profile[:, 1], profile[:, 0]))]:
        while hull and (
            point[0] <= hull[-1][0]
            or (len(hull) > 1 and not _turns_right(hull[-2], hull[-1], point))
        ):
            hull.pop()
        hull.append(point)
    return np.array(hull)


def _turns_right(a: Array, b: Array, c: Array) -> bool:
    return bool((b[0] - a[0]) * (c[1] - a[1]) < (b[1] - a[1]) * (c[0] - a[0]))


def _slice(profiles: Sequence[Array]) -> Iterator[Array]:
    """Yield the envelopes of all profiles between equidistant planes across the axis."""
    low = min(float(profile[0, 0]) for profile in profiles)
    high = max(float(profile[-1, 0]) for profile in profiles)
    cuts = np.linspace(low, high, SLICES + 1 if high > low else 2)
    for begin, end in pairwise(cuts.tolist()):
        inside = [_cut(profile, begin, end) for profile in profiles]
        points = np.concatenate(inside)
        if len(points):
            yield _find_envelope(points)


def _cut(profile: Array, begin: float, end: float) -> Array:
    """Return the corners of a profile between two planes, and its points on them."""
    along, radius = profile.T
    planes = np.array([cut for cut in (begin, end) if along[0] <= cut <= along[-1]])
    on_planes = np.stack([planes, np.interp(planes, along, radius)], axis=1)
    between = profile[(along >= begin) & (along <= end)]
    return np.concatenate([between, on_planes])


def _turn(profile: Array, axis: Array) -> Array:
    """Return the corners of the polygons around the circles of a profile, shape (n, 3)."""
    least = np.eye(3)[int(np.argmin(abs(axis)))]
    across = np.cross(axis, least)
    across = across / np.linalg.norm(across)
    angles = np.arange(CORNERS) * (math.tau / CORNERS)
    circle = np.cos(angles)[:, None] * across + np.sin(angles)[:, None] * np.cross(axis, across)
    radii = profile[:, 1] / math.cos(math.pi / CORNERS)
    points: Array = profile[:, :1, None] * axis + radii[:, None, None] * circle
    return points.reshape(-1, 3)
