"""Conservative repairs of a triangle surface: duplicate faces, winding, small holes.

No vertex is moved. Only duplicate faces are dropped, faces are flipped only to agree with their
neighbors, and faces are added only to close a rim.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Faces, Points
from ..geometry.topology import find_edges, label_components

CAP_RISE = 0.1
"""Assumed bulge of a surface over a hole, relative to the hole's size, for the error of a cap.
Chosen, no source.
"""


@dataclass(frozen=True, eq=False)
class Filling:
    """A surface without rims, with the error estimate of its caps."""

    vertices: Points
    faces: Faces
    holes: int
    """Number of closed rims."""
    area: float
    """Total area [m²] of all caps."""
    volume_error: float
    """Estimated volume [m³] between the caps and the missing surface."""


def drop_duplicates(faces: Faces) -> Faces:
    """Drop duplicate faces.

    Faces on the same three vertices with opposite winding cancel: they are a wall between two
    adjacent bodies. If canceling would remove most of the surface, each face was written once per
    side instead, and one of the two is kept.
    """
    ordered = np.sort(faces, axis=1)
    _, first, inverse = np.unique(ordered, axis=0, return_index=True, return_inverse=True)
    turned = _is_odd_permutation(faces)
    net = np.bincount(inverse.reshape(-1), weights=np.where(turned, -1.0, 1.0))
    alive = net != 0
    if np.count_nonzero(alive) < 0.5 * len(first):
        alive = np.ones(len(first), dtype=bool)
        net = np.where(turned[first], -1.0, 1.0)
    kept = ordered[first[alive]]
    backwards = net[alive] < 0
    kept[backwards] = kept[backwards][:, ::-1]
    return np.ascontiguousarray(kept)


def orient(vertices: Points, faces: Faces) -> tuple[Faces, int]:
    """Flip faces so that neighbors agree, and return the number of flipped faces.

    Two faces that alone share an edge are linked, both as written and flipped, which gives each
    connected component one winding (two for a Möbius strip, which is left unchanged). Of that
    winding and its opposite, the one that keeps more of the area is used, so a cavity stays a
    cavity.
    """
    count = len(faces)
    edges = find_edges(faces)
    sizes = np.diff(np.r_[edges.starts, len(edges.order)])
    pairs = edges.starts[sizes == 2]
    left, right = edges.order[pairs] // 3, edges.order[pairs + 1] // 3
    agree = edges.forward[sizes == 2] == 1
    other = np.where(agree, right, right + count)
    mirrored = np.where(agree, right + count, right)
    labels = label_components(2 * count, np.r_[left, left + count], np.r_[other, mirrored])
    corners = vertices[faces]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    as_is, turned = labels[:count], labels[count:]
    score = np.bincount(as_is, weights=areas, minlength=int(labels.max(initial=-1)) + 1)
    turn = (score[as_is] < score[turned]) | ((score[as_is] == score[turned]) & (as_is > turned))
    result = faces.copy()
    result[turn] = result[turn][:, ::-1]
    return result, int(np.count_nonzero(turn))


def fill_holes(vertices: Points, faces: Faces) -> Filling:
    """Close every rim by a fan about the center of its loop.

    The rims of a consistently wound surface always form closed loops, and a fan closes each
    exactly. For a flat loop the fan is the correct surface for any shape of the loop. The error of
    a cap is its area times the sum of the loop's deviation from a plane and ``CAP_RISE`` times its
    size.
    """
    edges = find_edges(faces)
    surplus = edges.forward - edges.backward
    rim = np.flatnonzero(surplus)
    repeat = np.abs(surplus[rim])
    # a cap traverses the rim in the direction opposite to the adjacent face
    ends = np.where(surplus[rim, None] > 0, edges.pairs[rim][:, ::-1], edges.pairs[rim])
    loops = _split_loops(np.repeat(ends, repeat, axis=0))
    caps: list[Faces] = []
    centers: list[Points] = []
    area = error = 0.0
    for loop in loops:
        ring = vertices[loop]
        if len(loop) < 3:
            continue
        middle = ring.mean(axis=0)
        spokes = ring - middle
        normal = np.cross(spokes, np.roll(spokes, -1, axis=0)).sum(axis=0) / 2
        cap_area = float(np.linalg.norm(normal))
        rise = float(np.abs(spokes @ normal).max()) / cap_area if cap_area > 0 else 0.0
        area += cap_area
        error += cap_area * (rise + CAP_RISE * cap_area**0.5)
        if len(loop) == 3:
            caps.append(loop[None, :])
            continue
        center = np.full(len(loop), len(vertices) + len(centers))
        centers.append(middle)
        caps.append(np.stack([loop, np.roll(loop, -1), center], axis=1))
    points = np.concatenate([vertices, np.array(centers).reshape(-1, 3)])
    return Filling(points, np.concatenate([faces, *caps]), len(caps), area, error)


def _is_odd_permutation(faces: Faces) -> npt.NDArray[np.bool_]:
    """Determine for each face whether sorting its vertices reverses its winding."""
    a, b, c = faces.T
    inversions = (a > b).astype(int) + (a > c) + (b > c)
    return np.asarray(inversions % 2 == 1)


def _split_loops(directed: Faces) -> list[Faces]:
    """Split directed edges into closed loops without repeated vertices."""
    onward: dict[int, list[int]] = {}
    for begin, end in directed.tolist():
        onward.setdefault(begin, []).append(end)
    loops = []
    for start in list(onward):
        path = [start]
        place = {start: 0}
        while onward.get(path[-1]):
            after = onward[path[-1]].pop()
            if after not in place:
                place[after] = len(path)
                path.append(after)
                continue
            loop = path[place[after] :]
            loops.append(np.array(loop, dtype=np.int64))
            for vertex in loop[1:]:
                del place[vertex]
            del path[place[after] + 1 :]
    return loops
