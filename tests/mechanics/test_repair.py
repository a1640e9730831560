"""The three repairs of an inconsistent tensor in closed form."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool.mechanics.repair import (
    compute_box_tensor,
    compute_sphere_tensor,
    find_nearest_consistent,
)
from urdftool.mechanics.tensor import (
    get_diagonal,
    make_diagonal_tensor,
    measure_consistency,
    rotate_tensor,
)
from urdftool.model.pose import rotation_from_rpy

TURN = rotation_from_rpy((0.3, -0.8, 1.9))


def test_a_rod_that_is_too_thin_is_raised_to_its_least():
    lifted = find_nearest_consistent(make_diagonal_tensor(1.0, 1.0, 3.0))
    # second moments 1.5, 1.5, -0.5: without the last, the body is flat
    assert lifted == pytest.approx(make_diagonal_tensor(1.5, 1.5, 3.0))
    rotated = find_nearest_consistent(rotate_tensor(make_diagonal_tensor(1.0, 1.0, 3.0), TURN))
    assert rotated == pytest.approx(rotate_tensor(lifted, TURN))


def test_a_consistent_tensor_stays():
    tensor = rotate_tensor(make_diagonal_tensor(1.0, 2.0, 2.5), TURN)
    assert find_nearest_consistent(tensor) == pytest.approx(tensor)


@given(st.tuples(*[st.floats(-1, 1)] * 6))
def test_the_nearest_consistent_tensor_is_consistent(tensor):
    if max(map(abs, tensor)) < 1e-6:
        return
    lifted = find_nearest_consistent(tensor, margin=1e-12)
    assert measure_consistency(lifted).excess <= 1e-11
    if measure_consistency(tensor).excess < -1e-6:
        assert lifted == pytest.approx(tensor, rel=1e-9, abs=1e-10)


def test_a_sphere_keeps_the_mean():
    assert get_diagonal(compute_sphere_tensor(make_diagonal_tensor(1.0, 1.0, 4.0))) == (2, 2, 2)


def test_a_box():
    assert get_diagonal(compute_box_tensor(12.0, (1.0, 2.0, 3.0))) == pytest.approx((13, 10, 5))
