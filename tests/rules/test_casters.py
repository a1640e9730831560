"""How high casters end, beside the wheels that are driven."""

from pathlib import Path

import pytest

from urdftool import check

GOOD = Path(__file__).parents[2] / "fixtures/rules/caster-height-mismatch/good.urdf"
FRONT, BACK = 'xyz="0.15 0 -0.075"', 'xyz="-0.15 0 -0.076"'


@pytest.fixture
def lint(write):
    """The messages on the good robot after some replacements."""

    def run(*changes):
        text = GOOD.read_text()
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        found = check(write("cart.urdf", text), select=("caster-height-mismatch",))
        return [finding.message for finding in found]

    return run


def test_casters_on_both_sides_lift_the_wheels(lint):
    (message,) = lint((FRONT, 'xyz="0.15 0 -0.095"'), (BACK, 'xyz="-0.15 0 -0.095"'))
    assert message == (
        "caster 'front_caster' ends 20 mm below the driven wheels, so the wheels are 20 mm above "
        "the ground; write z = -0.075 for its joint"
    )


def test_one_that_is_lower_lifts_them_as_far_as_the_other_lets_it(lint):
    assert "wheels are 10.5 mm above the ground" in lint((FRONT, 'xyz="0.15 0 -0.095"'))[0]
    high = (BACK, 'xyz="-0.15 0 -0.05"')
    assert "is tilted by 7.6°" in lint((FRONT, 'xyz="0.15 0 -0.095"'), high)[0]
    assert lint(high) == []


def test_a_robot_between_casters_that_are_too_high_lies_tilted(lint):
    (message,) = lint((FRONT, 'xyz="0.15 0 -0.06"'), (BACK, 'xyz="-0.15 0 -0.05"'))
    assert "ends 15 mm above" in message
    assert "is tilted by 5.7°; write z = -0.075 for its joint" in message


def test_casters_on_one_side_tilt_it(lint):
    assert (
        "tilted by 5.7°"
        in lint((FRONT, 'xyz="-0.15 0.05 -0.09"'), (BACK, 'xyz="-0.15 0 -0.09"'))[0]
    )
    assert lint((FRONT, 'xyz="-0.15 0.05 -0.07"'), (BACK, 'xyz="-0.15 0 -0.07"')) == []


def test_a_caster_may_be_called_anything_that_is_a_low_sphere(lint):
    names = ("front_caster", "nose"), ("back_caster", "tail")
    (message,) = lint(*names, (FRONT, 'xyz="0.15 0 -0.095"'))
    assert "caster 'nose' ends 20 mm below" in message


@pytest.mark.parametrize(
    "change",
    [
        ('name="front_caster_joint" type="fixed"', 'name="front_caster_joint" type="prismatic"'),
        ('name="left_wheel_joint" type="continuous"', 'name="left_wheel_joint" type="fixed"'),
        ("0 0.12 -0.05", "0 0.12 -0.04"),
        ('<axis xyz="0 0 1"/>', '<axis xyz="0 1 0"/>'),
        ("0 0.12 -0.05", "0.05 0.12 -0.05"),
    ],
    ids=["spring", "one wheel", "wheels of two heights", "axles upright", "two axles"],
)
def test_nothing_is_said_where_it_is_not_sure(lint, change):
    low = (FRONT, 'xyz="0.15 0 -0.095"')
    assert lint(low)
    assert lint(low, change) == []
