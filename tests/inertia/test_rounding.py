"""Numbers as they are written."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.mechanics.bodies import move
from urdftool.inertia import solids
from urdftool.inertia.inertia_error import InertiaError
from urdftool.inertia.requirements import is_consistent
from urdftool.inertia.rounding import round_properties
from urdftool.mechanics.spatial_inertia import SpatialInertia
from urdftool.mechanics.tensor import make_diagonal_tensor, measure_consistency
from urdftool.model.numbers import number_text, round_number


def test_noise_goes_and_digits_stay():
    turned = move(solids.box((1, 2, 3), mass=12), rpy=(np.pi / 2, 0, 0))
    assert np.count_nonzero(round_properties(turned).inertia) == 3
    assert round_number(0.00028350000000000003) == 0.0002835
    assert [number_text(v) for v in (1024.0, -0.0 + 0, 0.5, 1e-7, 1e20)] == [
        *("1024", "0", "0.5", "1e-07", "1e+20")
    ]


@settings(max_examples=200, deadline=None)
@given(
    st.tuples(*[st.floats(1e-4, 10)] * 3),
    st.tuples(*[st.floats(-3, 3)] * 3),
    st.floats(1e-12, 1),
)
def test_a_thin_plate_stays_possible(size, rpy, thin):
    plate = solids.box((size[0], size[1], size[2] * thin), mass=3.0)
    found = round_properties(move(plate, rpy=rpy))
    assert is_consistent(found)
    before = measure_consistency(move(plate, rpy=rpy).tensor).excess
    assert measure_consistency(found.tensor).excess <= max(2e-15, before)


def test_what_no_body_has_is_not_rounded():
    with pytest.raises(InertiaError):
        round_properties(SpatialInertia(1.0, tensor=make_diagonal_tensor(1.0, 1.0, 3.0)))


def test_numbers_are_those_a_person_writes():
    found = round_properties(
        move(solids.box((0.3, 0.7, 1.1), mass=1.7), xyz=(1e-17, 0.123456789, 0))
    )
    assert found.tensor[0] == 0.240833
    assert found.com == (0.0, 0.123457, 0.0)
    small = round_properties(
        move(solids.box((0.001, 0.001, 0.001), mass=1.7), xyz=(3.123456789, 0, 0))
    )
    assert small.com == (3.123456789, 0.0, 0.0)
