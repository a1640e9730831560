"""Exact mass properties of a closed triangle mesh, and of a thin shell along a mesh.

The solid is the signed sum of the tetrahedra between each triangle and one point. Over one of them
(volume d/6, d the triple product of a, b, c) the integrals are polynomials of its corners:

    ∫ x dV = d/24 · s,   ∫ x xᵀ dV = d/120 · (a aᵀ + b bᵀ + c cᵀ + s sᵀ),   s = a + b + c

(Tonon, "Explicit Exact Formulas for the 3-D Tetrahedron Inertia Tensor in Terms of its Vertex
Coordinates", 2004; the same integrals by the divergence theorem: Mirtich, "Fast and Accurate
Computation of Polyhedral Mass Properties", 1996, and Eberly, "Polyhedral Mass Properties
(Revisited)", 2002). For a triangle of area A, ∫ x xᵀ dA = A/12 · (a aᵀ + b bᵀ + c cᵀ + s sᵀ).

Second moments are taken about the centroid, which a first pass computes, because integrals about a
distant origin lose digits to cancellation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..errors import MeshError
from ..geometry.mesh import Array
from ..mechanics.spatial_inertia import SpatialInertia
from ..mechanics.tensor import compute_inertia_from_second_moment, from_matrix

Faces = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Moments:
    """Integrals over a solid or a surface, at unit density."""

    measure: float
    """Signed volume [m³] of a solid, area [m²] of a shell."""
    centroid: Array
    """Centroid [m], shape (3,)."""
    second: Array
    """∫ x xᵀ about the centroid, shape (3, 3), [m⁵] of a solid, [m⁴] of a shell."""

    def with_density(self, density: float) -> SpatialInertia:
        """Return the body with a density, [kg/m³] of a solid, [kg/m²] of a shell."""
        x, y, z = self.centroid.tolist()
        second = from_matrix(density * self.second)
        return SpatialInertia(
            density * self.measure, (x, y, z), compute_inertia_from_second_moment(second)
        )

    def with_mass(self, mass: float) -> SpatialInertia:
        """Return the body with a mass [kg]."""
        return self.with_density(mass / self.measure)


def compute_signed_volume(vertices: Array, faces: Faces) -> float:
    """Compute the volume [m³] that a closed mesh encloses; negative if its faces point inward."""
    corners = (vertices - _compute_center(vertices))[faces]
    return float(_compute_triple_product(corners).sum() / 6)


def compute_solid_moments(vertices: Array, faces: Faces) -> Moments:
    """Compute the integrals over the inside of a closed, consistently wound mesh.

    Closedness is not checked; use ``estimate`` for meshes of unknown quality.

    Args:
        vertices: Points [m], shape (n, 3).
        faces: Indices into ``vertices``, shape (m, 3), counter-clockwise from outside.

    Raises:
        MeshError: The mesh encloses no volume.
    """
    middle = _compute_center(vertices)
    corners = (vertices - middle)[faces]
    triple = _compute_triple_product(corners)
    volume = float(triple.sum()) / 6
    extent = float(np.ptp(vertices, axis=0).max()) if len(vertices) else 0.0
    if abs(volume) <= 1e-12 * extent**3:
        raise MeshError(
            "the mesh encloses no volume; a solid requires a closed surface, "
            "a plate or sheet a shell"
        )
    centroid = triple @ corners.sum(axis=1) / (24 * volume)
    corners -= centroid
    triple = _compute_triple_product(corners)
    second = _sum_corner_products(corners, triple) / 120
    rest = triple @ corners.sum(axis=1) / 24
    volume = float(triple.sum()) / 6
    # removes the rounding error of the centroid from the first pass
    centroid_error = rest / volume
    second -= volume * np.outer(centroid_error, centroid_error)
    return Moments(volume, middle + centroid + centroid_error, second)


def compute_shell_moments(vertices: Array, faces: Faces) -> Moments:
    """Compute the integrals over the surface of a mesh, open or closed, with any winding.

    Args:
        vertices: Points [m], shape (n, 3).
        faces: Indices into ``vertices``, shape (m, 3).

    Raises:
        MeshError: The mesh has no area.
    """
    middle = _compute_center(vertices)
    corners = (vertices - middle)[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1) / 2
    area = float(areas.sum())
    if not area > 0:
        raise MeshError("the mesh has no area; at least one triangle must have an area")
    centroid = areas @ corners.sum(axis=1) / (3 * area)
    corners -= centroid
    return Moments(area, middle + centroid, _sum_corner_products(corners, areas) / 12)


def _compute_center(vertices: Array) -> Array:
    if not len(vertices):
        return np.zeros(3)
    middle: Array = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    return middle


def _compute_triple_product(corners: Array) -> Array:
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    # np.cross takes three times as long, as it moves axes
    return np.asarray(
        a[:, 0] * (b[:, 1] * c[:, 2] - b[:, 2] * c[:, 1])
        + a[:, 1] * (b[:, 2] * c[:, 0] - b[:, 0] * c[:, 2])
        + a[:, 2] * (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])
    )


def _sum_corner_products(corners: Array, weights: Array) -> Array:
    """Sum w (a aᵀ + b bᵀ + c cᵀ + s sᵀ) over all triangles."""
    total: Array = np.zeros((3, 3))
    for points in (corners[:, 0], corners[:, 1], corners[:, 2], corners.sum(axis=1)):
        total += (points * weights[:, None]).T @ points
    return total
