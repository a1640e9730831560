"""Quaternions: exact where a person would write them by hand, and the same rotation always."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool.formats.mjcf.frame import quaternion_from_rotation, simplify_quaternion
from urdftool.model.pose import quaternion_from_rpy, rotation_from_quaternion, rotation_from_rpy

ANGLE = st.floats(-10, 10, allow_subnormal=False)


@pytest.mark.parametrize(
    ("rpy", "expected"),
    [
        ((math.pi / 2, 0, 0), (1, 1, 0, 0)),
        ((0, -math.pi / 2, 0), (1, 0, -1, 0)),
        ((0, 0, math.pi), (0, 0, 0, 1)),
        ((math.pi / 2, 0, math.pi / 2), (1, 1, 1, 1)),
        ((0, 0, 2 * math.pi), None),
        ((0, 0, 0), None),
    ],
)
def test_quarter_turns_are_whole_numbers(rpy, expected):
    assert simplify_quaternion(quaternion_from_rpy(rpy)) == expected


def test_a_turn_that_is_nearly_a_quarter_is_kept():
    assert simplify_quaternion(quaternion_from_rpy((1.5708, 0, 0))) != (1, 1, 0, 0)


@given(ANGLE, ANGLE, ANGLE)
def test_same_rotation(roll, pitch, yaw):
    rotation = rotation_from_rpy((roll, pitch, yaw))
    for quaternion in (quaternion_from_rpy((roll, pitch, yaw)), quaternion_from_rotation(rotation)):
        written = simplify_quaternion(quaternion) or (1, 0, 0, 0)
        again = rotation_from_quaternion(written)
        assert max(
            abs(a - b)
            for row, other in zip(rotation, again, strict=True)
            for a, b in zip(row, other, strict=True)
        ) < 1e-14  # fmt: skip
