"""xacro arguments of the command line that no description declares."""

import pytest

ROBOT = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{}'
    '<link name="$(arg prefix)base"/></robot>'
)
DECLARED = ROBOT.format('<xacro:arg name="prefix" default=""/>')


@pytest.mark.parametrize(
    ("given", "warning"),
    [
        ("prefix:=a", ""),
        ("prefx:=a", "no <xacro:arg> declares 'prefx', so prefx:=… has no effect; did you mean"),
        ("speed:=1", "has no effect; declared: prefix"),
    ],
)
def test_an_argument_without_effect_is_reported(urdftool, write, given, warning):
    path = write("r.urdf.xacro", DECLARED)
    for _ in range(2):  # the second time from the cache
        result = urdftool("lint", path, given)
        assert ("xacro:arg" in result.err) == bool(warning)
        assert warning in result.err


def test_an_argument_of_one_of_several_robots_is_not_reported(urdftool, write):
    path = write("r.urdf.xacro", DECLARED)
    other = write("s.urdf", '<robot name="s"><link name="a"/></robot>')
    assert "xacro:arg" not in urdftool("lint", path, other, "prefix:=a").err
    assert urdftool("lint", path, other, "speed:=a").err.count("declares 'speed'") == 1


def test_nothing_is_said_of_a_robot_that_was_not_expanded(urdftool, write):
    path = write("r.urdf.xacro", ROBOT.format("<xacro:include filename='none.xacro'/>"))
    result = urdftool("lint", path, "speed:=1")
    assert result.code == 2
    assert "declares 'speed'" not in result.err
