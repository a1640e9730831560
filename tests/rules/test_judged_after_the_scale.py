"""Kinds of findings that readers judged as noise, or missed, beside those that remain."""

import pytest

from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

MASS = '<inertial><mass value="1"/><inertia ixx="{}" ixy="0" ixz="0" iyy="{}" iyz="0" izz="{}"/>'
HEAVY = MASS.format(0.01, 0.01, 0.01) + "</inertial>"
JOINT = (
    '<joint name="to_{1}" type="{2}"><parent link="{0}"/><child link="{1}"/>'
    '<origin xyz="0 0 0.1"/><axis xyz="0 0 1"/>{3}</joint>'
)
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def find(tmp_path, text, rule, name="r.urdf", **settings):
    """Find the findings of a rule that are on by default."""
    path = tmp_path / name
    path.write_text(text)
    return [f for f in check_file(path, Options(Settings(**settings))).findings if f.code == rule]


def shape(tag, size, at="0 0 0"):
    """Write a visual or collision: a box."""
    return f'<{tag}><origin xyz="{at}"/><geometry><box size="{size}"/></geometry></{tag}>'


@pytest.mark.parametrize(("at", "count"), [("0 0 -0.1", 0), ("0 0.3 0", 1)])
def test_the_housing_of_a_joint_may_belong_to_the_link_above(tmp_path, at, count):
    upper = shape("visual", "0.1 0.1 0.5", "0 0 -0.1") + shape("collision", "0.1 0.1 0.5")
    lower = shape("visual", "0.1 0.1 0.1") + shape("collision", "0.1 0.4 0.3", at)
    if not count:
        lower = shape("visual", "0.1 0.1 0.1") + shape("collision", "0.1 0.1 0.3", at)
    text = f'<link name="a">{HEAVY}{upper}</link><link name="b">{HEAVY}{lower}</link>'
    text = f'<robot name="r">{text}{JOINT.format("a", "b", "revolute", LIMIT)}</robot>'
    assert len(find(tmp_path, text, "collision-much-larger-than-visual")) == count


@pytest.mark.parametrize(
    ("six", "exchanged"), [((0.0834, 0.0834, 0.0017), "x and z"), ((9, 9, 9), "")]
)
def test_a_tensor_that_fits_with_two_axes_exchanged_says_so(tmp_path, six, exchanged):
    """A rod of 1 m along x with the tensor of one along z."""
    base = f'<link name="a">{HEAVY}</link>'
    rod = shape("visual", "1 0.1 0.1") + shape("collision", "1 0.1 0.1")
    rod = f'<link name="b">{MASS.format(*six)}</inertial>{rod}</link>'
    text = f'<robot name="r">{base}{rod}{JOINT.format("a", "b", "revolute", LIMIT)}</robot>'
    (found,) = find(tmp_path, text, "inertia-exceeds-geometry")
    assert found.data["exchanged"] == exchanged
    assert (f"with the axes {exchanged} exchanged" in found.message) == bool(exchanged)


def test_bounds_of_a_continuous_joint_that_mimics_another_are_off(tmp_path):
    mimic = LIMIT + '<mimic joint="to_b"/>'
    links = "".join(f'<link name="{name}">{HEAVY}</link>' for name in "abc")
    text = f'<robot name="r">{links}{JOINT.format("a", "b", "continuous", LIMIT)}'
    text += JOINT.format("a", "c", "continuous", mimic) + "</robot>"
    assert [f.name for f in find(tmp_path, text, "continuous-with-bounds")] == ["to_b"]


@pytest.mark.parametrize(("name", "count"), [("r.urdf", 0), ("r.urdf.xacro", 1)])
def test_an_argument_that_xacro_left_in_a_urdf_is_off(tmp_path, name, count):
    xacro = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    text = f'<robot name="r" {xacro}><xacro:arg name="n" default="1"/><link name="a"/></robot>'
    assert len(find(tmp_path, text, "unused-arg", name)) == count


def test_the_path_of_a_robot_as_foam_writes_it_is_no_finding(tmp_path):
    text = '<robot name="r" path="/home/me/r.urdf"><link name="a"/></robot>'
    assert not find(tmp_path, text, "unknown-attribute")
    assert find(tmp_path, text.replace("path", "pathh"), "unknown-attribute")


@pytest.mark.parametrize("value", ["{pi}", "{-pi}"])
def test_braces_without_a_dollar_are_an_expression(tmp_path, value):
    param = f'<joint name="to_b"><param name="m">{value}</param></joint>'
    text = f'<robot name="r"><ros2_control name="c" type="system">{param}</ros2_control>'
    text += f'<link name="a">{HEAVY}</link><link name="b">{HEAVY}</link>'
    text += JOINT.format("a", "b", "revolute", LIMIT) + "</robot>"
    assert find(tmp_path, text, "unexpanded-expression")


def test_a_path_is_no_hardware_interface(tmp_path):
    joint = '<joint name="to_b"><hardwareInterface>{}</hardwareInterface></joint>'
    text = '<robot name="r"><transmission name="t"><type>transmission_interface/SimpleTransmission'
    text += f"</type>{joint}</transmission>"
    text += f'<link name="a">{HEAVY}</link><link name="b">{HEAVY}</link>'
    text += JOINT.format("a", "b", "revolute", LIMIT) + "</robot>"
    ros = {"targets": frozenset({"ros1"})}
    rule = "unknown-hardware-interface"
    assert find(tmp_path, text.format(r"D:\me\hardware_interface"), rule, **ros)
    assert not find(tmp_path, text.format("my_package/MyInterface"), rule, **ros)
