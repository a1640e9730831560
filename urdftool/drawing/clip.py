"""Projection of triangles, clipped at a plane in front of the camera."""

from __future__ import annotations

import numpy as np

from .raster import Floats, Indices

NEAREST = 1e-4
"""Distance of the clipping plane, relative to the farthest corner. Chosen, no source."""


def compute_near_plane(corners: Floats) -> float:
    """Return the distance of the clipping plane for the triangles of a scene."""
    return max(float(-corners[..., 2].min(initial=0.0)) * NEAREST, 1e-300)


def project_triangles(
    corners: Floats, reach: tuple[float, float], size: tuple[int, int], plane: float
) -> tuple[Floats, Indices]:
    """Project triangles for :func:`raster.find_front`, and return the rows they come from.

    Args:
        corners: In the camera's axes, from the eye [m], shape (m, 3, 3); forward is -z.
        reach: Half the width and height of the view at distance 1.
        size: Columns and rows of samples.
        plane: Distance of the clipping plane, where nearness is 1.
    """
    depth = -corners[..., 2]
    ahead = depth > plane
    count = ahead.sum(axis=1)
    whole = np.flatnonzero(count == 3)
    triangles, rows = [corners[whole]], [whole]
    for inside in (1, 2):
        cut = np.flatnonzero(count == inside)
        if not len(cut):
            continue
        # rotated so that the corner alone on its side of the plane is first
        alone = np.argmax(ahead[cut] == (inside == 1), axis=1)
        turned = (alone[:, None] + np.arange(3)) % 3
        a, b, c = (corners[cut, turned[:, k]] for k in range(3))
        ab, ac = _intersect_plane(a, b, plane), _intersect_plane(a, c, plane)
        if inside == 1:
            triangles.append(np.stack([a, ab, ac], axis=1))
            rows.append(cut)
        else:
            triangles += [np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
            rows += [cut, cut]
    flat = np.concatenate(triangles)
    away = np.maximum(-flat[..., 2], plane)
    made = np.empty_like(flat)
    made[..., 0] = (flat[..., 0] / away / reach[0] + 1) * (size[0] / 2)
    made[..., 1] = (1 - flat[..., 1] / away / reach[1]) * (size[1] / 2)
    made[..., 2] = plane / away
    return made, np.concatenate(rows)


def _intersect_plane(one: Floats, other: Floats, plane: float) -> Floats:
    """Intersect the edges between two rows of points with the clipping plane."""
    d0, d1 = -one[:, 2] - plane, -other[:, 2] - plane
    part = d0 / (d0 - d1)
    return np.asarray(one + (other - one) * part[:, None])
