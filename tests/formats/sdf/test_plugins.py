"""Plugins of Gazebo Classic and what becomes of them."""

import pytest

from urdftool.model.gazebo_plugins import SYSTEM_PLUGINS

from .robots import TWO, export, gazebo, joint, link, rules, tree


def block(filename, inside=""):
    return f'<gazebo><plugin name="p" filename="{filename}">{inside}</plugin></gazebo>'


def plugins(*parts, **choices):
    written = export(*parts, **choices)
    return written, list(tree(written).iter("plugin"))


@pytest.mark.parametrize("name", SYSTEM_PLUGINS)
@pytest.mark.parametrize("version", ["1.9", "1.11"])
def test_every_plugin_of_the_table(name, version):
    written, made = plugins(link("a"), block(f"lib{name}.so"), version=version)
    prefix = "ignition-gazebo" if version == "1.9" else "gz-sim"
    words = [f"{prefix}-{system.word}-system" for system in SYSTEM_PLUGINS[name]]
    assert [e.get("filename") for e in made] == words
    assert set(rules(written)) == {"lossy-plugin"}


DRIVE = (
    "<leftJoint>l</leftJoint><rightJoint>r</rightJoint><wheelSeparation>0.4</wheelSeparation>"
    "<wheelDiameter>0.3</wheelDiameter><wheelTorque>5</wheelTorque><commandTopic>go</commandTopic>"
    "<robotBaseFrame>base</robotBaseFrame><updateRate>20</updateRate>"
)


def test_parameters_are_translated():
    written, (made,) = plugins(link("a"), block("libgazebo_ros_diff_drive.so", DRIVE))
    said = {e.tag: e.text for e in made}
    assert said == {
        "left_joint": "l", "right_joint": "r", "wheel_separation": "0.4", "wheel_radius": "0.15",
        "topic": "go", "odom_topic": "odom", "child_frame_id": "base",
        "odom_publish_frequency": "20",
    }  # fmt: skip
    assert "wheelTorque" in written.losses[0].message


def test_renamed_joints_are_called_by_their_new_names():
    parts = (link("a"), joint("x::l", "a", "b", "continuous", ""), link("b"))
    inside = "<left_joint>x::l</left_joint>"
    _, (made,) = plugins(*parts, block("libgazebo_ros_diff_drive.so", inside))
    assert made.findtext("left_joint") == "x_l"


def test_joints_of_a_list_are_one_each():
    inside = "<jointName>j, k</jointName>"
    _, (made,) = plugins(*TWO, block("libgazebo_ros_joint_state_publisher.so", inside))
    assert [e.text for e in made.findall("joint_name")] == ["j", "k"]


def test_control():
    inside = "<robotNamespace>/r</robotNamespace><parameters>c.yaml</parameters>"
    written, (made,) = plugins(*TWO, block("libgazebo_ros2_control.so", inside))
    assert made.get("name") == "gz_ros2_control::GazeboSimROS2ControlPlugin"
    assert (made.findtext("ros/namespace"), made.findtext("parameters")) == ("/r", "c.yaml")
    assert [x.severity.label for x in written.losses] == ["warning"]


def test_one_without_a_successor_stays_and_is_said():
    written, (made,) = plugins(link("a"), block("libgazebo_ros_vacuum_gripper.so", "<x>1</x>"))
    assert (made.get("filename"), made.findtext("x")) == ("libgazebo_ros_vacuum_gripper.so", "1")
    assert rules(written) == ["lossy-plugin"]


def test_one_of_gz_stays_as_it_is():
    written, (made,) = plugins(link("a"), block("gz-sim-imu-system"))
    assert made.get("filename") == "gz-sim-imu-system"
    assert rules(written) == []
    written, _ = plugins(link("a"), block("gz-sim-imu-system"), target="gazebo-classic")
    assert rules(written) == ["lossy-plugin"]


def test_one_of_a_stranger_stays_without_a_word():
    assert rules(export(link("a"), block("libmine.so"))) == []


def test_classic_keeps_its_own():
    written, (made,) = plugins(
        link("a"), block("libgazebo_ros_diff_drive.so", DRIVE), target="gazebo-classic"
    )
    assert made.findtext("wheelDiameter") == "0.3"
    assert rules(written) == []


def test_the_body_of_a_plugin_and_its_offset_in_classic():
    parts = (link("a"), joint("j", "a", "b", "fixed", origin="1 0 0"), link("b"))
    inside = "<bodyName>b</bodyName><xyzOffset>0 1 0</xyzOffset>"
    _, (made,) = plugins(*parts, block("libp.so", inside), target="gazebo-classic")
    assert made.findtext("bodyName") == "a"
    assert made.findtext("xyzOffset") == "1 1 0"


CONTROL = (
    '<ros2_control name="c" type="system"><hardware><plugin>{}</plugin></hardware>'
    '<joint name="j"><command_interface name="position"/></joint></ros2_control>'
)


def test_ros2_control_says_where_it_is_read():
    written = export(*TWO, CONTROL.format("gazebo_ros2_control/GazeboSystem"))
    assert rules(written) == ["lossy-ros2-control", "lossy-ros2-control"]
    assert "gz_ros2_control/GazeboSimSystem" in written.losses[0].hint
    written = export(
        *TWO,
        CONTROL.format("gz_ros2_control/GazeboSimSystem"),
        block("gz_ros2_control-system"),
    )
    assert [x.severity.label for x in written.losses] == ["info"]


def test_transmissions_are_comments_and_said():
    transmission = (
        '<transmission name="t"><type>transmission_interface/SimpleTransmission</type>'
        '<joint name="j"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>'
        '<actuator name="m"><mechanicalReduction>50</mechanicalReduction></actuator></transmission>'
    )
    written = export(*TWO, transmission)
    assert rules(written) == ["lossy-transmission"]
    assert "mechanicalReduction 50" in written.files["model.sdf"].decode()


def test_a_plugin_for_mimic_is_not_needed():
    follows = '<limit lower="0" upper="1" effort="1" velocity="1"/><mimic joint="j"/>'
    parts = (*TWO, joint("k", "b", "c", inside=follows), link("c"))
    inside = "<joint>j</joint><mimicJoint>k</mimicJoint>"
    name = "libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so"
    _, made = plugins(*parts, block(name, inside))
    assert made == []
    _, made = plugins(*TWO, gazebo("j", ""), block(name, inside))
    assert len(made) == 1
