"""Masses put together, against closed forms."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool.formats.sdf.mass import Mass, lifted, principal, shortfall, united
from urdftool.model.pose import Pose, rotation_of_rpy

number = st.floats(-3, 3, allow_subnormal=False)
positive = st.floats(0.01, 10)
angles = st.tuples(number, number, number)


def solid(mass, a, b, c):
    """A box of a mass and three sizes, about its centre."""
    return Mass(
        mass,
        (0.0, 0.0, 0.0),
        (
            (mass / 12 * (b * b + c * c), 0.0, 0.0),
            (0.0, mass / 12 * (a * a + c * c), 0.0),
            (0.0, 0.0, mass / 12 * (a * a + b * b)),
        ),
    )


def test_two_half_boxes_are_a_box():
    half = solid(2.0, 0.5, 1.0, 2.0)
    both = united(half.moved(Pose(translation=(x, 0.0, 0.0))) for x in (-0.25, 0.25))
    whole = solid(4.0, 1.0, 1.0, 2.0)
    assert both.mass == 4.0
    assert both.center == (0.0, 0.0, 0.0)
    for i in range(3):
        assert both.tensor[i] == pytest.approx(whole.tensor[i], abs=1e-14)


def test_a_body_of_no_mass_adds_nothing():
    body = solid(2.0, 1.0, 1.0, 1.0)
    assert united([body, Mass()]) == body
    assert united([Mass(), Mass()]) == Mass()  # and is not a number either way


@given(positive, positive, positive, positive, angles, angles)
def test_turning_keeps_the_principal_moments(mass, a, b, c, rpy, at):
    body = solid(mass, a, b, c)
    moved = body.moved(Pose(rotation_of_rpy(rpy), at))
    low, middle, high = sorted(body.tensor[i][i] for i in range(3))
    assert principal(moved.tensor)[0] == pytest.approx((low, middle, high), rel=1e-9, abs=1e-12)
    assert moved.center == pytest.approx(at)


@given(st.tuples(*[st.floats(-1, 1)] * 6))
def test_the_nearest_possible_tensor_is_possible(six):
    xx, yy, zz, xy, xz, yz = six
    tensor = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    if max(map(abs, six)) < 1e-6:
        return
    mended = lifted(tensor)
    assert shortfall(mended) <= 1e-11
    if shortfall(tensor) < -1e-6:
        for i in range(3):
            assert mended[i] == pytest.approx(tensor[i], rel=1e-9, abs=1e-10)


@pytest.mark.parametrize(
    ("moments", "expected"),
    [((1, 1, 2), 0.0), ((1, 1, 2.5), 0.2), ((1, 1, 1), -1.0), ((0, 0, 0), 0.0), ((1, 1, -1), 1.0)],
)
def test_shortfall_is_the_excess_over_the_triangle(moments, expected):
    a, b, c = moments
    assert shortfall(((a, 0, 0), (0, b, 0), (0, 0, c))) == pytest.approx(expected)


def test_moments_of_a_rotated_rod():
    turn = rotation_of_rpy((0.0, math.pi / 2, 0.3))
    rod = Mass(3.0, (0.0, 0.0, 0.0), ((1.0, 0, 0), (0, 1.0, 0), (0, 0, 0.0)))
    assert principal(rod.moved(Pose(turn)).tensor)[0] == pytest.approx((0, 1, 1), abs=1e-15)
