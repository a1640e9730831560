"""A closed surface of few triangles around what a ball can touch of a mesh.

The boundary of the closing (``exterior``) is extracted by surface nets (Gibson, "Constrained
Elastic Surface Nets", 1998): a vertex in each cell with a change of sign, a quadrilateral for each
grid edge. It lies slightly outside, so that sheets without thickness remain; its vertices are moved
to the mesh after decimation.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..geometry.mesh import Faces, Points
from .decimate import decimate
from .exterior import Exterior
from .measure import ReferenceSurface

TRIANGLES = 2000
"""Largest number of triangles of the outline. Chosen, no source."""

# chosen, no source, where a line gives none
_LEVEL = -0.6  # cells outside the closing
_NEAR = 2.0  # cells from the mesh within which a vertex is moved to it
_KEPT = 0.2  # part of that distance that remains, so that a sheet has two sides


def compute_outline(target: ReferenceSurface) -> tuple[Points, Faces]:
    """Compute the outer surface of a mesh, with few triangles.

    Returns:
        Vertices [m] and triangles, wound outward.
    """
    exterior = target.exterior
    vertices, faces = extract_surface(exterior.depth - np.float32(_LEVEL * exterior.step))
    vertices = exterior.low + vertices * exterior.step
    vertices, faces = decimate(vertices, faces, TRIANGLES)
    return _move_to_mesh(vertices, target, exterior), faces


def _move_to_mesh(vertices: Points, target: ReferenceSurface, exterior: Exterior) -> Points:
    tree = target.nearest.tree
    off, nearest = tree.query(vertices, workers=target.cores)
    feet = target.nearest.samples.points[nearest]
    share = np.where(off < _NEAR * exterior.step, _KEPT, 1.0)[:, None]
    return np.asarray(feet + (vertices - feet) * share)


def extract_surface(field: npt.NDArray[np.float32]) -> tuple[Points, Faces]:
    """Extract the boundary of the positive region of a field.

    Args:
        field: Values at grid nodes; negative on the border of the grid.

    Returns:
        Vertices, in cells, and triangles, wound outward.
    """
    solid = field > 0
    shape = np.array(field.shape)
    strides = np.array([shape[1] * shape[2], shape[2], 1])
    cells: list[npt.NDArray[np.int64]] = []
    points: list[Points] = []
    quads = []
    for axis in range(3):
        first = np.moveaxis(solid, axis, 0)[:-1]
        second = np.moveaxis(solid, axis, 0)[1:]
        order = [axis, *(k for k in range(3) if k != axis)]
        nodes = np.argwhere(first != second)[:, np.argsort(order)]
        ahead = nodes.copy()
        ahead[:, axis] += 1
        a, b = field[tuple(nodes.T)], field[tuple(ahead.T)]
        crossing = nodes.astype(np.float64)
        crossing[:, axis] += a / (a - b)
        u, v = strides[(axis + 1) % 3], strides[(axis + 2) % 3]
        ring = (nodes @ strides)[:, None] - np.array([0, u, u + v, v])
        cells.append(ring.reshape(-1))
        points.append(np.repeat(crossing, 4, axis=0))
        quads.append(np.where((a > 0)[:, None], ring, ring[:, ::-1]))
    used, owner = np.unique(np.concatenate(cells), return_inverse=True)
    every = np.concatenate(points)
    count = np.bincount(owner)
    vertices = np.stack([np.bincount(owner, every[:, k]) / count for k in range(3)], axis=1)
    corners = np.searchsorted(used, np.concatenate(quads))
    faces = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
    return vertices, faces.astype(np.int64)
