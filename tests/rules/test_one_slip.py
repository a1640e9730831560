"""Slips that are told as what they are, and robots that look as if they had one."""

import pytest

from urdftool.api.lint import check
from urdftool.errors import SourceError

BOX = '<{0}><origin xyz="{1}"/><geometry><box size="0.1 0.1 0.1"/></geometry></{0}>'


def _link(name, at="0 0 0"):
    return f'<link name="{name}">{BOX.format("collision", at)}</link>'


def _joint(name, parent, child, at="0 0 0", kind="continuous"):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{at}"/><axis xyz="0 1 0"/></joint>'
    )


def _found(tmp_path, inside, rule, name="robot.urdf"):
    path = tmp_path / name
    path.write_text(
        f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{inside}\n</robot>'
    )
    return [finding for finding in check(path) if finding.code == rule]


def test_a_joint_the_wrong_way_round_is_told_as_that(tmp_path):
    links = "".join(map(_link, "abc"))
    joints = _joint("one", "a", "b") + _joint("two", "c", "b")
    (found,) = _found(tmp_path, links + joints, "multiple-parents")
    assert found.message.endswith("; swap parent 'c' and child 'b' if they are reversed")


def test_the_link_that_was_meant_is_asked_for(tmp_path):
    links = "".join(map(_link, "abc"))
    joints = _joint("one", "a", "b") + _joint("two", "a", "b")
    (found,) = _found(tmp_path, links + joints, "multiple-parents")
    assert found.message.endswith("; did you mean 'c', which has no parent joint?")


@pytest.mark.parametrize(("y", "count"), [("0.2", 1), ("-0.2", 0)])
def test_twins_in_one_place_are_no_mirror_images(tmp_path, y, count):
    robot = "".join(map(_link, ("base", "left_leg", "right_leg")))
    robot += _joint("left_hip", "base", "left_leg", "0 0.2 0")
    robot += _joint("right_hip", "base", "right_leg", f"0 {y} 0")
    assert len(_found(tmp_path, robot, "joint-not-mirrored")) == count


def test_fingers_that_start_in_one_place_are_let_pass(tmp_path):
    robot = "".join(map(_link, ("hand", "left_finger", "right_finger")))
    for side in ("left", "right"):
        robot += _joint(f"{side}_slide", "hand", f"{side}_finger", "0 0.1 0.1", "prismatic")
    assert not _found(tmp_path, robot, "joint-not-mirrored")


LOOP = """{links}
<gazebo>
  <joint name="closing" type="revolute">
    <parent>{end}</parent>
    <child>rocker</child>
  </joint>
</gazebo>
<gazebo><plugin name="control" filename="libgazebo_ros_control.so"/></gazebo>
<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
  <joint name="crank_joint">
    <hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface></joint>
  <actuator name="m"/>
</transmission>"""


def _loop(end):
    links = "".join(map(_link, ("world", "crank", "coupler", "rocker")))
    links += _joint("crank_joint", "world", "crank") + _joint("elbow", "crank", "coupler")
    return LOOP.format(links=links + _joint("rocker_joint", "world", "rocker"), end=end)


def test_what_closes_a_loop_has_to_be_there(tmp_path):
    (found,) = _found(tmp_path, _loop("couple"), "dangling-reference")
    assert found.data == {"name": "couple"}
    assert found.message.endswith("; did you mean 'coupler'?")
    assert found.location.line == 4


def test_what_closes_a_loop_may_be_a_link_of_sdf(tmp_path):
    robot = _loop("couple") + '<gazebo><link name="couple"/></gazebo>'
    assert not _found(tmp_path, robot, "dangling-reference")


def test_joints_of_a_closed_loop_need_no_transmission(tmp_path):
    assert not _found(tmp_path, _loop("coupler"), "dangling-reference")
    assert not _found(tmp_path, _loop("coupler"), "actuated-joint-without-transmission")


def test_a_sensor_that_hangs_on_no_link_is_told(tmp_path):
    robot = _link("base") + '<gazebo>\n<sensor name="s" type="camera"/></gazebo>'
    (found,) = _found(tmp_path, robot, "misplaced-extension")
    assert found.data == {"elements": ["sensor"]}


def test_simulated_hardware_of_the_other_gazebo_than_the_plugin(tmp_path):
    robot = """<link name="base"/>
<ros2_control name="c" type="system"><hardware>
<plugin>gazebo_ros2_control/GazeboSystem</plugin></hardware></ros2_control>
<gazebo><plugin filename="gz_ros2_control-system" name="p"/></gazebo>"""
    (found,) = _found(tmp_path, robot, "ros2-control-wrong-sim-plugin")
    assert found.location.line == 3


def test_a_thin_mast_does_not_move_the_centre(tmp_path):
    mast = '<visual><origin xyz="0 0 0.5"/><geometry><box size="0.01 0.01 1"/></geometry></visual>'
    mass = (
        '<inertial><mass value="1"/><inertia ixx="0.002" ixy="0" ixz="0" iyy="0.002" iyz="0" '
        'izz="0.002"/></inertial>'
    )
    robot = f'<link name="base">{mass}{BOX.format("collision", "0 0 0")}{mast}</link>'
    assert not _found(tmp_path, robot, "inertial-not-at-com-suspect")


def test_a_propeller_is_no_wheel(tmp_path):
    round_one = (
        '<link name="thruster_1"><collision><origin rpy="1.5708 0 0"/><geometry>'
        '<cylinder radius="0.1" length="0.02"/></geometry></collision></link>'
    )
    robot = _link("hull") + round_one + _joint("turn", "hull", "thruster_1", "0 0.2 0")
    plugin = '<gazebo><plugin filename="gz-sim-thruster-system" name="t"/></gazebo>'
    assert not _found(tmp_path, robot + plugin, "missing-gazebo-tags")


def test_a_parameter_with_a_name_of_xacro_is_told_once_and_where_it_is_declared(tmp_path):
    robot = """
<xacro:macro name="bar" params="name len">
  <link name="${name}${len}"/>
</xacro:macro>
<xacro:bar name="a" len="1"/>
<xacro:bar name="b" len="2"/>"""
    config = '[lint.severity]\nshadowed-builtin = "info"\n'  # off by default, as an info
    (tmp_path / "urdftool.toml").write_text(config)
    (found,) = _found(tmp_path, robot, "shadowed-builtin", "robot.urdf.xacro")
    assert (found.location.line, found.location.column) == (2, 25)


def test_the_parameter_that_was_meant_is_asked_for(tmp_path):
    robot = """
<xacro:macro name="bar" params="name mirror">
  <link name="${name}${mirror}"/>
</xacro:macro>
<xacro:bar name="a" miror="1"/>"""
    (found,) = _found(tmp_path, robot, "macro-arguments-mismatch", "robot.urdf.xacro")
    assert found.message.endswith("'miror'; did you mean 'mirror'?")


def test_the_argument_that_was_meant_is_asked_for_and_written(tmp_path, urdftool):
    robot = (
        '\n<xacro:arg name="right_gripper" default="true"/>\n<link name="$(arg rigth_gripper)"/>'
    )
    (found,) = _found(tmp_path, robot, "undeclared-arg", "robot.urdf.xacro")
    assert found.message.endswith("; did you mean 'right_gripper'?")
    path = tmp_path / "robot.urdf.xacro"
    urdftool("lint", path, "--fix", "--unsafe-fixes", "--select", "undeclared-arg")
    assert path.read_text().count("$(arg right_gripper)") == 1
    assert path.read_text().count("<xacro:arg") == 1


@pytest.mark.parametrize(("size", "weighed"), [("0.001", 1), ("0.1", 2)])
def test_a_marker_gets_no_mass(tmp_path, urdftool, size, weighed):
    box = f'<geometry><box size="{size} {size} {size}"/></geometry>'
    robot = f'<link name="base"><visual>{box}</visual></link>{_link("arm")}'
    robot += _joint("swing", "base", "arm") + _joint("roll", "arm", "tip")
    robot += '<link name="tip"><inertial><mass value="1"/></inertial></link>'
    assert len(_found(tmp_path, robot, "missing-inertial")) == 2
    path = tmp_path / "robot.urdf"
    urdftool("lint", path, "--fix", "--unsafe-fixes", "--select", "missing-inertial")
    assert path.read_text().count("<inertial>") == weighed + 1


def test_an_srdf_is_sent_to_its_robot(tmp_path):
    path = tmp_path / "arm.srdf"
    path.write_text('<robot name="arm"><group name="all"><joint name="a"/></group></robot>')
    with pytest.raises(SourceError, match="is an SRDF, which is checked"):
        check(path)
