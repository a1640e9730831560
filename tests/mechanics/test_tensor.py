"""Shift, rotate, combine and judge, against sums over many points."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mechanics.bodies import move
from urdftool.inertia import requirements
from urdftool.inertia.inertia_error import InertiaError
from urdftool.inertia.solids import box, cylinder
from urdftool.mechanics import tensor as t
from urdftool.mechanics.spatial_inertia import SpatialInertia, combine
from urdftool.model.pose import rotation_from_rpy

coordinates = st.floats(-10, 10)
vectors = st.tuples(coordinates, coordinates, coordinates)
angles = st.floats(-math.pi, math.pi)
turns = st.tuples(angles, angles, angles)


def summed(points, weights, about):
    """Σ w (|d|² E − d dᵀ), written out component by component."""
    d = points - about
    x, y, z = d.T
    return np.array(
        [
            [(weights * (y * y + z * z)).sum(), -(weights * x * y).sum(), -(weights * x * z).sum()],
            [-(weights * x * y).sum(), (weights * (x * x + z * z)).sum(), -(weights * y * z).sum()],
            [-(weights * x * z).sum(), -(weights * y * z).sum(), (weights * (x * x + y * y)).sum()],
        ]
    )


def gauss_box(size):
    """Gauss–Legendre points of a box of mass 1: exact for polynomials up to degree 5."""
    nodes, weights = np.polynomial.legendre.leggauss(3)
    grid = np.stack(np.meshgrid(nodes, nodes, nodes, indexing="ij"), axis=-1).reshape(-1, 3)
    shares = np.stack(np.meshgrid(weights, weights, weights, indexing="ij"), axis=-1)
    return grid * np.array(size) / 2, shares.reshape(-1, 3).prod(axis=1) / 8


@given(vectors, turns)
def test_move_equals_numerical_integration(xyz, rpy):
    points, weights = gauss_box((1.0, 2.0, 0.5))
    moved = move(box((1.0, 2.0, 0.5), mass=1.0), xyz=xyz, rpy=rpy)
    turned = points @ np.array(rotation_from_rpy(rpy)).T + np.array(xyz)
    np.testing.assert_allclose(moved.com, weights @ turned, atol=1e-12)
    np.testing.assert_allclose(moved.inertia, summed(turned, weights, moved.com), atol=1e-12)
    np.testing.assert_allclose(
        t.to_matrix(moved.about_origin), summed(turned, weights, np.zeros(3)), atol=1e-9
    )
    back = t.shift_to_com(moved.about_origin, 1.0, moved.com)
    np.testing.assert_allclose(back, moved.tensor, atol=1e-9)


@given(turns)
def test_rpy_is_about_fixed_x_y_z(rpy):
    roll, pitch, yaw = rpy

    def turn(axis, angle):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        matrix = np.eye(3)
        matrix[i, i] = matrix[j, j] = math.cos(angle)
        matrix[i, j], matrix[j, i] = -math.sin(angle), math.sin(angle)
        return matrix

    wanted = turn(2, yaw) @ turn(1, pitch) @ turn(0, roll)
    np.testing.assert_allclose(rotation_from_rpy(rpy), wanted, atol=1e-15)


@given(vectors, turns, vectors, turns, st.floats(0.1, 10), st.floats(0.1, 10))
def test_combine_equals_numerical_integration(xyz1, rpy1, xyz2, rpy2, m1, m2):
    bodies, points, weights = [], [], []
    for size, mass, xyz, rpy in (((1, 2, 3), m1, xyz1, rpy1), ((3, 0.1, 1), m2, xyz2, rpy2)):
        bodies.append(move(box(size, mass=mass), xyz=xyz, rpy=rpy))
        own, share = gauss_box(size)
        points.append(own @ np.array(rotation_from_rpy(rpy)).T + np.array(xyz))
        weights.append(share * mass)
    whole = combine(bodies)
    everything, shares = np.concatenate(points), np.concatenate(weights)
    assert whole.mass == pytest.approx(m1 + m2)
    np.testing.assert_allclose(whole.com, shares @ everything / shares.sum(), atol=1e-9)
    np.testing.assert_allclose(whole.inertia, summed(everything, shares, whole.com), atol=1e-8)
    assert requirements.is_consistent(whole)


def test_two_halves_make_the_whole():
    half = cylinder(0.1, 0.2, mass=1.0)
    both = combine([move(half, xyz=(0, 0, 0.1)), move(half, xyz=(0, 0, -0.1))])
    np.testing.assert_allclose(both.inertia, cylinder(0.1, 0.4, mass=2.0).inertia, atol=1e-15)


def test_combine_nothing():
    with pytest.raises(InertiaError, match="requires mass"):
        requirements.combine([])


@given(turns)
def test_principal_axes_are_found_again(rpy):
    body = box((1, 2, 3), mass=12.0)
    rotation = rotation_from_rpy(rpy)
    moments, axes = t.compute_principal_axes(t.rotate_tensor(body.tensor, rotation))
    np.testing.assert_allclose(moments, [5, 10, 13], rtol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1)
    np.testing.assert_allclose(
        axes @ np.diag(moments) @ axes.T,
        t.to_matrix(t.rotate_tensor(body.tensor, rotation)),
        atol=1e-12,
    )


def test_second_moment_and_back():
    body = box((1, 2, 3), mass=12.0)
    assert t.compute_second_moment(body.tensor) == pytest.approx(
        t.make_diagonal_tensor(1, 4, 9), abs=1e-14
    )
    back = t.compute_inertia_from_second_moment(t.compute_second_moment(body.tensor))
    assert back == pytest.approx(body.tensor, abs=1e-14)


@pytest.mark.parametrize(
    ("moments", "possible"),
    [
        ((1, 1, 1), True),
        ((1, 1, 2), True),
        ((1, 1, 2.001), False),
        ((1, 1, 2 + 1e-12), True),
        ((0, 1, 1), True),
        ((-0.001, 1, 1), False),
        ((0, 0, 0), False),
        ((1, 1, float("nan")), False),
    ],
)
def test_possible(moments, possible):
    body = SpatialInertia(1.0, tensor=t.make_diagonal_tensor(*moments))
    assert requirements.is_consistent(body) == possible


@pytest.mark.parametrize(
    ("moments", "excess", "negativity"),
    [
        ((1, 1, 2), 0.0, -0.5),
        ((1, 1, 4), 0.5, -0.25),
        ((1, 1, 1), -1.0, -1.0),
        ((0, 0, 0), 0.0, 0.0),
        ((1, 1, -1), 1.0, 1.0),
        ((1, 1, -4), 1.0, 1.0),
    ],
)
def test_consistency_is_relative_to_the_largest_moment(moments, excess, negativity):
    found = t.measure_consistency(t.make_diagonal_tensor(*map(float, moments)))
    assert found.moments == tuple(sorted(moments))
    assert (found.excess, found.negativity) == (pytest.approx(excess), pytest.approx(negativity))


def test_consistency_of_noise_is_relative_to_what_counts():
    noise = t.make_diagonal_tensor(0.0, 0.0, 1e-12)
    assert t.measure_consistency(noise).excess == 1
    assert t.measure_consistency(noise, least_size=t.get_noise(10.0)).excess == pytest.approx(1e-3)


@given(st.tuples(*[st.floats(-1, 1)] * 6))
def test_principal_moments_are_those_of_numpy(six):
    wanted = np.linalg.eigvalsh(t.to_matrix(six))
    assert t.compute_principal_moments(six) == pytest.approx(tuple(wanted), rel=1e-7, abs=1e-7)
    excess = t.measure_consistency(six).excess * np.abs(wanted).max()
    assert excess == pytest.approx(wanted[2] - wanted[1] - wanted[0], abs=1e-7)


def test_an_impossible_body_is_refused():
    with pytest.raises(InertiaError, match="physically inconsistent"):
        requirements.require_consistent(
            SpatialInertia(1.0, tensor=t.make_diagonal_tensor(1.0, 1.0, 3.0)), "this"
        )
    with pytest.raises(InertiaError, match="-1 kg"):
        requirements.require_consistent(
            SpatialInertia(-1.0, tensor=t.make_diagonal_tensor(1.0, 1.0, 1.0)), "this"
        )


def test_as_dict():
    body = SpatialInertia(2.0, (1.0, 2.0, 3.0), (1.0, 2.0, 3.0, 4.0, 5.0, 6.0))
    assert body.as_dict() == {
        "mass": 2.0,
        "com": [1.0, 2.0, 3.0],
        "inertia": {"ixx": 1.0, "ixy": 2.0, "ixz": 3.0, "iyy": 4.0, "iyz": 5.0, "izz": 6.0},
    }
