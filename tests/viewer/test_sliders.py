import math

import pytest

from urdftool.viewer.sliders import create_sliders, explain_unmovable, format_value

from .robots import ARM, joint, limit, link, read, urdf


def one(tmp_path, kind, inside="", **options):
    text = urdf(link("a"), link("b"), joint("j", kind, "a", "b", inside))
    (slider,) = create_sliders(read(tmp_path / "r.urdf", text), **options)
    return slider


def test_limits_are_the_ends(tmp_path):
    slider = one(tmp_path, "revolute", limit(-1.5, 0.75))
    assert (slider.lower, slider.upper, slider.locked, slider.note) == (-1.5, 0.75, False, "")
    assert slider.format_position(slider.lower) == "−85.9°"


def test_a_continuous_joint_turns_half_a_turn_either_way(tmp_path):
    slider = one(tmp_path, "continuous", limit(-1, 1))
    assert (slider.lower, slider.upper) == (-math.pi, math.pi)
    low, high = slider.shown_bounds
    assert low <= -math.pi
    assert high >= math.pi
    assert slider.clamp_position(high) == math.pi


def test_no_limit_is_half_a_turn_or_the_size_of_the_robot(tmp_path):
    assert one(tmp_path, "revolute").upper == math.pi
    slider = one(tmp_path, "prismatic", reach=2.5)
    assert (slider.lower, slider.upper, slider.turns) == (-2.5, 2.5, False)
    assert "limits not specified" in slider.note


@pytest.mark.parametrize("bound", ["inf", "1e300", "nan"])
def test_a_limit_that_is_none(tmp_path, bound):
    slider = one(tmp_path, "revolute", limit(f"-{bound}" if bound != "nan" else bound, bound))
    assert math.isfinite(slider.lower)
    assert math.isfinite(slider.upper)
    assert slider.lower <= 0 <= slider.upper


def test_limits_the_wrong_way_round_are_said_and_can_be_moved_between(tmp_path):
    slider = one(tmp_path, "revolute", limit(1, -1))
    assert (slider.lower, slider.upper, slider.locked) == (-1, 1, False)
    assert slider.note == "lower limit 1 is above upper limit -1"


def test_limits_without_room_lock_the_joint(tmp_path):
    slider = one(tmp_path, "revolute", limit(0.3, 0.3))
    assert slider.locked
    assert slider.zero == 0.3
    assert "locked" in slider.note


def test_zero_is_the_middle_where_it_is_beyond_the_limits(tmp_path):
    assert one(tmp_path, "revolute", limit(1, 2)).zero == 1.5
    assert one(tmp_path, "revolute", limit(-1, 2)).zero == 0.0


def test_a_start_beyond_the_limits_widens_them(tmp_path):
    slider = one(tmp_path, "revolute", limit(-1, 1), start={"j": 1.7})
    assert (slider.lower, slider.upper) == (-1, 1.7)


def test_a_mimic_is_locked_and_reaches_where_it_is_led(tmp_path):
    by_name = {slider.name: slider for slider in create_sliders(read(tmp_path / "r.urdf", ARM))}
    mirror = by_name["grip_mirror"]
    assert mirror.follows
    assert mirror.locked
    assert (mirror.lower, mirror.upper) == (-0.04, 0.04)
    assert mirror.note == "mimics grip × -1"
    assert mirror.format_position(-0.04) == "−40 mm"


def test_mimics_of_each_other_end(tmp_path):
    text = urdf(
        link("a"), link("b"), link("c"),
        joint("j", "continuous", "a", "b", '<mimic joint="k"/>'),
        joint("k", "continuous", "b", "c", '<mimic joint="j"/>'),
    )  # fmt: skip
    assert [slider.locked for slider in create_sliders(read(tmp_path / "r.urdf", text))] == [
        True
    ] * 2


def test_floating_and_planar_are_said_and_have_no_slider(tmp_path):
    text = urdf(
        link("a"), link("b"), link("c"),
        joint("f", "floating", "a", "b"), joint("p", "planar", "b", "c"),
    )  # fmt: skip
    robot = read(tmp_path / "r.urdf", text)
    assert create_sliders(robot) == []
    assert [line.partition(" and ")[0] for line in explain_unmovable(robot)] == [
        "joint 'f' is floating",
        "joint 'p' is planar",
    ]


@pytest.mark.parametrize(
    ("value", "turns", "words"),
    [
        (math.pi, True, "180°"),
        (-0.0, True, "0°"),
        (0.0125, False, "12.5 mm"),
        (1.5, False, "1500 mm"),
        (25.0, False, "25 m"),
        (math.inf, True, "no limit"),
    ],
)
def test_words(value, turns, words):
    assert format_value(value, turns) == words


def test_what_is_shown_is_what_is_meant(tmp_path):
    slider = one(tmp_path, "prismatic", limit(0, 0.0123))
    assert slider.digits == 6
    for position in (0.0, 0.0123, 0.00617):
        assert slider.clamp_position(slider.round_position(position)) == pytest.approx(
            position, abs=1e-6
        )


def test_brief_words_have_no_minus_without_a_number(tmp_path):
    turning, sliding = one(tmp_path, "continuous"), one(tmp_path, "prismatic")
    assert [turning.format_short(v) for v in (-0.001, 0.7, -2.0)] == ["0°", "40°", "−115°"]
    assert [sliding.format_short(v) for v in (-0.00001, 0.0042, -1.25)] == [
        "0.0 mm",
        "4.2 mm",
        "−1250 mm",
    ]
