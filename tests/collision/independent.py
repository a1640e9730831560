"""Reach and excess of a collision by code that shares nothing with ``urdftool.collision``.

Points are random, the flood is a frontier of grid nodes on another grid, the distances are those to
the nearest of many points, and the inside of a convex piece is that of scipy's planes.
"""

import numpy as np
from scipy.spatial import ConvexHull, cKDTree

BALL = 0.015
STEP = 0.006
POINTS = 200_000
ASKED = 30_000


def sampled(corners, count, seed):
    """Random points on triangles, and their vertices."""
    random = np.random.default_rng(seed)
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    chosen = random.choice(len(corners), count, p=areas / areas.sum())
    u, v = random.random((2, count, 1))
    root = np.sqrt(u)
    inner = (1 - root) * a[chosen] + root * (1 - v) * b[chosen] + root * v * c[chosen]
    return inner, corners.reshape(-1, 3)


def flooded(points, size):
    """Nodes next to the border of the region that the center of the ball reaches, and that region.

    Returns the tree of the reached nodes that are near to the points, and a function that tells
    whether points are covered by a ball.
    """
    step, radius = STEP * size, BALL * size
    low = points.min(axis=0) - radius - 4 * step
    shape = tuple(np.ceil((points.max(axis=0) + radius + 4 * step - low) / step).astype(int))
    cells = np.unique(np.rint((points - low) / step).astype(int), axis=0)
    reach = int(np.ceil(radius / step)) + 1
    span = np.arange(-reach, reach + 1)
    offsets = np.stack(np.meshgrid(span, span, span), axis=-1).reshape(-1, 3)
    far = np.linalg.norm(offsets, axis=1)
    sure = offsets[far <= radius / step - 0.9]
    unsure = offsets[(far > radius / step - 0.9) & (far < radius / step + 0.9)]
    blocked = np.zeros(shape, dtype=bool)
    asked = np.zeros(shape, dtype=bool)
    for some, grid in ((sure, blocked), (unsure, asked)):
        for offset in some:
            grid[tuple(np.clip(cells + offset, 0, np.array(shape) - 1).T)] = True
    nodes = np.argwhere(asked & ~blocked)
    tree = cKDTree(points)
    off, _ = tree.query(nodes * step + low)
    blocked[tuple(nodes[off < radius].T)] = True
    reached = np.zeros(shape, dtype=bool)
    frontier = np.zeros((1, 3), dtype=int)
    reached[0, 0, 0] = True
    sides = np.concatenate([np.eye(3, dtype=int), -np.eye(3, dtype=int)])
    while len(frontier):
        ahead = (frontier[:, None] + sides).reshape(-1, 3)
        ahead = ahead[((ahead >= 0) & (ahead < shape)).all(axis=1)]
        at = tuple(ahead.T)
        ahead = ahead[~reached[at] & ~blocked[at]]
        ahead = np.unique(ahead, axis=0)
        reached[tuple(ahead.T)] = True
        frontier = ahead
    border = np.zeros(shape, dtype=bool)
    for axis in range(3):
        for shift in (1, -1):
            border |= np.roll(~reached, shift, axis)
    near = np.argwhere(reached & border) * step + low
    balls = cKDTree(near)
    return balls, reached, low, step, radius


def touchable(points, balls, step, radius):
    off, _ = balls.query(points, distance_upper_bound=radius + step)
    return np.isfinite(off)


def inside_any(points, pieces):
    found = np.zeros(len(points), dtype=bool)
    for piece in pieces:
        hull = ConvexHull(piece.vertices)
        low, high = piece.vertices.min(axis=0), piece.vertices.max(axis=0)
        near = np.flatnonzero(((points > low) & (points < high)).all(axis=1) & ~found)
        for begin in range(0, len(near), 2000):
            some = near[begin : begin + 2000]
            height = points[some] @ hull.equations[:, :3].T + hull.equations[:, 3]
            found[some] = height.max(axis=1) < 0
    return found


def reach_and_excess(corners, pieces, size, points=POINTS):
    """Both, relative to the size, of convex pieces as the collision of triangles."""
    inner, ends = sampled(corners, points, 1)
    balls, reached, low, step, radius = flooded(np.concatenate([inner, ends]), size)
    asked = np.concatenate([inner[:ASKED], ends[:: max(1, len(ends) // ASKED)]])
    asked = asked[touchable(asked, balls, step, radius)]
    visual = inner[touchable(inner, balls, step, radius)]
    triangles = np.concatenate([piece.vertices[piece.faces] for piece in pieces])
    points = np.concatenate(sampled(triangles, points, 2))
    around = flooded(points, size)
    seen = points[touchable(points, around[0], *around[3:])]
    inside = inside_any(asked, pieces)
    reach = max(
        float(cKDTree(seen).query(asked[inside])[0].max(initial=0)),
        float(cKDTree(points).query(asked[~inside])[0].max(initial=0)),
    )
    # outside the closing: covered by a ball whose center is reached
    off, _ = balls.query(seen)
    at = tuple(np.clip(np.rint((seen - low) / step).astype(int), 0, np.array(reached.shape) - 1).T)
    protruding = seen[(off < radius) | reached[at]]
    excess = float(cKDTree(visual).query(protruding)[0].max(initial=0))
    return reach / size, excess / size
