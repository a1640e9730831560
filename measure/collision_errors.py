"""Measure errors of collision pieces again: ``python -m measure.collision_errors MESH...``.

Each mesh is simplified as ``urdftool collision mesh --quality Q`` does. Points are then measured
that a ball, 1.1 times as large as that of ``collision``, touches: it has room there, and leaves
along a straight line. *Reach* is the largest distance of such a point of the mesh from the surface
of the union of the pieces, *excess* that of a point of this surface from the mesh. A ball can also
come around corners, so both can be smaller than what ``collision`` declares; a larger one shows
that the declared one is too low. Lengths are in percent of the diagonal. Of urdftool's code, only
the reader and the pieces are used.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.ndimage import distance_transform_edt
from scipy.spatial import ConvexHull, cKDTree

from urdftool.collision.compute import Task, compute
from urdftool.collision.settings import Settings
from urdftool.geometry.load import load_mesh

Array = npt.NDArray[np.float64]
Test = Callable[[Array], npt.NDArray[np.bool_]]

BALL, WIDER, CLEAR = 0.015, 1.1, 0.95
"""Radius of the ball of ``collision``, relative to the diagonal; ratio of the radius here; part of
it that has to be free, since only some directions are tried. The last two are chosen, no source."""

SAMPLES, DIRECTIONS, BATCH = 400_000, 100, 500
"""Samples of a surface, directions of the ball from a point, points tried at first; chosen, no
source."""

CELL = 0.25
"""Edge of a cell of which only the farthest sample is tried, in radii; chosen, no source."""

GRID = 5
"""Cells of the grid of bounds a radius; chosen, no source: it changes the time, not the result."""


@dataclass(frozen=True)
class Dense:
    """A densely sampled surface.

    Attributes:
        points: Samples [m].
        radius: Radius of the ball [m].
    """

    points: Array
    radius: float

    @cached_property
    def tree(self) -> cKDTree:
        """Return the search structure of the samples."""
        return cKDTree(self.points)

    @cached_property
    def bounds(self) -> tuple[Array, Array, float]:
        """Return a grid of distances of cells from cells with samples [m], its corner and edge.

        The distance of a point from the samples differs by at most sqrt(3) edges from that of its
        cell: both are half a diagonal or less from the middles of their cells.
        """
        edge = self.radius / GRID
        low = self.points.min(axis=0) - 2.5 * self.radius
        shape = np.ceil((self.points.max(axis=0) + 2.5 * self.radius - low) / edge).astype(int)
        empty = np.ones(shape, dtype=bool)
        empty[tuple(((self.points - low) / edge).astype(int).T)] = False
        return distance_transform_edt(empty, sampling=edge), low, edge

    def measure_room(self, points: Array) -> Array:
        """Measure distances from the samples [m]: exact near ``CLEAR`` radii, else a lower bound.

        Points outside of the grid are as far as the nearest cell of it, or farther.
        """
        grid, low, edge = self.bounds
        index = np.clip(((points - low) / edge).astype(int), 0, np.array(grid.shape) - 1)
        about, slack = grid[tuple(index.T)], 3**0.5 * edge
        room = np.maximum(about - slack, 0)
        near = np.abs(about - CLEAR * self.radius) <= slack
        room[near] = self.tree.query(points[near])[0]
        return np.asarray(room)

    def find_touched(self, points: Array) -> npt.NDArray[np.bool_]:
        """Tell which points a ball touches that leaves along a straight line."""
        found = np.zeros(len(points), dtype=bool)
        centers = points[:, None] + self.radius * spread_directions(DIRECTIONS)
        room = self.measure_room(centers.reshape(-1, 3)).reshape(centers.shape[:2])
        for rank in range(4):  # the directions with most room
            best = np.argsort(-room, axis=1)[:, rank]
            index = np.arange(len(points))
            free = ~found & (room[index, best] >= CLEAR * self.radius)
            found[free] = self.can_leave(centers[index, best][free])
        return found

    def can_leave(self, centers: Array) -> npt.NDArray[np.bool_]:
        """Tell from which centers the ball leaves the surface along a straight line."""
        left = np.zeros(len(centers), dtype=bool)
        low, high = self.points.min(axis=0) - self.radius, self.points.max(axis=0) + self.radius
        for direction in spread_directions(60):
            todo, at = np.flatnonzero(~left), centers[~left].copy()
            while len(todo):
                gone = ((at < low) | (at > high)).any(axis=1)
                left[todo[gone]] = True
                todo, at = todo[~gone], at[~gone]
                room = self.measure_room(at)
                free = room >= CLEAR * self.radius
                todo, at = todo[free], at[free]
                step = np.maximum(room[free] - CLEAR * self.radius, self.radius / 10)
                at += direction * step[:, None]
        return left


def spread_directions(count: int) -> Array:
    """Return unit vectors on a Fibonacci spiral, shape (count, 3)."""
    index = np.arange(count) + 0.5
    z, turn = 1 - 2 * index / count, np.pi * (1 + 5**0.5) * index
    level = np.sqrt(1 - z * z)
    return np.stack([level * np.cos(turn), level * np.sin(turn), z], axis=1)


def sample(corners: Array, count: int) -> Array:
    """Sample triangles [m], shape (m, 3, 3), at random by area, and at their corners."""
    random = np.random.default_rng(0)
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    owner = random.choice(len(corners), count, p=areas / areas.sum())
    u, v = random.random((2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    inner = a[owner] + u * (b - a)[owner] + v * (c - a)[owner]
    return np.concatenate([inner, np.unique(corners.reshape(-1, 3), axis=0)])


def sample_union(pieces: list[Array], size: float) -> Array:
    """Sample the surface of the union of convex pieces, each given by its triangles."""
    planes = [ConvexHull(np.unique(piece.reshape(-1, 3), axis=0)).equations for piece in pieces]
    points = []
    for index, piece in enumerate(pieces):
        some = sample(piece, max(SAMPLES // len(pieces), 20_000))
        for other, sides in enumerate(planes):
            if other != index and len(some):
                some = some[(some @ sides[:, :3].T + sides[:, 3]).max(axis=1) > -1e-6 * size]
        points.append(some)
    return np.concatenate(points)


def find_largest(points: Array, away: Array, cell: float, *tests: Test) -> float:
    """Return the largest distance of a point that passes all tests; 0 for none."""
    order = np.argsort(-away)
    cells = np.floor(points[order] / cell).astype(np.int64)
    order = order[np.sort(np.unique(cells, axis=0, return_index=True)[1])][: 40 * BATCH]
    count = BATCH
    while len(order):
        some, order = order[:count], order[count:]
        for test in tests:
            some = some[test(points[some])] if len(some) else some
        if len(some):
            return float(away[some].max())
        count *= 2  # most calls are cheap for each point, and costly for each batch
    return 0.0


def measure(path: Path, quality: str) -> str:
    """Return a row for a mesh: pieces, and reach and excess, declared and measured."""
    result = compute(Task(path, settings=Settings.from_quality(quality)))
    mesh = load_mesh(path)
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.faces)]
    size = float(result.measures["size"])
    visual = Dense(sample(corners, SAMPLES), WIDER * BALL * size)
    union = Dense(sample_union([piece.corners for piece in result.pieces], size), visual.radius)
    away, cell = union.tree.query(visual.points)[0], CELL * visual.radius
    reach = find_largest(visual.points, away, cell, visual.find_touched) / size
    away = visual.tree.query(union.points)[0]
    away[away < visual.radius] = 0  # where the ball has no room
    tests = visual.can_leave, union.find_touched
    excess = find_largest(union.points, away, cell, *tests) / size
    pairs = [(float(result.measures["reach"]), reach), (float(result.measures["excess"]), excess)]
    pairs.append((result.error, max(reach, excess)))
    cells = [path.name[-45:], quality, result.method, str(len(result.pieces))]
    cells += [f"{100 * declared:.2f}, {100 * found:.2f}" for declared, found in pairs]
    return f"| {' | '.join(cells)} | {100 * (pairs[-1][1] - pairs[-1][0]):+.2f} |"


def main(arguments: list[str]) -> int:
    """Print a row for each mesh and quality."""
    parser = argparse.ArgumentParser(prog="python -m measure.collision_errors", description=__doc__)
    parser.add_argument("meshes", nargs="+", type=Path)
    parser.add_argument("--quality", action="append", choices=("fast", "balanced", "tight"))
    given = parser.parse_args(arguments)
    for path in given.meshes:
        for quality in given.quality or ["balanced"]:
            print(measure(path, quality), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
