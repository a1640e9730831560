"""Joints: types, axes, limits, leaders."""

import pytest

from .robots import TWO, export, joint, link, named, names, rules, tree


def axis_of(model, name="j"):
    return named(model, "joint", name).find("axis")


def one(kind, inside=None, **choices):
    written = export(link("a"), joint("j", "a", "b", kind, inside), link("b"), **choices)
    return written, tree(written)


def test_a_revolute_joint_says_all_it_said():
    inside = (
        '<axis xyz="0 1 0"/><limit lower="-0.5" upper="0.25" effort="7" velocity="8"/>'
        '<dynamics damping="0.1" friction="0.2"/>'
    )
    _, model = one("revolute", inside)
    axis = axis_of(model)
    assert axis.findtext("xyz") == "0 1 0"
    assert [axis.findtext(f"limit/{n}") for n in ("lower", "upper", "effort", "velocity")] == [
        "-0.5", "0.25", "7", "8",
    ]  # fmt: skip
    assert axis.findtext("dynamics/damping") == "0.1"
    assert axis.findtext("dynamics/friction") == "0.2"


def test_the_axis_is_x_where_none_is_written_and_of_unit_length():
    assert axis_of(one("revolute")[1]).findtext("xyz") == "1 0 0"
    inside = '<axis xyz="0 3 4"/><limit lower="0" upper="1" effort="1" velocity="1"/>'
    assert axis_of(one("revolute", inside)[1]).findtext("xyz") == "0 0.6 0.8"


def test_a_continuous_joint_has_no_bounds():
    written, model = one("continuous", '<limit lower="-1" upper="1" effort="1" velocity="2"/>')
    assert named(model, "joint", "j").get("type") == "revolute"
    assert axis_of(model).find("limit/lower") is None
    assert axis_of(model).findtext("limit/effort") == "1"
    assert "lossy-limit" in rules(written)


def test_a_bound_that_is_not_written_is_zero():
    _, model = one("prismatic", '<limit upper="2" effort="1" velocity="1"/>')
    assert (axis_of(model).findtext("limit/lower"), axis_of(model).findtext("limit/upper")) == (
        "0",
        "2",
    )


def test_a_negative_effort_is_no_infinite_one():
    written, model = one("revolute", '<limit lower="0" upper="1" effort="-5" velocity="0"/>')
    assert axis_of(model).findtext("limit/effort") == "5"
    assert axis_of(model).findtext("limit/velocity") == "0"
    assert rules(written).count("lossy-limit") == 2


def test_a_floating_joint_is_a_free_link():
    written, model = one("floating")
    assert model.find("joint") is None
    assert named(model, "link", "b").find("pose").get("relative_to") == "a"
    assert "lossy-floating" in rules(written)


@pytest.mark.parametrize("normal", ["0 0 1", "1 0 0", "0 1 0", "0.6 0 0.8"])
def test_a_planar_joint_is_three(normal):
    written, model = one("planar", f'<axis xyz="{normal}"/>')
    assert names(model, "joint") == ["j_x", "j_y", "j"]
    kinds = [named(model, "joint", n).get("type") for n in ("j_x", "j_y", "j")]
    assert kinds == ["prismatic", "prismatic", "revolute"]
    x, y, z = (
        [float(w) for w in axis_of(model, n).findtext("xyz").split()] for n in ("j_x", "j_y", "j")
    )
    cross = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]
    assert cross == pytest.approx(z)
    assert "lossy-planar" in rules(written)


def test_a_ball_joint():
    assert named(one("spherical")[1], "joint", "j").get("type") == "ball"


MIMIC = (
    *TWO,
    joint("k", "b", "c", inside='<limit lower="0" upper="1" effort="1" velocity="1"/>'
          '<mimic joint="j" multiplier="-2" offset="0.5"/>'),
    link("c"),
)  # fmt: skip


def test_a_follower_names_its_leader():
    mimic = axis_of(tree(export(*MIMIC)), "k").find("mimic")
    assert mimic.get("joint") == "j"
    assert [e.text for e in mimic] == ["-2", "0.5", "0"]


@pytest.mark.parametrize(
    "choices", [{"version": "1.9"}, {"version": "1.10"}, {"target": "gazebo-classic"}]
)
def test_older_versions_cannot_say_who_follows(choices):
    written = export(*MIMIC, **choices)
    assert axis_of(tree(written), "k").find("mimic") is None
    assert "lossy-mimic" in rules(written)


@pytest.mark.parametrize("kind", ["spherical", "planar", "floating"])
def test_only_an_axis_can_follow(kind):
    inside = '<limit effort="1" velocity="1"/><mimic joint="j"/>'
    written = export(*TWO, joint("k", "b", "c", kind, inside=inside), link("c"))
    assert rules(written).count("lossy-mimic") == 1
    assert not list(tree(written).iter("mimic"))


def test_soft_limits_stay_as_a_comment():
    inside = (
        '<limit lower="0" upper="1" effort="1" velocity="1"/><safety_controller k_velocity="3"/>'
    )
    written, model = one("revolute", inside)
    comments = [e.text for e in named(model, "joint", "j") if not isinstance(e.tag, str)]
    assert comments == [' safety_controller k_velocity="3" ']
    assert "lossy-safety" in rules(written)


def test_a_zero_axis_is_fixed_when_forced():
    inside = '<axis xyz="0 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/>'
    written, model = one("revolute", inside, force=True)
    assert named(model, "joint", "j").get("type") == "fixed"
    assert "lossy-axis" in rules(written)


def test_before_frames_poses_are_of_the_model():
    parts = (
        link("a"), joint("j", "a", "b", origin="1 0 0"), link("b"),
        joint("k", "b", "c", origin="0 2 0"), link("c"),
    )  # fmt: skip
    model = tree(export(*parts, target="gazebo-classic", version="1.6"))
    assert named(model, "link", "c").findtext("pose") == "1 2 0 0 0 0"
    assert named(model, "joint", "k").find("pose") is None
    assert model.find("frame") is None
