"""Angles of rotations, also where they are hard to take."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool.model.pose import rotation_from_rpy, rpy_from_rotation

angle = st.floats(-4, 4)


def same(one, two):
    return max(abs(a - b) for p, q in zip(one, two, strict=True) for a, b in zip(p, q, strict=True))


@given(angle, angle, angle)
def test_angles_give_the_rotation_back(roll, pitch, yaw):
    rotation = rotation_from_rpy((roll, pitch, yaw))
    assert same(rotation_from_rpy(rpy_from_rotation(rotation)), rotation) < 1e-14


@pytest.mark.parametrize("off", [0, 1e-16, 1e-12, 4.9e-12, 1e-9, 3.7e-6])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("roll", [0, 0.3, -2])
def test_near_a_right_angle_no_digit_is_lost(off, sign, roll):
    rotation = rotation_from_rpy((roll, sign * (math.pi / 2 - off), 1.1))
    assert same(rotation_from_rpy(rpy_from_rotation(rotation)), rotation) < 1e-14
