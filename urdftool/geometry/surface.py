"""Surface of a mesh file: closedness, winding, slivers, hull volume, effect of holes.

This module avoids scipy, which takes longer to import than a mesh takes to read.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..errors import MeshError
from .convex_points import select_extreme_points
from .hull import compute_convex_hull
from .load import load_mesh
from .mesh import Faces, Points
from .topology import weld_on_grids

LARGEST = 32_000_000
"""Size of the largest file whose surface is read [bytes]. Chosen, no source."""


class Surface(NamedTuple):
    """Properties of the surface of a mesh.

    Attributes:
        faces: Number of triangles.
        open_edges: Number of edges with an odd number of triangles; 0 for a closed surface.
        flat: Number of triangles without area.
        consistent: Whether adjacent triangles have the same winding.
        volume: Signed volume in the file's unit cubed; meaningless for an open surface.
        thickness: Largest distance of a point from a plane through three of them, relative to the
            size; 0 for a mesh in a plane.
    """

    faces: int
    open_edges: int
    flat: int
    consistent: bool
    volume: float
    thickness: float

    @property
    def inside_out(self) -> bool:
        """Tell whether a closed surface faces inward."""
        return not self.open_edges and self.consistent and self.volume < 0


def read_surface(path: str | Path) -> Surface | None:
    """Measure the surface of a mesh file; None if it cannot be read or is larger than LARGEST."""
    file = Path(path)
    try:
        if file.stat().st_size > LARGEST:
            return None
        mesh = load_mesh(file)
    except (MeshError, OSError):
        return None
    return measure_surface(mesh.vertices, mesh.faces)


def measure_surface(vertices: Points, faces: Faces) -> Surface:
    """Measure the surface of triangles.

    Args:
        vertices: Points, shape (n, 3); equal and nearly equal points are merged.
        faces: Indices into ``vertices``, shape (m, 3).
    """
    points, merged, edges = weld_on_grids(vertices, faces)
    corners = points[merged]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    extent = float(np.ptp(vertices[faces].reshape(-1, 3), axis=0).max())
    sliver = np.linalg.norm(normals, axis=1) <= 1e-12 * extent**2
    centered = corners - points.mean(axis=0)
    volume = np.einsum("ij,ij->", centered[:, 0], np.cross(centered[:, 1], centered[:, 2])) / 6
    if abs(volume) <= 1e-9 * extent**3:
        volume = 0.0  # two sides of one sheet
    thickness = _compute_thickness(vertices[np.unique(faces)])
    flat = int(sliver.sum())
    return Surface(len(merged), edges.open_count, flat, edges.cycle, float(volume), thickness)


def _compute_thickness(points: Points) -> float:
    """Compute the distance of points, shape (n, 3), from a plane, relative to their size."""
    arms = points - points[0]
    lengths = np.linalg.norm(arms, axis=1)
    size = float(lengths.max())
    if not size > 0:
        return 0.0
    crosses = np.cross(arms[lengths.argmax()], arms)
    areas = np.linalg.norm(crosses, axis=1)
    widest = int(areas.argmax())
    if not areas[widest] > 0:
        return 0.0
    normal = crosses[widest] / areas[widest]
    return float(np.abs(arms @ normal).max()) / size


def compute_hull_volume(path: str | Path) -> float | None:
    """Compute the volume of a mesh file's convex hull in its unit cubed.

    Returns:
        None if the mesh is flat or cannot be read.
    """
    try:
        hull = compute_convex_hull(select_extreme_points(load_mesh(path).vertices))
    except (MeshError, OSError, ValueError):
        return None
    return None if hull is None else float(hull.volume())


def change_by_closing(path: str | Path) -> float | None:
    """Compute how much the mass properties of a mesh in MuJoCo change if its holes are closed.

    Each hole is closed by a fan from its center.

    Returns:
        The largest relative change of the volume, the center of mass (relative to the mesh's
        extent) and the second moments; infinite if the closed mesh has no volume, None if the file
        cannot be read or has no area.
    """
    try:
        mesh = load_mesh(Path(path))
    except (MeshError, OSError):
        return None
    points, faces, _ = weld_on_grids(mesh.vertices, mesh.faces)
    corners = points[faces]
    if not _compute_areas(corners).sum() > 0:
        return None
    extent = float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    here = _compute_mass_properties(corners)
    there = _compute_mass_properties(np.concatenate([corners, _make_fans(points, faces)]))
    if not there[0] > 1e-9 * extent**3 or not here[0]:
        return float("inf")
    volume = abs(here[0] / there[0] - 1)
    center = float(np.linalg.norm(here[1] - there[1])) / extent
    spreads = here[2] / here[0], there[2] / there[0]
    spread = float(np.abs(spreads[0] - spreads[1]).max() / np.abs(spreads[1]).max())
    return float(max(volume, center, spread))


def _compute_areas(corners: Points) -> Points:
    """Compute twice the area of each triangle."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas: Points = np.linalg.norm(normals, axis=1)
    return areas


def _compute_mass_properties(corners: Points) -> tuple[float, Points, Points]:
    """Compute volume, center and second moments about it as MuJoCo does for meshes of a URDF.

    With ``inertia="legacy"``, the default, MuJoCo adds volumes of tetrahedra without their signs:
    for the center with the apex at the mean of the surface, then with the apex at that center. For
    an open mesh of 796 triangles the mass is that of MuJoCo 4.0 to 15 digits.
    """
    apex = np.average(corners.mean(axis=1), axis=0, weights=_compute_areas(corners))
    sums = _sum_moments(corners - apex)
    center = apex + sums[1:4] / sums[0] if sums[0] else apex
    sums = _sum_moments(corners - center)
    return float(sums[0]), center, sums[4:]


def _sum_moments(corners: Points) -> Points:
    """Sum volume, first and second moments over the tetrahedra from the origin to triangles.

    Volumes are added without their signs.
    """
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    six = np.abs(np.einsum("ij,ij->i", a, np.cross(b, c)))
    total = a + b + c
    first = (six[:, None] * total).sum(axis=0) / 24
    squares = (a * a + b * b + c * c + total * total) * six[:, None]
    return np.concatenate([[six.sum() / 6], first, squares.sum(axis=0) / 120])


def _make_fans(points: Points, faces: Faces) -> Points:
    """Create the triangles that close each hole, from the center of its rim to its edges."""
    starts, ends = faces.reshape(-1), np.roll(faces, -1, axis=1).reshape(-1)
    both = np.sort(np.stack([starts, ends], axis=1), axis=1)
    edges, which = np.unique(both, axis=0, return_inverse=True)
    net = np.bincount(which.reshape(-1), weights=np.where(starts == both[:, 0], 1, -1))
    rim = (net != 0) & (edges[:, 0] != edges[:, 1])
    edges, net = edges[rim], net[rim].astype(int)
    labels = _label_rims(len(points), edges)
    on_rim = np.unique(edges)
    count = np.bincount(labels[on_rim], minlength=len(points))
    middles = (
        np.stack(
            [np.bincount(labels[on_rim], points[on_rim, axis], len(points)) for axis in range(3)],
            axis=1,
        )
        / np.maximum(count, 1)[:, None]
    )
    turned = np.where((net > 0)[:, None], edges[:, ::-1], edges)
    fans = np.stack([*points[turned].swapaxes(0, 1), middles[labels[edges[:, 0]]]], axis=1)
    return np.repeat(fans, np.abs(net), axis=0)


def _label_rims(count: int, edges: Faces) -> Faces:
    """Label each point with the smallest index of its connected component."""
    labels = np.arange(count)
    while True:
        least = labels[edges].min(axis=1)
        new = labels.copy()
        for column in (edges[:, 0], edges[:, 1]):
            np.minimum.at(new, column, least)
        new = new[new]
        if (new == labels).all():
            return labels
        labels = new
