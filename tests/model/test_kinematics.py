"""Poses of links against hand-made ones."""

import math

import pytest

from tests.graph.robots import robot, tree
from urdftool.errors import ModelError
from urdftool.model.kinematics import add_mimic_positions, check_positions, get_limits, link_poses

TURN = "0 0 1.5707963267948966"


def test_poses_are_chained():
    joint = (
        '<joint name="{}" type="fixed"><parent link="{}"/><child link="{}"/>'
        f'<origin xyz="1 0 0" rpy="{TURN}"/></joint>'
    )
    model = robot(
        '<robot name="r"><link name="a"/><link name="b"/><link name="c"/>'
        + joint.format("ab", "a", "b")
        + joint.format("bc", "b", "c")
        + "</robot>"
    )
    poses = link_poses(model)
    assert poses["c"].translation == pytest.approx((1, 1, 0))
    assert poses["c"].transform((1, 0, 0)) == pytest.approx((0, 1, 0))


def test_what_hangs_on_no_root_has_no_pose():
    assert set(link_poses(tree("abc", [("bc", "b", "c"), ("cb", "c", "b")]))) == {"a"}


ARM = """<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="turn" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 1"/>
  <axis xyz="0 0 2"/><limit lower="-1" upper="2" effort="1" velocity="1"/></joint>
<joint name="slide" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
  <limit upper="2" effort="1" velocity="1"/>
  <mimic joint="turn" multiplier="2" offset="0.5"/></joint>
<joint name="last" type="continuous"><parent link="c"/><child link="d"/><axis xyz="0 1 0"/>
  <mimic joint="slide" multiplier="-1"/></joint></robot>"""


def test_joints_turn_about_and_slide_along_their_axes():
    poses = link_poses(robot(ARM), {"turn": math.pi / 2, "slide": 3})
    assert poses["c"].translation == pytest.approx((0, 3, 1))
    assert poses["d"].transform((1, 0, 0)) == pytest.approx((0, 4, 1))


def test_mimics_are_followed_along_their_chain():
    assert add_mimic_positions(robot(ARM), {"turn": 1}) == {"turn": 1, "slide": 2.5, "last": -2.5}
    assert add_mimic_positions(robot(ARM), {"turn": 1, "slide": 0})["last"] == 0


def test_a_loop_of_mimics_ends():
    loop = ARM.replace('<axis xyz="0 0 2"/>', '<axis xyz="0 0 2"/><mimic joint="last"/>')
    assert set(add_mimic_positions(robot(loop), {})) == {"turn", "slide", "last"}


def test_limits():
    arm = robot(ARM)
    assert get_limits(arm.joint["turn"]) == (-1, 2)
    assert get_limits(arm.joint["slide"]) == (0, 2)
    assert get_limits(arm.joint["last"]) == (-math.inf, math.inf)


@pytest.mark.parametrize(
    ("positions", "words"),
    [
        ({"trun": 1}, "did you mean 'turn'"),
        ({"turn": math.nan}, "not a finite number"),
        ({"slide": 1}, "'slide' mimics 'turn'; give a position of that joint instead"),
        ({"turn": 1, "last": 2.5}, "'last' mimics 'turn'"),
    ],
)
def test_a_position_that_cannot_be_is_refused(positions, words):
    with pytest.raises(ModelError, match=words):
        check_positions(robot(ARM), positions)


def test_a_mimic_joint_may_be_given_where_its_leader_moves_it():
    check_positions(robot(ARM), {"turn": 1, "slide": 2.5, "last": -2.5000001})
    check_positions(robot(ARM), {"slide": 0.5})
