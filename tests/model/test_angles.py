"""Multiples of 15° are written with four decimals, and equal what was rounded in another way."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from urdftool.model.angles import format_angles, restore_angle
from urdftool.model.numbers import format_pose_text, number_text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        *((math.pi / 2, "1.5708"), (-math.pi, "-3.1416"), (math.pi / 12, "0.2618")),
        *((1.57079633, "1.5708"), (0.0, "0"), (-0.0, "0"), (0.3, "0.3"), (1.5, "1.5")),
        (0.7853982, "0.7853982"),
    ],
)
def test_text(value, text):
    assert format_angles([value]) == text


@pytest.mark.parametrize("decimals", range(4, 16))
def test_every_rounding_is_restored(decimals):
    for exact in (step * math.pi / 12 for step in range(-24, 25)):
        assert restore_angle(round(exact, decimals)) == pytest.approx(exact, abs=1e-15)


@pytest.mark.parametrize("value", [1.57, 1.5709, 1.57081, 1.570797, 3.1415, 0.0001, math.inf, 1e9])
def test_other_angles_stay(value):
    assert restore_angle(value) == value


@given(st.floats(-100, 100))
def test_a_restored_angle_is_near(value):
    assert abs(restore_angle(value) - value) <= 5e-5


ARM = """<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute">
<origin xyz="0 0 1" rpy="{0} 0 0"/><parent link="a"/><child link="b"/>
<limit lower="-{0}" upper="{0}" effort="1" velocity="{1}"/></joint></robot>"""


@pytest.mark.parametrize(
    ("one", "other", "code"),
    [
        *(("1.5708", "1.57079633", 0), ("1.5708", "1.5707963267948966", 0)),
        *(("1.5708", "1.5709", 1), ("1.2345", "1.23449", 1)),
    ],
)
def test_diff_takes_roundings_of_a_right_angle_as_equal(urdftool, write, one, other, code):
    files = [write(f"{text}.urdf", ARM.format(text, "1")) for text in (one, other)]
    assert urdftool("diff", *files).code == code


def test_diff_restores_only_angles(urdftool, write):
    files = [write(f"{text}.urdf", ARM.format("1", text)) for text in ("1.5708", "1.57079633")]
    assert urdftool("diff", *files).code == 1


@pytest.mark.parametrize(
    ("value", "text"),
    [
        *((0.00029249999999999995, "0.0002925"), (1e20, "1e+20"), (-0.0, "0"), (3.0, "3")),
        *((1.5707963267948966, "1.5707963267948966"), (1e-18, "1e-18")),
    ],
)
def test_numbers_without_noise(value, text):
    assert number_text(value) == text


def test_poses_have_no_rounding_errors_of_zero():
    assert format_pose_text((-3.469446951953614e-18, 0.1, -0.0)) == "0 0.1 0"


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_change_by_rounding_errors_only(value):
    assert float(number_text(value)) == pytest.approx(value, rel=2e-15, abs=0)
