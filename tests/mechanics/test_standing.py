"""The definition of a robot that stands: each of its parts, and what it says."""

import pytest

from urdftool.mechanics.standing import (
    BaseMotion,
    Bounds,
    JointMotion,
    Motion,
    estimate_end,
    get_nudge_side,
)

BOUNDS = Bounds.make_for_size(1.0)


def motion(joints=(), bases=None, **base):
    bases = [BaseMotion("the base", **base)] if bases is None else bases
    return Motion(bases, joints, bounds=BOUNDS)


@pytest.mark.parametrize(
    ("base", "stands", "stays"),
    [
        ({}, True, True),
        ({"tilt": 4, "lean": 4}, True, False),
        ({"tilt": 1, "lean": 11}, False, False),
        ({"tilt": 11, "lean": 11}, False, False),
        ({"drift": 0.3, "slide": 0.3}, True, False),
        ({"drift": 0.6, "slide": 0.6}, False, False),
        ({"drift": 0.09, "sink": 0.09, "shrinking": 0.11}, False, False),
        ({"resting": ("hand",)}, False, False),
    ],
)
def test_a_base_stands_within_every_bound(base, stands, stays):
    found = motion(**base)
    assert (found.stands, found.stays) == (stands, stays)
    assert bool(list(found.describe_base())) == (not stays)


def test_an_arm_on_a_fixed_base_that_sinks_does_not_stand():
    found = motion([JointMotion("elbow", 0.06)], bases=[])
    assert not found.stands
    assert list(found.describe_joints()) == [("joints move by up to 0.06 rad, 'elbow' most", True)]


def test_arms_that_drop_on_a_base_that_stands_are_named():
    arms = [
        JointMotion("left", 0.1, is_carried=True),
        JointMotion("right", 0.4, is_carried=True, is_held=False),
    ]
    found = motion(arms)
    assert found.stands
    assert not found.stays
    text = "stands, its joints sag by up to 0.4 rad, 'right' most"
    assert list(found.describe_joints()) == [(text, False)]


def test_joints_of_a_robot_that_falls_are_not_said_to_sag():
    found = motion([JointMotion("left", 1, is_carried=True)], tilt=80, lean=80)
    assert list(found.describe_joints()) == []
    assert [text.partition(":")[0] for text in found.describe_base()] == ["falls"]


def test_a_slide_is_measured_by_the_size_of_the_robot():
    finger = [JointMotion("finger", 0.02, is_slide=True)]
    assert Motion([], finger, bounds=Bounds.make_for_size(1.0)).stands
    assert not Motion([], finger, bounds=Bounds.make_for_size(0.2)).stands


def test_a_simulation_that_is_not_finite_does_not_stand():
    assert not Motion(is_finite=False).stands


@pytest.mark.parametrize(
    ("values", "end"),
    [
        ((0, 0, 0), 0),
        ((0, 1, 0), 0),  # to and fro
        ((0, 2, 3), 4),  # each half of the rest is half of the one before
        ((0, 1, 2), 22),  # goes on for 5 s, in halves of 0.25 s
        ((0, 1, 4), 64),  # a fall does not get slower, and is not extrapolated as one
    ],
)
def test_a_motion_goes_on_as_it_slows_down(values, end):
    assert estimate_end(values) == pytest.approx(end)


def test_gravity_tilts_to_both_sides():
    assert [get_nudge_side(time) for time in (0, 0.099, 0.1, 0.199, 0.2, 1)] == [1, 1, -1, -1, 0, 0]
