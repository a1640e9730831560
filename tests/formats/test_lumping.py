"""The lumping plan: which links are one body, and where they are in it."""

import pytest

import urdftool
from urdftool.formats.common.lumping import plan_lumping

JOINT = (
    '<joint name="{2}" type="{3}"><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>'
    '<parent link="{0}"/><child link="{1}"/><axis xyz="0 0 1"/></joint>'
)


@pytest.fixture
def robot(write):
    joints = [
        JOINT.format("a", "b", "ab", "fixed"),
        JOINT.format("b", "c", "bc", "fixed"),
        JOINT.format("c", "d", "cd", "continuous"),
        JOINT.format("d", "e", "de", "fixed"),
    ]
    links = "".join(f'<link name="{name}"/>' for name in "abcde")
    return urdftool.load(write("r.urdf", f'<robot name="r">{links}{"".join(joints)}</robot>'))


def test_links_of_fixed_joints_are_one_group(robot):
    plan = plan_lumping(robot, robot.tree.order, lambda joint: joint.is_fixed)
    assert plan.top == {"a": "a", "b": "a", "c": "a", "d": "d", "e": "d"}
    assert plan.members == {"a": ["a", "b", "c"], "d": ["d", "e"]}


def test_poses_are_in_the_topmost_link(robot):
    plan = plan_lumping(robot, robot.tree.order, lambda joint: joint.is_fixed)
    assert plan.pose["a"].translation == (0, 0, 0)
    assert plan.pose["c"].translation == pytest.approx((1, 1, 0))
    assert plan.pose["e"].translation == pytest.approx((1, 0, 0))


def test_a_joint_that_is_not_lumped_begins_a_group(robot):
    plan = plan_lumping(robot, robot.tree.order, lambda joint: joint.name != "bc")
    assert plan.members == {"a": ["a", "b"], "c": ["c", "d", "e"]}


def test_links_that_are_left_out_have_no_group(robot):
    plan = plan_lumping(robot, "bcde", lambda joint: joint.is_fixed)
    assert plan.members == {"b": ["b", "c"], "d": ["d", "e"]}
