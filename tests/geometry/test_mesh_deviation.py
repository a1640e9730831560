"""Distance of two meshes by points of each."""

import numpy as np
import pytest

pytest.importorskip("trimesh")

from urdftool.geometry.mesh_deviation import measure_deviation


def test_a_triangle_without_area_moves_no_point():
    """A mesh with lines between its triangles is the mesh without them, in another order."""
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.2]])
    whole = corners[[[0, 1, 2], [1, 3, 2]]]
    middle = (corners[1] + corners[2]) / 2
    lines = np.array([[corners[1], corners[2], middle], [middle, middle, middle]])
    longer = np.concatenate([lines, whole[::-1]])
    assert measure_deviation(whole, longer, 1e-9) < 1e-12
    assert measure_deviation(longer, whole, 1e-9) < 1e-12
    moved = longer + np.array([0, 0, 0.01])
    assert measure_deviation(whole, moved, 1e-9) == pytest.approx(0.01, rel=0.1)


def test_small_triangles_in_another_order_are_one_mesh():
    """A sphere of 5 mm: trimesh finds other closest points on triangles of less than 0.7 mm."""
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.005).triangles
    assert np.linalg.norm(ball[:, 1] - ball[:, 0], axis=1).max() < 1e-3
    other = np.concatenate([ball[::-1], ball[:1, [0, 0, 1]]]) * (1 + 1e-12)
    assert measure_deviation(ball, other, 1e-9) < 1e-9
