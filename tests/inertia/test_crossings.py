"""Rays straight up count as solid angles do, wherever a surface has no border."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from urdftool.inertia.crossings import compute_crossing_numbers
from urdftool.inertia.repair import fill_holes
from urdftool.inertia.sampling import (
    compute_sampled_moments,
    compute_winding_with_caps,
    spread_points,
)
from urdftool.inertia.winding import compute_winding_numbers, sort_into_boxes

SHAPES = {
    "box": trimesh.creation.box((1, 2, 0.5)),
    "ball": trimesh.creation.icosphere(subdivisions=3),
    "ring": trimesh.creation.torus(1.0, 0.3),
    "rod": trimesh.creation.cylinder(0.02, 3.0, sections=200),
}


def corners(name):
    return np.array(SHAPES[name].triangles)


def turned(triangles, seed):
    return (
        triangles
        @ trimesh.transformations.random_rotation_matrix(np.random.default_rng(seed).random(3))[
            :3, :3
        ]
    )


@given(st.sampled_from(sorted(SHAPES)), st.sampled_from(sorted(SHAPES)), st.integers(0, 1000))
@settings(max_examples=40, deadline=None)
def test_bodies_that_overlap_count_as_often_as_they_do(first, second, seed):
    shift = np.random.default_rng(seed).uniform(-0.5, 0.5, 3)
    both = np.concatenate([turned(corners(first), seed), turned(corners(second), seed + 1) + shift])
    low, high = both.reshape(-1, 3).min(axis=0) - 0.1, both.reshape(-1, 3).max(axis=0) + 0.1
    points = spread_points(500, low, high)
    np.testing.assert_array_equal(
        compute_crossing_numbers(points, both),
        np.rint(compute_winding_numbers(points, sort_into_boxes(both))),
    )


@pytest.mark.parametrize("name", SHAPES)
def test_inside_out_is_below_zero(name):
    solid = turned(corners(name), 3)
    points = spread_points(2000, solid.reshape(-1, 3).min(axis=0), solid.reshape(-1, 3).max(axis=0))
    numbers = compute_crossing_numbers(points, solid)
    assert set(numbers) == {0, 1}
    np.testing.assert_array_equal(compute_crossing_numbers(points, solid[:, ::-1]), -numbers)


def test_points_that_all_have_one_place_or_one_height():
    solid = corners("ball")
    assert list(compute_crossing_numbers(np.array([[0.01, 0.02, 0.03]]), solid)) == [1]
    line = np.array([[x, 0.013, 0.017] for x in (-1.5, -0.5, 0.3, 1.5)])
    assert list(compute_crossing_numbers(line, solid)) == [0, 1, 1, 0]


def test_an_open_surface_is_a_closed_one_less_its_caps():
    ball = corners("ball")
    middles = ball.mean(axis=1)
    for hole in (middles[:, 2] > 0.8, middles[:, 0] > 0.2):
        left = ball[~hole]
        mesh = trimesh.Trimesh(*trimesh.triangles.to_kwargs(left).values())
        filling = fill_holes(np.array(mesh.vertices), np.array(mesh.faces))
        caps = filling.vertices[filling.faces[len(left) :]]
        assert 3 < len(caps) < len(left)
        points = spread_points(3000, np.full(3, -1.2), np.full(3, 1.2))
        np.testing.assert_allclose(
            compute_winding_with_caps(points, np.array(mesh.triangles), caps),
            compute_winding_numbers(points, sort_into_boxes(left)),
            atol=0.03,
        )


def test_more_caps_than_triangles_are_not_counted_by_caps():
    some = corners("ball")[::2]
    points = spread_points(500, np.full(3, -1.2), np.full(3, 1.2))
    nonsense = np.zeros((len(some) + 1, 3, 3))
    np.testing.assert_array_equal(
        compute_winding_with_caps(points, some, nonsense),
        compute_winding_numbers(points, sort_into_boxes(some)),
    )


def test_moments_are_those_of_solid_angles():
    ball = corners("ball")
    two = np.concatenate([ball, ball + np.array([0.7, 0.2, 0.1])])
    halves = compute_sampled_moments(two, 8000)
    for start, one in zip((0, 4000), halves, strict=True):
        low, high = two.reshape(-1, 3).min(axis=0), two.reshape(-1, 3).max(axis=0)
        points = spread_points(4000, low, high, start=start)
        inside = points[compute_winding_numbers(points, sort_into_boxes(two)) > 0.5]
        assert one.measure == pytest.approx(np.prod(high - low) * len(inside) / 4000, rel=2e-3)
        np.testing.assert_allclose(one.centroid, inside.mean(axis=0), atol=5e-3)
