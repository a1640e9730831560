"""Tensors: which MuJoCo accepts, and the moments that are written."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from urdftool.formats.mjcf import inertia
from urdftool.mechanics.tensor import (
    ZERO_TENSOR,
    make_diagonal_tensor,
    rotate_tensor,
    to_matrix,
)
from urdftool.model.pose import rotation_from_rpy

MOMENT = st.floats(1e-6, 1e3)
ANGLES = st.tuples(*[st.floats(-3, 3)] * 3)


def test_next_to_nothing_is_lifted_to_zero():
    assert inertia.lift(make_diagonal_tensor(-1.0, -1.0, -1.0)) == ZERO_TENSOR


@given(MOMENT, MOMENT, MOMENT, ANGLES)
@settings(max_examples=200)
def test_what_is_written_passes_mujocos_exact_rule(a, b, c, rpy):
    tensor = inertia.lift(rotate_tensor(make_diagonal_tensor(a, b, c), rotation_from_rpy(rpy)))
    moments, axes = inertia.compute_principal(tensor)
    low, middle, high = moments
    assert low > 0
    assert low + middle >= high
    assert np.linalg.det(axes) == pytest.approx(1)
    matrix = to_matrix(tensor)
    assert abs(axes @ np.diag(moments) @ axes.T - matrix).max() <= 1e-9 * abs(matrix).max()


@pytest.mark.parametrize("thousandths", [1, 3, 7, 11, 13])
def test_a_flat_plate_in_decimals_is_possible(thousandths):
    a, b = 0.001 * thousandths, 0.1
    assert inertia.is_possible(make_diagonal_tensor(a, b, a + b))
