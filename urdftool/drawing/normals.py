"""Normals at the corners of triangles: smooth except at sharp edges."""

from __future__ import annotations

import math

import numpy as np

from ..geometry.mesh import Faces, Points
from .raster import Floats, Indices

CREASE = math.cos(math.radians(38.0))
"""Cosine of the angle between two faces above which their common edge is sharp."""

_MANY = 40
"""Faces at a vertex above which only the mean of their normals counts. Chosen, no source."""

_PAIRS_AT_ONCE = 4_000_000
"""Pairs of faces computed at a time, which bounds memory."""


def compute_corner_normals(vertices: Points, faces: Faces) -> Floats:
    """Compute the unit normal at each corner of each face, shape (m, 3, 3).

    It is the mean of the normals of the faces that meet at the point without a sharp edge to this
    face, weighted by their angle there. Coincident vertices count as one. If more than ``_MANY``
    faces meet, as at the hub of a fan, a corner has its face's normal. A face without area has zero
    normals.

    Args:
        vertices: Points [m], shape (n, 3).
        faces: Indices into ``vertices``, shape (m, 3).
    """
    corners = vertices[faces]
    flat, angles = _compute_face_normals(corners)
    smooth = np.repeat(flat[:, None], 3, axis=1).reshape(-1, 3)
    point = _number_positions(vertices)[faces].reshape(-1)
    order = np.argsort(point, kind="stable")
    counts = np.bincount(point)
    counts = counts[counts > 0]
    starts = np.cumsum(counts) - counts
    sound = np.flatnonzero((counts > 1) & (counts <= _MANY))
    weighted = flat[order // 3] * angles.reshape(-1)[order][:, None]
    for size in np.unique(counts[sound]):  # one array per number of faces at a point
        begin = starts[counts == size]
        step = max(1, _PAIRS_AT_ONCE // int(size * size))
        for first in range(0, len(begin), step):
            rows = begin[first : first + step, None] + np.arange(size)
            own = flat[order[rows] // 3]
            near = np.einsum("nik,njk->nij", own, own) > CREASE
            total = np.einsum("nij,njk->nik", near.astype(np.float32), weighted[rows])
            lengths = np.linalg.norm(total, axis=2, keepdims=True)
            mean = np.where(lengths > 1e-12, total / np.where(lengths > 0, lengths, 1), own)
            smooth[order[rows].reshape(-1)] = mean.reshape(-1, 3)
    return smooth.reshape(-1, 3, 3)


def _compute_face_normals(corners: Points) -> tuple[Floats, Floats]:
    """Compute the unit normals of faces and the angles at their corners [rad]."""
    sides = np.roll(corners, -1, axis=1) - corners
    largest = np.abs(sides).max(axis=(1, 2), initial=0.0)
    sides = sides / np.where(largest > 0, largest, 1.0)[:, None, None]
    normals = np.cross(sides[:, 0], sides[:, 1])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = normals / np.where(lengths > 0, lengths, 1.0)
    long = np.linalg.norm(sides, axis=2)
    units = sides / np.where(long > 0, long, 1.0)[..., None]
    cosines = -np.einsum("mij,mij->mi", units, np.roll(units, 1, axis=1))
    return normals, np.arccos(np.clip(cosines, -1, 1))


def _number_positions(vertices: Points) -> Indices:
    """Number the distinct positions of vertices, by a hash of their coordinates' bits."""
    bits = np.ascontiguousarray(vertices + 0.0).view(np.uint64)  # avoids negative zeros
    mixed = np.zeros(len(bits), dtype=np.uint64)
    for axis in range(3):
        mixed = (mixed ^ bits[:, axis]) * np.uint64(0x9E3779B97F4A7C15)
        mixed ^= mixed >> np.uint64(29)
    _, inverse = np.unique(mixed, return_inverse=True)
    return np.asarray(inverse.reshape(-1), dtype=np.int64)
