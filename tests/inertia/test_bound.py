"""No body inside a box spreads its mass further than the bound."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool.inertia.bound import spread_ratio
from urdftool.inertia.solids import box
from urdftool.inertia.tensor import MassProperties, combine

places = st.tuples(*[st.floats(0, 1)] * 3)
lumps = st.lists(st.tuples(places, st.floats(0.01, 5)), min_size=1, max_size=8)


@given(lumps)
def test_lumps_in_the_unit_box(masses):
    body = combine(
        MassProperties(mass, np.array(place), np.zeros((3, 3))) for place, mass in masses
    )
    ratio = spread_ratio(body.mass, body.com, body.inertia, (0, 0, 0), (1, 1, 1))
    assert np.all(ratio <= 1)


def test_two_lumps_in_opposite_corners_reach_it():
    corners = (np.zeros(3), np.ones(3))
    body = combine(MassProperties(1.0, corner, np.zeros((3, 3))) for corner in corners)
    ratio = spread_ratio(body.mass, body.com, body.inertia, *corners, margin=0)
    np.testing.assert_allclose(ratio, [1, 1, 1])


def test_a_solid_box_has_a_third():
    body = box((1, 2, 3), mass=4)
    half = np.array([0.5, 1, 1.5])
    ratio = spread_ratio(4, body.com, body.inertia, -half, half, margin=0)
    np.testing.assert_allclose(ratio, [1 / 3] * 3)


def test_square_millimetres_and_a_centre_outside():
    body = box((0.1, 0.1, 0.1), mass=1)
    half = np.full(3, 0.05)
    assert np.all(spread_ratio(1, body.com, body.inertia * 1e6, -half, half) > 1e4)
    assert spread_ratio(1, (1, 0, 0), body.inertia, -half, half)[0] == pytest.approx(np.inf)
