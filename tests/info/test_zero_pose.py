import pytest

from tests.graph.robots import robot, tree
from urdftool.info.counts import count
from urdftool.info.size import measure
from urdftool.info.zero_pose import zero_poses

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
    poses = zero_poses(model)
    assert poses["c"].translation == pytest.approx((1, 1, 0))
    assert poses["c"].transform((1, 0, 0)) == pytest.approx((0, 1, 0))


def test_what_hangs_on_no_root_has_no_pose():
    assert set(zero_poses(tree("abc", [("bc", "b", "c"), ("cb", "c", "b")]))) == {"a"}


def test_the_size_goes_around_turned_primitives():
    model = robot(
        '<robot name="r"><link name="a"/><link name="b"><collision><origin xyz="0 0 1"/><geometry>'
        '<cylinder radius="0.5" length="4"/></geometry></collision></link>'
        '<joint name="j" type="fixed"><parent link="a"/><child link="b"/>'
        '<origin xyz="0 0 3" rpy="0 1.5707963267948966 0"/></joint></robot>'
    )
    bounds = measure(model).bounds
    assert bounds.low == pytest.approx((-1, -0.5, 2.5))
    assert bounds.high == pytest.approx((3, 0.5, 3.5))


def test_a_robot_without_shapes_has_no_size():
    assert measure(tree("ab", [("ab", "a", "b")])).bounds is None


def test_depth_counts_joints():
    chain = tree("abcd", [("ab", "a", "b"), ("bc", "b", "c"), ("ad", "a", "d")])
    assert count(chain).depth == 2
