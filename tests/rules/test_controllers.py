"""Which files of controllers are for a robot, and what is said of the joints in them."""

import os

import pytest

from urdftool import check

ROBOT = """<robot name="cart"{namespace}>{more}
  <link name="base"/>
  <link name="left_wheel"/>
  <joint name="left_wheel_joint" type="continuous">
    <parent link="base"/><child link="left_wheel"/><axis xyz="0 1 0"/>
  </joint>
  <link name="right_wheel"/>
  <joint name="right_wheel_joint" type="continuous">
    <parent link="base"/><child link="right_wheel"/><axis xyz="0 1 0"/>
  </joint>
  <link name="mast"/>
  <joint name="mast_joint" type="fixed"><parent link="base"/><child link="mast"/></joint>
  <ros2_control name="wheels" type="system">
    <joint name="left_wheel_joint"/><joint name="right_wheel_joint"/>
  </ros2_control>
  {plugin}
</robot>"""
PLUGIN = """<gazebo><plugin name="control" filename="gz_ros2_control-system">
    <parameters>{path}</parameters></plugin></gazebo>"""
BY_FIND = PLUGIN.format(path="$(find cart_description)/config/cart.yaml")
XACRO = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'
CONTROLLER = """base:
  ros__parameters:
    type: diff_drive_controller/DiffDriveController
    left_wheel_names: [{0}]
    right_wheel_names: ["{1}"]
"""
ARM = """arm:
  ros__parameters:
    type: joint_trajectory_controller/JointTrajectoryController
    joints: [elbow, wrist]
"""
PACKAGE = "<package format='3'><name>cart_description</name></package>"


@pytest.fixture
def lint(write, monkeypatch, tmp_path):
    """Lint a cart with a file of controllers beside it, and files of its package."""
    monkeypatch.chdir(tmp_path)

    def run(yaml, files=(), path="urdf/cart.urdf.xacro", namespace="", more="", plugin=BY_FIND):
        write("package.xml", PACKAGE)
        write("config/cart.yaml", yaml)
        for name, text in dict(files).items():
            write(name, text)
        if path.endswith(".xacro"):
            namespace = XACRO
        write(path, ROBOT.format(namespace=namespace, more=more, plugin=plugin))
        return check(path, select=("controller-unknown-joint",), targets=("ros2",))

    return run


@pytest.mark.parametrize(
    ("wrong", "meant"),
    [
        ("left_weel_joint", "left_wheel_joint"),
        ("wheel_left_joint", "left_wheel_joint"),
        ("LeftWheelJoint", "left_wheel_joint"),
        ("left_wheel", "left_wheel_joint"),
    ],
)
@pytest.mark.parametrize("plugin", [BY_FIND, ""], ids=["named", "the only robot"])
def test_the_joint_that_was_meant_is_asked_for_at_its_place(lint, wrong, meant, plugin):
    (finding,) = lint(CONTROLLER.format(wrong, "right_wheel_joint"), plugin=plugin)
    assert finding.data == {"joint": wrong, "suggestion": meant}
    assert str(finding.location) == "config/cart.yaml:4:24"


def test_a_joint_without_a_like_is_told_where_the_controller_has_others(lint):
    (finding,) = lint(CONTROLLER.format("elbow", "right_wheel_joint"))
    assert finding.data == {"joint": "elbow", "suggestion": ""}


def test_a_joint_that_is_fixed_is_told(lint):
    (finding,) = lint(CONTROLLER.format("mast_joint", "right_wheel_joint"))
    assert "'mast_joint' is fixed" in finding.message


def test_joints_of_all_kinds_of_parameters_are_looked_at(lint):
    yaml = """/cart:
  one: {type: "effort_controllers/JointPositionController", joint: left_weel_joint}
  two: {type: joint_state_controller/JointStateController, joints: [mast_joint]}
  three: {type: velocity_controllers/JointGroupVelocityController, joints: [pid/left_weel_joint]}
  four: {type: joint, joints: [left_weel_joint]}
"""
    found = lint(yaml)
    assert [(f.location.line, f.name) for f in found] == [(2, "cart"), (4, "cart")]


GRIPPER = '<robot name="{}"><link name="a"/><joint name="{}" type="fixed"/></robot>'
LAUNCH = "Node(x='cart.urdf.xacro', y='cart.yaml')"


def test_a_launch_file_that_names_both_makes_it_sure(lint):
    yaml = CONTROLLER.format("elbow", "right_wheel_joint")
    assert lint(yaml, plugin="") == []
    assert len(lint(yaml, {"launch/a.launch.py": LAUNCH}, plugin="")) == 1


@pytest.mark.parametrize(
    ("what", "yaml", "extra"),
    [
        ("right", CONTROLLER.format("left_wheel_joint", "right_wheel_joint"), {}),
        (
            "a placeholder",
            CONTROLLER.format('"$(var prefix)left_whel_joint"', "right_wheel_joint"),
            {},
        ),
        ("no controllers", "left_wheel_names: [left_weel_joint]", {}),
        ("not YAML", "a: [type: x/y", {}),
        (
            "another robot's, by its name",
            CONTROLLER.format("left_weel_joint", "right_wheel_joint"),
            {"files": {"urdf/other.urdf": GRIPPER.format("other", "left_weel_joint")}},
        ),
        (
            "of one of two robots",
            CONTROLLER.format("left_weel_joint", "right_wheel_joint"),
            {"files": {"urdf/other.urdf": GRIPPER.format("other", "x")}, "plugin": ""},
        ),
        (
            "of an arm that an argument takes away",
            CONTROLLER.format("left_wheel_joint", "right_wheel_joint") + ARM,
            {"more": '<xacro:if value="0"><xacro:arm/></xacro:if>'},
        ),
        (
            "of a joint that an argument takes away",
            CONTROLLER.format("pole", "right_wheel_joint"),
            {"more": '<xacro:if value="0"><joint name="pole"/></xacro:if>'},
        ),
        (
            "with the prefix of a launch file",
            CONTROLLER.format("my_left_wheel_joint", "my_right_wheel_joint"),
            {"more": '<xacro:arg name="prefix" default=""/>'},
        ),
    ],
    ids=lambda value: value if isinstance(value, str) and "\n" not in value else "",
)
def test_nothing_is_said_of_a_file(lint, what, yaml, extra):
    assert lint(yaml, **extra) == []


def test_a_file_for_two_robots_tells_slips_only(lint):
    other = {"urdf/other.urdf.xacro": f'<robot name="o"{XACRO}><link name="a"/>cart.yaml</robot>'}
    assert lint(CONTROLLER.format("elbow", "right_wheel_joint"), other) == []
    assert len(lint(CONTROLLER.format("left_weel_joint", "right_wheel_joint"), other)) == 1


def test_what_is_no_file_is_passed_over(lint, tmp_path):
    for folder in ("config", "urdf", "launch"):
        (tmp_path / folder).mkdir(exist_ok=True)
        os.mkfifo(tmp_path / folder / "pipe.yaml")
        os.mkfifo(tmp_path / folder / "pipe.urdf")
    assert len(lint(CONTROLLER.format("left_weel_joint", "right_wheel_joint"), plugin="")) == 1
