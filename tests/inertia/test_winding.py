"""Winding numbers of closed, open and overlapping surfaces."""

import numpy as np
import pytest
import trimesh

from urdftool.inertia.sampling import compute_sampled_moments, spread_points
from urdftool.inertia.winding import compute_solid_angles, compute_winding_numbers, sort_into_boxes


def corners(mesh):
    return np.asarray(mesh.triangles, dtype=np.float64)


def direct(points, triangles):
    return np.array(
        [
            compute_solid_angles(np.tile(point, (len(triangles), 1)), triangles).sum()
            for point in points
        ]
    ) / (4 * np.pi)


def test_octant():
    far = 1e9
    triangle = np.array([[[far, 0, 0], [0, far, 0], [0, 0, far]]])
    assert compute_solid_angles(np.zeros((1, 3)), triangle)[0] == pytest.approx(np.pi / 2)


@pytest.mark.parametrize("missing", [0, 300])
def test_boxes_agree_with_the_direct_sum(missing):
    triangles = corners(trimesh.creation.torus(1.0, 0.3))[missing:]
    points = spread_points(300, np.full(3, -1.5), np.full(3, 1.5))
    got = compute_winding_numbers(points, sort_into_boxes(triangles))
    np.testing.assert_allclose(got, direct(points, triangles), atol=0.03)


def test_groups_of_boxes_agree_with_the_direct_sum():
    triangles = corners(trimesh.creation.torus(1.0, 0.3, 300, 200))[700:]
    surface = sort_into_boxes(triangles)
    assert surface.groups is not None
    points = spread_points(60, np.full(3, -1.4), np.full(3, 1.4))
    got = compute_winding_numbers(points, surface)
    np.testing.assert_allclose(got, direct(points, triangles), atol=0.03)


def test_inside_outside_and_inside_out():
    triangles = corners(trimesh.creation.icosphere(subdivisions=3))
    points = np.array([[0.0, 0, 0], [0.9, 0, 0], [1.2, 0, 0], [5, 5, 5]])
    np.testing.assert_allclose(
        compute_winding_numbers(points, sort_into_boxes(triangles)), [1, 1, 0, 0], atol=0.02
    )
    turned = compute_winding_numbers(points, sort_into_boxes(triangles[:, ::-1]))
    np.testing.assert_allclose(turned, [-1, -1, 0, 0], atol=0.02)


def test_spread_points_are_spread():
    points = spread_points(4096, np.zeros(3), np.ones(3))
    counts = np.histogramdd(points, bins=4, range=[(0, 1)] * 3)[0]
    assert counts.min() >= 55
    assert counts.max() <= 73


def test_sampled_sphere():
    halves = compute_sampled_moments(corners(trimesh.creation.icosphere(subdivisions=3)), 8000)
    assert halves is not None
    for moments in halves:
        assert moments.measure == pytest.approx(4 / 3 * np.pi, rel=0.02)
        assert np.trace(moments.second) / moments.measure == pytest.approx(3 / 5, rel=0.02)


def test_nothing_inside():
    one = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0.1]]])
    assert compute_sampled_moments(one, 2000, caps=one[:, ::-1]) is None
