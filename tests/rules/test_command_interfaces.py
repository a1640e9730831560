"""What is said of the interfaces that controllers command."""

import pytest

from urdftool import check

ROBOT = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="torque" default="false"/>
  <link name="base"/><link name="tip"/>
  <joint name="elbow" type="revolute">
    <parent link="base"/><child link="tip"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <ros2_control name="arm" type="system">
    <joint name="elbow"><command_interface name="position"/>{more}</joint>
  </ros2_control>
  {plugin}
</robot>"""
PLUGIN = """<gazebo><plugin filename="gz_ros2_control-system" name="gz">
    <parameters>$(find arm)/config/control.yaml</parameters></plugin></gazebo>"""
CONTROLLERS = """arm:
  ros__parameters:
    type: {kind}
    joints: [{joint}]
    command_interfaces: [{interface}]
"""
KIND = "joint_trajectory_controller/JointTrajectoryController"
OPTION = """<xacro:if value="$(arg torque)"><command_interface name="effort"/></xacro:if>"""


@pytest.mark.parametrize(
    ("interface", "joint", "kind", "more", "plugin", "severity"),
    [
        ("position", "elbow", KIND, "", PLUGIN, None),
        ("effort", "elbow", KIND, "", PLUGIN, "error"),
        ("position, effort", "elbow", KIND, "", PLUGIN, "error"),
        ("effort", "elbow", KIND, "", "", "warning"),
        ("effort", "elbow", KIND, OPTION, PLUGIN, None),
        ("effort", "pid/elbow", KIND, "", PLUGIN, None),
        ("effort", "elbow", "vendor/OwnController", "", PLUGIN, None),
    ],
)
def test_the_interface_is_one_of_the_joint(
    write, monkeypatch, tmp_path, interface, joint, kind, more, plugin, severity
):
    monkeypatch.chdir(tmp_path)
    write("package.xml", "<package format='3'><name>arm</name></package>")
    write("urdf/arm.urdf.xacro", ROBOT.format(more=more, plugin=plugin))
    write("config/control.yaml", CONTROLLERS.format(kind=kind, joint=joint, interface=interface))
    rule = "controller-without-interface"
    found = check("urdf/arm.urdf.xacro", select=(rule,), targets=("ros2",))
    assert [finding.severity.label for finding in found] == [severity] * bool(severity)
