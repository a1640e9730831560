"""What is reported of files beside a robot that cannot be parsed."""

import json

import pytest

from urdftool import check

ROBOT = """<robot name="arm">
  <link name="base"/><link name="tip"/>
  <joint name="elbow" type="revolute">
    <parent link="base"/><child link="tip"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <ros2_control name="arm" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
    <joint name="elbow"><command_interface name="position"/></joint>
  </ros2_control>
  <gazebo><plugin filename="gz_ros2_control-system" name="gz">
    <parameters>$(find arm)/config/control.yaml</parameters></plugin></gazebo>
</robot>"""
SRDF = '<robot name="arm"><group name="arm"><joint name="elbow"/></group></robot>'
CONTROLLERS = """controller_manager:
  ros__parameters:
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
arm:
  ros__parameters:
    joints: [elbow]
"""


@pytest.fixture
def lint(write, monkeypatch, tmp_path):
    """Check an arm with files beside it: name, severity and message of each finding."""
    monkeypatch.chdir(tmp_path)

    def run(files, targets=("moveit", "ros2"), rules=("unreadable-configuration",)):
        write("package.xml", "<package><name>arm</name></package>")
        for name, text in {"arm.urdf": ROBOT, "arm.srdf": SRDF, **files}.items():
            write(name, text)
        found = check("arm.urdf", select=rules, targets=targets)
        return [(f.location.path, f.severity.label, f.message) for f in found]

    return run


@pytest.mark.parametrize(
    ("text", "severity", "words"),
    [
        (SRDF.replace("</robot>", "</robt>"), "error", "</robt> closes an element"),
        (SRDF.replace("robot", "robott"), "error", "the root element is <robott>"),
        ("", "error", "is empty"),
        (SRDF.replace("<group", "<!-- a -- b --><group"), "warning", "--"),
    ],
)
def test_an_srdf_that_cannot_be_parsed_is_a_finding(lint, text, severity, words):
    ((path, label, message),) = lint({"arm.srdf": text})
    assert (path, label) == ("arm.srdf", severity)
    assert words in message
    assert lint({"arm.srdf": text}, targets=("ros2",)) == []


def test_an_srdf_of_another_robot_is_none_of_this_one(lint):
    assert lint({"other.srdf": '<robot name="other"><group'}) == []
    assert [path for path, *_ in lint({"arm.srdf": SRDF})] == []


def test_an_srdf_with_a_broken_comment_is_checked(lint):
    text = SRDF.replace("elbow", "ellbow").replace("<group", "<!-- a -- b --><group")
    assert len(lint({"arm.srdf": text}, rules=("srdf-unknown-joint",))) == 1


@pytest.mark.parametrize(
    "name", ["joint_limits", "kinematics", "moveit_controllers", "ros2_controllers"]
)
@pytest.mark.parametrize(
    ("text", "count"),
    [("a:\n\tb: 1\n", 1), ("a: [1\n", 1), ("{% if x %}\na: [\n", 0), ("# nothing\n", 0)],
)
def test_parameters_that_are_no_yaml_are_a_finding(lint, name, text, count):
    found = lint({f"{name}.yaml": text})
    assert [path for path, *_ in found] == [f"{name}.yaml"] * count
    assert all("is not valid YAML" in message for *_, message in found)


def test_a_controller_file_that_a_plugin_names_is_a_finding(lint):
    wrong = CONTROLLERS.replace("[elbow]", "[elbow[")
    assert lint({"config/control.yaml": CONTROLLERS}) == []
    ((path, label, _),) = lint({"config/control.yaml": wrong}, targets=("ros2",))
    assert (path, label) == ("config/control.yaml", "error")
    assert lint({"config/control.yaml": CONTROLLERS, "config/other.yaml": wrong}) == []


@pytest.mark.parametrize(
    "key", ["ros_parameters", "ros__parameter", "ros__params", "ros__parameters", "parameters"]
)
def test_the_parameters_of_a_node_have_the_key_of_ros_2(lint, key):
    text = CONTROLLERS.replace("ros__parameters", key)
    found = lint({"config/control.yaml": text}, targets=("ros2",))
    assert len(found) == (key not in ("ros__parameters", "parameters"))


def test_a_file_that_cannot_be_parsed_counts_as_not_checked(lint, urdftool):
    lint({"arm.srdf": "<robot", "joint_limits.yaml": "{{ limits }\n"})
    done = urdftool("lint", ".", "--target", "moveit", "--format", "json")
    unread = json.loads(done.out)["summary"]["unread_files"]
    assert {one["path"] for one in unread} == {"arm.srdf", "joint_limits.yaml"}
    done = urdftool("lint", ".", "--target", "moveit")
    assert "2 files not checked (targets" in done.err
    assert "2 not checked: arm.srdf, joint_limits.yaml" in done.err
    done = urdftool("lint", ".", "--target", "moveit", "--ignore", "unreadable-configuration")
    assert "not checked: arm.srdf" in done.err
