"""Tensors: which MuJoCo takes, and the three repairs in closed form."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from urdftool.formats.mjcf import inertia

MOMENT = st.floats(1e-6, 1e3)


def rotation(seed):
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


def test_lift_raises_a_rod_that_is_too_thin_to_its_least():
    lifted = inertia.lift(np.diag([1.0, 1.0, 3.0]))
    # second moments 1.5, 1.5, -0.5: without the last, the body is flat
    assert np.diag(lifted) == pytest.approx([1.5, 1.5, 3.0])
    assert inertia.is_possible(lifted)


def test_lift_leaves_what_is_possible():
    tensor = rotation(1) @ np.diag([1.0, 2.0, 2.5]) @ rotation(1).T
    assert inertia.lift(tensor) == pytest.approx(tensor)


def test_balance_keeps_the_mean():
    assert np.diag(inertia.balance(np.diag([1.0, 1.0, 4.0]))) == pytest.approx([2, 2, 2])


def test_box():
    assert np.diag(inertia.box(12.0, np.array([1.0, 2.0, 3.0]))) == pytest.approx([13, 10, 5])


@given(MOMENT, MOMENT, MOMENT, st.integers(0, 1000))
@settings(max_examples=200)
def test_what_is_written_passes_mujocos_exact_rule(a, b, c, seed):
    turn = rotation(seed)
    tensor = inertia.lift(turn @ np.diag([a, b, c]) @ turn.T)
    moments, axes = inertia.principal(tensor)
    low, middle, high = moments
    assert low > 0
    assert low + middle >= high
    assert np.linalg.det(axes) == pytest.approx(1)
    scale = abs(tensor).max()
    assert abs(axes @ np.diag(moments) @ axes.T - tensor).max() <= 1e-9 * scale


@pytest.mark.parametrize("thousandths", [1, 3, 7, 11, 13])
def test_a_flat_plate_in_decimals_is_possible(thousandths):
    a, b = 0.001 * thousandths, 0.1
    assert inertia.is_possible(np.diag([a, b, a + b]))
