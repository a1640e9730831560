import pytest

from tests.graph.robots import robot, tree
from urdftool.info.counts import count
from urdftool.info.size import measure


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


def test_a_mimic_joint_with_an_offset_is_where_it_follows_at_the_zero_pose():
    model = robot(
        '<robot name="r"><link name="a"/><link name="b"/><link name="c"><visual>'
        '<origin xyz="0 0 1"/><geometry><box size="0.1 0.1 0.1"/></geometry></visual></link>'
        '<joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
        '<axis xyz="0 1 0"/></joint><joint name="k" type="continuous"><parent link="b"/>'
        '<child link="c"/><axis xyz="0 1 0"/>'
        '<mimic joint="j" offset="1.5707963267948966"/></joint></robot>'
    )
    bounds = measure(model).bounds
    assert bounds.low == pytest.approx((0.95, -0.05, -0.05))
    assert bounds.high == pytest.approx((1.05, 0.05, 0.05))


def test_a_robot_without_shapes_has_no_size():
    assert measure(tree("ab", [("ab", "a", "b")])).bounds is None


def test_depth_counts_joints():
    chain = tree("abcd", [("ab", "a", "b"), ("bc", "b", "c"), ("ad", "a", "d")])
    assert count(chain).depth == 2


def test_shapes_that_the_size_lacks_are_counted():
    model = robot(
        '<robot name="r"><link name="a"><visual><geometry><box size="1 1 1"/></geometry></visual>'
        '<visual><geometry><cone radius="9"/></geometry></visual><collision><geometry>'
        '<mesh filename="missing.stl"/></geometry></collision></link></robot>'
    )
    measured = measure(model)
    assert measured.bounds.size == pytest.approx((1, 1, 1))
    assert measured.left_out == 2
