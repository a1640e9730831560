"""Where joints start: within their limits, and as ``<mimic>`` has it."""

import pytest

from urdftool.model.load import load
from urdftool.model.start import compute_allowed_range, start_positions


def robot(write, *joints):
    """A robot of one link with other links on it: joints as ``name``, limits, and what follows."""
    text = '<link name="base"/>'
    for name, limit, mimic in joints:
        text += (
            f'<link name="to_{name}"/><joint name="{name}" type="revolute"><parent link="base"/>'
            f'<child link="to_{name}"/><limit {limit}/>{mimic}</joint>'
        )
    return load(write("r.urdf", f'<robot name="r">{text}</robot>'))


LEAD = '<mimic joint="lead" multiplier="{}" offset="{}"/>'


@pytest.mark.parametrize(
    ("limit", "start"),
    [
        ('lower="-1" upper="1"', 0.0),
        ('lower="-2.7" upper="-0.9"', -0.9),
        ('lower="0.3" upper="1"', 0.3),
        ('lower="1" upper="-1"', 0.0),
    ],
)
def test_a_joint_starts_at_the_position_nearest_to_zero(write, limit, start):
    found, clamped = start_positions(robot(write, ("j", limit, "")))
    assert found == {"j": start}
    assert clamped == ({"j": start} if start else {})


def test_a_follower_beyond_its_limits_moves_its_leader(write):
    follow = ("follow", 'lower="0.5" upper="2"', LEAD.format(-2, 0.1))
    made = robot(write, ("lead", 'lower="-1" upper="1"', ""), follow)
    found, clamped = start_positions(made)
    assert found == pytest.approx({"lead": -0.2, "follow": 0.5})
    assert clamped == {"lead": pytest.approx(-0.2)}
    assert compute_allowed_range(made, "lead") == pytest.approx((-0.95, -0.2))
    assert compute_allowed_range(made, "follow") == (-float("inf"), float("inf"))


def test_a_follower_that_cannot_be_where_it_is_led_is_at_its_limit(write):
    follow = ("follow", 'lower="5" upper="6"', LEAD.format(1, 0))
    found, clamped = start_positions(robot(write, ("lead", 'lower="-1" upper="1"', ""), follow))
    assert found == {"lead": 0.0, "follow": 5.0}
    assert clamped == {}


def test_what_is_wanted_is_taken(write):
    follow = ("follow", 'lower="-20" upper="20"', LEAD.format(2, 0))
    made = robot(write, ("lead", 'lower="0.1" upper="1"', ""), follow)
    assert start_positions(made, {"lead": 7.0}) == ({"lead": 7.0, "follow": 14.0}, {})
