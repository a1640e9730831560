"""Convex partition of a surface by planes that are chosen, and joins that are made, by the error.

A part is the surface inside its cell; the hull of a clipped surface is that of the clipped solid,
so cuts need no caps. The cost of a part is the larger one of its *bulge*, by which its hull
protrudes from the visual, and its *burial*, the depth of exterior points of the visual inside the
hull. Faces of the hull on a cut are inside the union of the parts and do not count for burial. They
count for the bulge, since the part on the other side may leave their concave regions open.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from ..geometry.hull import FLAT
from ..geometry.mesh import Faces, Points
from .distance import spread
from .exterior import Exterior
from .vec3 import compute_lengths, compute_normals

# chosen, no source, where a line gives none
_HULL_SAMPLES = 600  # samples of a hull, whose distance from the mesh is read
_BURIED_POINTS = 4  # through each of which planes are tried
_PRICED = 4  # planes, those with the smallest hulls, whose parts are priced
_OTHER, _VOLUME = 0.3, 0.3  # weights of the cheaper part and of the volume in the choice
_INTERNAL = 2e-4  # distance of a hull's face from a cut, relative to the size
_FLUSH = 1e-7  # distance of a point from a plane that it is in, relative to the size
_TOUCH = 0.01  # largest gap between parts that are joined, relative to the size
_GRID_SHARES = (0.3, 0.5, 0.7)
"""Positions of cuts that are tried, as shares of the extent of a piece. Chosen, no source."""

Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Probes:
    """Exterior points of the visual.

    Attributes:
        points: Positions [m], shape (n, 3).
        normals: Unit normals, shape (n, 3).
        extra: Depth [m] by which the union of parts buries a point more than each part does.
    """

    points: Points
    normals: Points
    extra: Points


@dataclass(eq=False)
class Part:
    """A part of a surface, with the cost of its convex hull.

    Attributes:
        points: Points of the clipped surface [m]; after a join, of the hulls.
        faces: Its triangles; none after a join.
        cuts: Planes that bound the part, as normal and offset, shape (k, 4).
        hull: Points of the hull [m].
        volume: Volume of the hull [m³].
        bulge: Largest distance [m] by which the hull protrudes from the visual.
        burial: Largest depth [m] of a probe in the hull.
        bulges: The point of the hull that protrudes most.
        buried: Indices of deep probes, the deepest first.
        sides: Planes of the hull's faces, shape (m, 4).
        inner: Whether each face is on a cut.
    """

    points: Points
    faces: Faces
    cuts: Points
    hull: Points
    volume: float
    sides: Points
    inner: Mask
    bulge: float = 0.0
    burial: float = 0.0
    bulges: Points = field(default_factory=lambda: np.zeros(3))
    buried: npt.NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))

    @property
    def cost(self) -> float:
        """Return the larger one of bulge and burial [m]."""
        return max(self.bulge, self.burial)


class Partition:
    """Convex partition of one surface."""

    def __init__(self, exterior: Exterior, probes: Probes, size: float) -> None:
        """Set the visual.

        Args:
            exterior: Its flooded surroundings.
            probes: Its exterior points.
            size: Length [m] to which tolerances are relative.
        """
        self.exterior = exterior
        self.probes = probes
        self.size = size
        centered = probes.points - probes.points.mean(axis=0)
        _, axes = np.linalg.eigh(centered.T @ centered)
        near = np.abs(axes.T).max(axis=1) > 0.99
        self.axes = np.concatenate([np.eye(3), axes.T[~near]])
        self._joins: dict[tuple[Part, Part], Part | None] = {}

    def make_whole(self, vertices: Points, faces: Faces) -> Part | None:
        """Return the uncut part; None if it is flat."""
        return self._make_part(vertices, faces, np.zeros((0, 4)))

    def update_cost(self, part: Part) -> Part:
        """Return a part with its cost by these probes."""
        return self._make_part(part.points, part.faces, part.cuts, part.hull) or part

    def cut(
        self, parts: Sequence[Part], most: int, within: float, *, dense: bool = False
    ) -> list[Part]:
        """Cut the costliest part again and again.

        Args:
            parts: The parts.
            most: Number of parts at which to stop.
            within: Cost [m] at which a part is not cut.
            dense: Whether to try more planes.
        """
        living = list(parts)
        final: set[int] = set()
        while len(living) < most:
            costly = [p for p in living if p.cost > within and id(p) not in final]
            if not costly:
                break
            part = max(costly, key=lambda p: p.cost)
            both = self._split(part, dense=dense)
            if both is None:
                final.add(id(part))
                continue
            living.remove(part)
            living += both
        return living

    def _split(self, part: Part, *, dense: bool) -> list[Part] | None:
        ranked: list[tuple[float, int, Points]] = []
        for plane in self._list_planes(part, dense=dense):
            height = _compute_signed_heights(part.points, plane, _FLUSH * self.size)
            sides = [_compute_side(part.points, part.faces, sign * height) for sign in (1, -1)]
            volumes = [_compute_volume(side) for side in sides]
            if min(volumes) > 1e-4 * part.volume:
                ranked.append((sum(volumes), len(ranked), plane))
        best, least = None, np.inf
        for volume, _, plane in sorted(ranked, key=lambda item: item[:2])[
            : 2 * _PRICED if dense else _PRICED
        ]:
            shared = _VOLUME * part.cost * volume / part.volume
            both = self._clip_part(part, plane, least - shared)
            if both is None:
                continue
            low, high = sorted(p.cost for p in both)
            score = high + _OTHER * low + shared
            if score < least:
                best, least = both, score
        return best

    def _list_planes(self, part: Part, *, dense: bool) -> Iterator[Points]:
        """Yield candidate planes: through the worst points, and at shares of the extent."""
        places: list[tuple[Points, Points]] = []
        for index in part.buried:
            point = self.probes.points[index]
            places.append((point, np.concatenate([self.probes.normals[index][None], self.axes])))
        if part.bulge > 0.5 * part.burial:
            places.append((part.bulges, self.axes))
        for point, directions in places:
            for normal in directions:
                yield np.append(normal, normal @ point)
        if dense or not places:
            along = part.hull @ self.axes.T
            low, high = along.min(axis=0), along.max(axis=0)
            for share in _GRID_SHARES:
                for normal, offset in zip(self.axes, low + share * (high - low), strict=True):
                    yield np.append(normal, offset)

    def _clip_part(self, part: Part, plane: Points, most: float) -> list[Part] | None:
        """Cut a part by a plane; return None if a side is flat, or costs more than a bound [m]."""
        made: list[Part] = []
        if most <= 0:
            return None
        for side in (plane, -plane):
            points, faces = clip(part.points, part.faces, side, _FLUSH * self.size)
            found = self._make_part(points, faces, np.concatenate([part.cuts, side[None]]))
            if found is None or found.cost >= most:
                return None
            made.append(found)
        return made

    def _make_part(
        self, points: Points, faces: Faces, cuts: Points, ends: Points | None = None
    ) -> Part | None:
        """Create a part with its cost; ``ends`` are points that have the same hull."""
        from scipy.spatial import ConvexHull, QhullError

        ends = points if ends is None else ends
        try:
            hull = ConvexHull(ends)
        except (QhullError, ValueError):
            return None
        sides = hull.equations * np.array([1, 1, 1, -1])
        if hull.volume < FLAT * self.size**3:
            return None
        inner = self._find_faces_on_cuts(ends[hull.simplices], sides, cuts)
        volume = float(hull.volume)
        part = Part(points, faces, cuts, ends[hull.vertices], volume, sides, inner)
        self._compute_bulge(part, ends[hull.simplices])
        self._compute_burial(part)
        return part

    def _find_faces_on_cuts(self, corners: Points, sides: Points, cuts: Points) -> Mask:
        """Find the faces of a hull that are on cuts, as a mask."""
        is_on_cut = np.zeros(len(sides), dtype=bool)
        middle = corners.mean(axis=1)
        for cut in cuts:
            along = sides[:, :3] @ cut[:3] > 0.99
            is_on_cut |= along & (np.abs(middle @ cut[:3] - cut[3]) < _INTERNAL * self.size)
        return is_on_cut

    def _compute_bulge(self, part: Part, corners: Points) -> None:
        if not len(corners):
            return
        samples = spread(corners, _HULL_SAMPLES).points
        off = self.exterior.interpolate(self.exterior.beyond, samples)
        worst = int(np.argmax(off))
        part.bulge, part.bulges = float(off[worst]), samples[worst]

    def _compute_burial(self, part: Part) -> None:
        probes = self.probes.points
        low, high = part.hull.min(axis=0), part.hull.max(axis=0)
        near = np.flatnonzero(((probes > low) & (probes < high)).all(axis=1))
        if not len(near):
            return
        depth = compute_burial(part, probes[near])
        depth = np.where(depth > 0, depth + self.probes.extra[near], 0)
        order = np.argsort(-depth)
        part.burial = float(depth[order[0]])
        part.buried = near[_spread_out(probes[near], order, depth, part.burial)]

    def join(self, parts: Sequence[Part], within: float, most: int = 1) -> list[Part]:
        """Join parts pairwise, the cheapest join first.

        Args:
            parts: The parts.
            within: Largest cost [m] of a join, while there are few enough parts.
            most: Largest number of parts that is acceptable at any cost.
        """
        living = list(parts)
        while len(living) > 1:
            pairs = self._list_joins(living)
            if not pairs:
                break
            cost, a, b, both = min(pairs, key=lambda pair: pair[:3])
            if cost > within and len(living) <= most:
                break
            living = [p for k, p in enumerate(living) if k not in (a, b)] + [both]
        return living

    def _list_joins(self, parts: Sequence[Part]) -> list[tuple[float, int, int, Part]]:
        """Return cost, indices and result of each possible join."""
        gap = _TOUCH * self.size
        low = np.array([part.hull.min(axis=0) for part in parts])
        high = np.array([part.hull.max(axis=0) for part in parts])
        joins = []
        for a, one in enumerate(parts):
            near = ((low <= high[a] + gap) & (high >= low[a] - gap)).all(axis=1)
            for b in np.flatnonzero(near[:a]).tolist():
                both = self._join_pair(one, parts[b])
                if both is not None:
                    joins.append((both.cost, b, a, both))
        return joins

    def _join_pair(self, one: Part, other: Part) -> Part | None:
        key = (one, other)
        if key not in self._joins:
            self._joins[key] = self._make_part(
                np.concatenate([one.points, other.points]),
                np.concatenate([one.faces, other.faces + len(one.points)]),
                self._find_common_cuts(one, other),
                np.concatenate([one.hull, other.hull]),
            )
        return self._joins[key]

    def _find_common_cuts(self, one: Part, other: Part) -> Points:
        """Return the cuts on which the hull of two parts has no face but those of the parts."""
        cuts = np.unique(np.concatenate([one.cuts, other.cuts]), axis=0)
        kept = np.ones(len(cuts), dtype=bool)
        for part in (one, other):
            below = (part.hull @ cuts[:, :3].T - cuts[:, 3]).max(axis=0, initial=-np.inf)
            own = (cuts[:, None] == part.cuts).all(axis=2).any(axis=1)
            kept &= own | (below < -2 * _INTERNAL * self.size)
        return cuts[kept]

    def refine(
        self, parts: Sequence[Part], within: float, rounds: int, *, dense: bool = False
    ) -> list[Part]:
        """Cut the costliest part and join the cheapest others, as long as the cost decreases.

        Args:
            parts: The parts, whose number stays.
            within: Cost [m] at which to stop.
            rounds: Largest number of cuts.
            dense: Whether to try more planes.
        """
        living = list(parts)
        for _ in range(rounds):
            worst = max(living, key=lambda p: p.cost)
            if worst.cost <= within:
                break
            both = self._split(worst, dense=dense)
            if both is None or max(p.cost for p in both) >= worst.cost:
                break
            others = [p for p in living if p is not worst] + both
            joins = [pair for pair in self._list_joins(others) if pair[0] < worst.cost]
            if not joins:
                break
            _, a, b, joined = min(joins, key=lambda pair: pair[:3])
            living = [p for k, p in enumerate(others) if k not in (a, b)] + [joined]
        return living


def clip(points: Points, faces: Faces, plane: Points, flush: float = 0.0) -> tuple[Points, Faces]:
    """Return the part of a surface below a plane.

    A triangle in the plane belongs to the side of its solid, which is behind its normal.

    Args:
        points: Points [m].
        faces: Triangles.
        plane: Normal and offset [m].
        flush: Distance [m] up to which a point is in the plane.
    """
    height = _compute_signed_heights(points, plane, flush)
    above = height[faces] > 0
    count = above.sum(axis=1)
    kept = [faces[(count == 0) & ~_find_opposite_faces(points, faces, plane, height)]]
    more = [points]
    total = len(points)
    for alone in (True, False):  # whether the corner that differs is above
        rows = faces[(count == (1 if alone else 2)) & (height[faces] < 0).any(axis=1)]
        if not len(rows):
            continue
        first = np.argmax((height[rows] > 0) == alone, axis=1)[:, None]
        a, b, c = np.take_along_axis(rows, (first + np.arange(3)) % 3, axis=1).T
        to_b, to_c = (_compute_crossing(points, height, a, other) for other in (b, c))
        new_b = total + np.arange(len(rows))
        new_c = new_b + len(rows)
        more += [to_b, to_c]
        total += 2 * len(rows)
        if alone:  # where a corner is in the plane, the crossing is that corner
            wide_b, wide_c = height[b] < 0, height[c] < 0
            kept += [
                np.stack([new_b, b, c], axis=1)[wide_b],
                np.stack([np.where(wide_b, new_b, b), c, new_c], axis=1)[wide_c],
            ]
        else:
            kept.append(np.stack([a, new_b, new_c], axis=1))
    used, inverse = np.unique(np.concatenate(kept), return_inverse=True)
    return np.concatenate(more)[used], inverse.reshape(-1, 3)


def _compute_signed_heights(points: Points, plane: Points, flush: float) -> Points:
    """Compute the distance [m] of points above a plane; 0 for those within ``flush`` of it."""
    height = points @ plane[:3] - plane[3]
    return np.where(np.abs(height) <= flush, 0.0, height)


def _find_opposite_faces(points: Points, faces: Faces, plane: Points, height: Points) -> Mask:
    """Find triangles that are in a plane, with a normal against the plane's, as a mask."""
    is_opposite = np.zeros(len(faces), dtype=bool)
    flat = np.flatnonzero((height[faces] == 0).all(axis=1))
    is_opposite[flat] = compute_normals(points[faces[flat]]) @ plane[:3] <= 0
    return is_opposite


def _compute_crossing(points: Points, height: Points, a: Faces, b: Faces) -> Points:
    share = (height[a] / (height[a] - height[b]))[:, None]
    return np.asarray(points[a] + share * (points[b] - points[a]))


def _compute_side(points: Points, faces: Faces, height: Points) -> Points:
    """Compute points that have the hull of the surface at negative heights."""
    below = height < 0
    pairs = [points[below]]
    for a, b in ((0, 1), (1, 2), (2, 0)):
        for one, other in ((a, b), (b, a)):
            some = faces[below[faces[:, one]] & ~below[faces[:, other]]]
            pairs.append(_compute_crossing(points, height, some[:, one], some[:, other]))
    return np.concatenate(pairs)


def _compute_volume(points: Points) -> float:
    """Compute the volume [m³] of a hull; 0 if it is flat."""
    from scipy.spatial import ConvexHull, QhullError

    if len(points) < 4:
        return 0.0
    try:
        return float(ConvexHull(points).volume)
    except (QhullError, ValueError):
        return 0.0


def compute_burial(part: Part, points: Points) -> Points:
    """Compute the depth [m] of points in the hull of a part; 0 outside.

    Faces on cuts do not count, as they are inside the union of the parts.
    """
    if part.inner.all():
        return np.zeros(len(points))
    height = _compute_heights(points, part.sides)
    depth = np.where(height.max(axis=0) < 0, -height[~part.inner].max(axis=0), 0.0)
    return np.asarray(depth, dtype=np.float64)


def _compute_heights(points: Points, sides: Points) -> npt.NDArray[np.float32]:
    """Compute the distance [m] of points above planes, shape (planes, points)."""
    columns = np.concatenate([points.T, np.ones((1, len(points)))]).astype(np.float32)
    rows = np.concatenate([sides[:, :3], -sides[:, 3:]], axis=1).astype(np.float32)
    return np.asarray(rows @ columns)


def _spread_out(points: Points, order: Faces, depth: Points, burial: float) -> list[int]:
    """Choose the deepest points that are not close to each other."""
    chosen: list[int] = []
    candidates = order[:200]
    candidates = candidates[depth[candidates] > 0.5 * burial]
    while len(candidates) and len(chosen) < _BURIED_POINTS and burial > 0:
        chosen.append(int(candidates[0]))
        off = np.linalg.norm(points[candidates] - points[candidates[0]], axis=1)
        candidates = candidates[off > burial]
    return chosen


def make_probes(
    points: Points, corners: Points, owners: npt.NDArray[np.int64], extra: Points
) -> Probes:
    """Create probes from points [m] of triangles, and the index of the triangle of each."""
    normal = compute_normals(corners[owners])
    long = compute_lengths(normal)
    return Probes(points, normal / np.where(long > 0, long, 1.0)[:, None], extra)
