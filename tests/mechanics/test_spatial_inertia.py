"""Bodies moved and combined, against closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool.inertia.solids import box, cylinder
from urdftool.mechanics.spatial_inertia import SpatialInertia, combine
from urdftool.mechanics.tensor import compute_principal_moments, make_diagonal_tensor
from urdftool.model.pose import Pose, rotation_from_rpy

number = st.floats(-3, 3, allow_subnormal=False)
positive = st.floats(0.01, 10)
angles = st.tuples(number, number, number)


def test_two_half_boxes_are_a_box():
    half = box((0.5, 1.0, 2.0), mass=2.0)
    both = combine(half.transform(Pose(translation=(x, 0.0, 0.0))) for x in (-0.25, 0.25))
    assert both.mass == 4.0
    assert both.com == (0.0, 0.0, 0.0)
    assert both.tensor == pytest.approx(box((1.0, 1.0, 2.0), mass=4.0).tensor, abs=1e-14)


def test_a_body_of_no_mass_adds_nothing():
    body = box((1.0, 1.0, 1.0), mass=2.0)
    assert combine([body, SpatialInertia()]) == body
    assert combine([SpatialInertia(), SpatialInertia()]) == SpatialInertia()


def test_sums_beyond_the_range_of_floats_are_infinite():
    heavy = SpatialInertia(1e308, (1.0, 0.0, 0.0), make_diagonal_tensor(1e308, 1e308, 1e308))
    assert combine([heavy, heavy]).mass == math.inf


@given(positive, positive, positive, positive, angles, angles)
def test_moving_keeps_the_principal_moments(mass, a, b, c, rpy, at):
    body = box((a, b, c), mass=mass)
    moved = body.transform(Pose(rotation_from_rpy(rpy), at))
    # equal moments are good to half the digits
    wanted = compute_principal_moments(body.tensor)
    assert compute_principal_moments(moved.tensor) == pytest.approx(wanted, rel=1e-7, abs=1e-12)
    assert moved.com == pytest.approx(at)


def test_moments_of_a_rotated_rod():
    turn = rotation_from_rpy((0.0, math.pi / 2, 0.3))
    rod = SpatialInertia(3.0, tensor=make_diagonal_tensor(1.0, 1.0, 0.0))
    moments = compute_principal_moments(rod.transform(Pose(turn)).tensor)
    assert moments == pytest.approx((0, 1, 1), abs=1e-15)


@given(angles, angles, angles)
def test_moment_about_an_axis(point, axis, rpy):
    if math.hypot(*axis) < 0.01:
        return
    body = cylinder(0.1, 0.4, mass=2.0).transform(Pose(rotation_from_rpy(rpy), (0.3, -0.2, 0.1)))
    unit = np.array(axis) / np.linalg.norm(axis)
    away = np.cross(np.subtract(body.com, point), unit)
    wanted = unit @ body.inertia @ unit + body.mass * away @ away
    assert body.compute_moment_about(point, axis) == pytest.approx(wanted, rel=1e-9)


def test_another_mass_keeps_the_shape():
    body = box((1.0, 2.0, 3.0), density=1e-200)
    heavy = body.with_mass(2.0)
    assert heavy.tensor == pytest.approx(box((1.0, 2.0, 3.0), mass=2.0).tensor, rel=1e-12)
