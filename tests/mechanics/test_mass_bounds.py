"""No body inside a box spreads its mass further than the bound."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool.inertia.solids import box
from urdftool.mechanics.mass_bounds import check_com, check_spread, spread_ratio
from urdftool.mechanics.spatial_inertia import SpatialInertia, combine
from urdftool.model.bounds import Bounds

UNIT = Bounds((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
places = st.tuples(*[st.floats(0.2, 0.8)] * 3)
lumps = st.lists(st.tuples(places, st.floats(0.01, 5)), min_size=1, max_size=8)


def ratio(body, around, **options):
    return spread_ratio(around, body.mass, body.com, body.tensor, **options)[0]


@given(lumps)
def test_lumps_in_the_unit_box(masses):
    body = combine(SpatialInertia(mass, place) for place, mass in masses)
    assert ratio(body, UNIT) <= 1


def test_two_lumps_in_opposite_corners_reach_it():
    body = combine(SpatialInertia(1.0, corner) for corner in UNIT)
    assert ratio(body, UNIT, rounding=0.0) == pytest.approx(1)


def test_a_solid_box_has_a_third():
    body = box((1, 2, 3), mass=4)
    around = Bounds((-0.5, -1.0, -1.5), (0.5, 1.0, 1.5))
    assert ratio(body, around, rounding=0.0) == pytest.approx(1 / 3)


def test_square_millimeters_and_a_center_outside():
    body = box((0.1, 0.1, 0.1), mass=1)
    around = Bounds((-0.05,) * 3, (0.05,) * 3)
    wrong = SpatialInertia(1.0, body.com, tuple(1e6 * value for value in body.tensor))
    assert ratio(wrong, around) > 30
    assert ratio(wrong, around, rounding=0.0) > 1e4
    assert check_com(around, (1.0, 0.0, 0.0), False).axis == 0
    assert check_com(around, (0.0, 0.0, 0.0), False) is None


def _bar(length, center, spread):
    """Judge a bar along x: its length, its center of mass, and the standard deviation [m]."""
    box = Bounds((0.0, -0.01, -0.01), (length, 0.01, 0.01))
    variance = spread * spread
    return check_spread(box, 1.0, (center, 0, 0), (0, 0, 0, variance, 0, variance), rough=False)


@pytest.mark.parametrize("center", [0.5, 0.3, 0.02])
def test_the_stated_length_is_the_least_that_holds_the_mass(center):
    found = _bar(1.0, center, 1.5)
    assert found.axis == 0
    assert found.amount == pytest.approx(3)  # two halves at the ends of 3 m
    assert "at least 3 times as long along x" in found.sentence
    assert _bar(found.amount * 1.001, found.amount / 2, 1.5) is None


def test_no_length_is_stated_where_the_center_of_mass_is_the_reason():
    found = _bar(1.0, 0.1, 0.4)  # fits with its center in the middle
    assert found.amount < 1
    assert "times" not in found.sentence
    assert "the center of mass is at 0.1 m" in found.sentence
    assert _bar(1.0, 0.5, 0.4) is None
