"""Which links stay and which become frames."""

import pytest

from urdftool.formats.sdf.plan import make_plan

from .robots import TWO, WELDED, export, gazebo, inertial, joint, link, named, names, robot, tree

FT = '<sensor name="ft" type="force_torque"/>'
IMPOSSIBLE = inertial(1, (0.1, 0.1, 0.5))


def plan(*parts, lump=False):
    return make_plan(robot(*parts), lump=lump)


def test_a_link_with_mass_is_kept():
    assert plan(*WELDED).owner == {"a": "a", "b": "b"}


def test_lumping_makes_one_of_them():
    made = plan(*WELDED, lump=True)
    assert made.owner == {"a": "a", "b": "a"}
    assert made.mass["a"].mass == 2.0


def test_a_link_without_mass_becomes_a_frame_and_keeps_what_is_below():
    chain = (
        link("a"),
        joint("j", "a", "f", "fixed"),
        link("f", ""),
        joint("k", "f", "b"),
        link("b"),
    )
    made = plan(*chain)
    assert made.owner == {"a": "a", "f": "a", "b": "b"}
    model = tree(export(*chain))
    assert names(model, "link") == ["a", "b"]
    assert named(model, "joint", "k").findtext("parent") == "a"
    assert named(model, "joint", "k").find("pose").get("relative_to") == "f"


def test_a_root_without_mass_is_carried_by_its_child():
    chain = (link("foot", ""), joint("j", "foot", "body", "fixed", origin="0 0 1"), link("body"))
    made = plan(*chain)
    assert made.owner == {"foot": "body", "body": "body"}
    model = tree(export(*chain))
    assert named(model, "frame", "foot").find("pose").get("relative_to") == "__model__"
    assert plan(*chain, lump=True).owner == {"foot": "foot", "body": "foot"}


def test_frames_without_any_mass_hang_together():
    chain = (link("a", ""), joint("j", "a", "b", "fixed"), link("b", ""))
    made = plan(*chain)
    assert made.owner == {"a": "a", "b": "a"}
    assert made.mass["a"].mass == 0


def test_an_impossible_inertia_is_put_together_with_its_neighbour():
    made = plan(
        link("a", inertial(5, (1, 1, 1))), joint("j", "a", "b", "fixed"), link("b", IMPOSSIBLE)
    )
    assert made.owner == {"a": "a", "b": "a"}
    root = plan(
        link("a", IMPOSSIBLE), joint("j", "a", "b", "fixed"), link("b", inertial(5, (1, 1, 1)))
    )
    assert root.owner == {"a": "a", "b": "a"}


def test_an_impossible_inertia_that_no_neighbour_mends_stays_alone():
    made = plan(
        link("a", IMPOSSIBLE), joint("j", "a", "b", "fixed"), link("b", inertial(0.01, (1e-9,) * 3))
    )
    assert made.owner == {"a": "a", "b": "b"}


@pytest.mark.parametrize("lump", [False, True])
@pytest.mark.parametrize(
    "said",
    [
        FT,
        "<preserveFixedJoint>true</preserveFixedJoint>",
        '<preserveFixedJoint value="1"/>',
        "<disableFixedJointLumping>TRUE</disableFixedJointLumping>",
    ],
)
def test_a_joint_of_which_something_is_said_stays(lump, said):
    made = plan(*WELDED, gazebo("j", said), lump=lump)
    assert made.dissolved == set()
    model = tree(export(*WELDED, gazebo("j", said), fixed_joints="lump" if lump else "keep"))
    assert named(model, "joint", "j").get("type") == "fixed"


def test_a_preserve_tag_that_says_no_is_none():
    said = gazebo("j", "<preserveFixedJoint>false</preserveFixedJoint>")
    assert plan(*WELDED, said, lump=True).dissolved == {"j"}


def test_a_sensor_joint_to_a_massless_link_keeps_it():
    parts = (link("a"), joint("j", "a", "b", "fixed"), link("b", ""), gazebo("j", FT))
    written = export(*parts)
    assert float(named(tree(written), "link", "b").findtext("inertial/mass")) == 1e-12
    assert "lossy-mass" in [loss.code for loss in written.losses]


def test_the_world_is_no_link():
    parts = (link("world", ""), joint("j", "world", "a", "fixed"), link("a"))
    for choices in ({}, {"fixed_joints": "lump"}):
        model = tree(export(*parts, **choices))
        assert names(model, "link") == ["a"]
        assert named(model, "joint", "j").findtext("parent") == "world"
        assert named(model, "joint", "j").find("pose").get("relative_to") == "__model__"


def test_poses_of_members_are_composed():
    parts = (link("a"), joint("j", "a", "b", "fixed", origin="1 2 3"), link("b"))
    made = plan(*parts, lump=True)
    assert made.in_owner["b"].translation == (1, 2, 3)
    assert plan(*TWO).in_model["b"].translation == (0, 0, 0)
