"""Triangles of primitives: boxes, cylinders, spheres and capsules."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .mesh import Faces, Points

AROUND = 96
"""Corners of a circle; its chords deviate by at most 0.05 % of the radius. Chosen, no source."""


def tessellate(kind: str, size: Sequence[float], around: int = AROUND) -> tuple[Points, Faces]:
    """Create the closed surface of a primitive about its origin, wound outward.

    Args:
        kind: ``"box"``, ``"cylinder"``, ``"capsule"``, ``"sphere"``, ``"ellipsoid"`` or ``"cone"``.
        size: Lengths [m]: three edges of a box; radius and length of a cylinder, cone or capsule
            (length between the caps); radius of a sphere; three half axes of an ellipsoid.
        around: Corners of a circle, an even number.

    Returns:
        Vertices [m], shape (n, 3), and faces, shape (m, 3).
    """
    if kind == "box":
        return _tessellate_box(size)
    if kind == "ellipsoid":
        vertices, faces = tessellate("sphere", (1.0,), around)
        return vertices * np.asarray(size), faces
    return _revolve(_compute_profile(kind, size, around), around)


def _tessellate_box(size: Sequence[float]) -> tuple[Points, Faces]:
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    return signs * np.asarray(size) / 2, np.array(faces, dtype=np.int64)


def _compute_profile(kind: str, size: Sequence[float], around: int) -> Points:
    """Return radius and height of each ring from bottom to top; the first and last are points."""
    radius = size[0]
    if kind == "cylinder":
        half = size[1] / 2
        return np.array([[0, -half], [radius, -half], [radius, half], [0, half]])
    if kind == "cone":
        half = size[1] / 2
        return np.array([[0, -half], [radius, -half], [0, half]])
    half = size[1] / 2 if kind == "capsule" else 0.0
    angles = np.linspace(-np.pi / 2, np.pi / 2, around // 2 + 1)
    rings = np.stack([radius * np.cos(angles), radius * np.sin(angles)], axis=1)
    rings[[0, -1], 0] = 0.0
    if not half:
        return rings
    middle = len(rings) // 2
    lift = np.array([0.0, half])
    return np.concatenate([rings[: middle + 1] - lift, rings[middle:] + lift])


def _revolve(profile: Points, around: int) -> tuple[Points, Faces]:
    """Create the surface of revolution of a profile about z."""
    angles = 2 * np.pi * np.arange(around) / around
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    inner = profile[1:-1]
    rings = np.concatenate(
        [
            np.concatenate([radius * circle, np.full((around, 1), height)], axis=1)
            for radius, height in inner
        ]
    )
    ends = np.array([[0, 0, profile[0, 1]], [0, 0, profile[-1, 1]]])
    here = np.arange(around)
    after = (here + 1) % around
    faces = []
    for ring in range(len(inner) - 1):
        low, high = ring * around, (ring + 1) * around
        faces.append(np.stack([low + here, low + after, high + after], axis=1))
        faces.append(np.stack([low + here, high + after, high + here], axis=1))
    bottom, top = len(rings), len(rings) + 1
    last = (len(inner) - 1) * around
    faces.append(np.stack([after, here, np.full(around, bottom)], axis=1))
    faces.append(np.stack([last + here, last + after, np.full(around, top)], axis=1))
    return np.concatenate([rings, ends]), np.concatenate(faces).astype(np.int64)
