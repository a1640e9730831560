"""What is reported of the YAML files of a MoveIt configuration."""

import pytest

from urdftool import check

ROBOT = """<robot name="arm">
  <link name="base"/><link name="tip"/>
  <joint name="elbow" type="revolute">
    <parent link="base"/><child link="tip"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>"""
SRDF = '<robot name="arm"><group name="arm"><joint name="elbow"/></group></robot>'
LIMITS = """joint_limits:
  elbow:
    has_velocity_limits: {on}
    max_velocity: {velocity}
    has_acceleration_limits: true
    max_acceleration: 1.0
    max_position: {position}
  ghost:
    has_velocity_limits: true
    max_velocity: 2
"""
MANAGER = """moveit_simple_controller_manager:
  controller_names: [{names}]
  arm_controller:
    {rest}
"""
WHOLE = "{type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [elbow]}"


@pytest.fixture
def lint(write, monkeypatch, tmp_path):
    """Check an arm with a YAML file next to its SRDF; the messages."""
    monkeypatch.chdir(tmp_path)

    def run(rule, targets=("moveit", "ros2"), **files):
        write("arm.urdf", ROBOT)
        write("arm.srdf", SRDF)
        for name, text in files.items():
            write(f"{name}.yaml", text)
        return [f.message for f in check("arm.urdf", select=(rule,), targets=targets)]

    return run


@pytest.mark.parametrize(
    ("velocity", "on", "position", "right"),
    [
        ("2", "true", "1.5", "write 2.0"),
        ("-3", "true", "1.5", "write -3.0"),
        ("2", "false", "1.5", None),
        ("2.", "true", "1.5", None),
        ("!!float 2", "true", "1.5", None),
        ("1e3", "true", "1.5", "reads as text; write 1000.0"),
        ("1e-7", "true", "1.5", "write 1.0e-07"),
        ("'2.0'", "true", "1.5", "reads as text; write 2.0"),
        ("inf", "true", "1.5", "write a number with a point"),
        ("fast", "true", "1.5", "write a number with a point"),
        ("2.0", "true", "1", "max_position of joint 'elbow' is '1'"),
    ],
)
def test_numbers_that_are_no_doubles(lint, velocity, on, position, right):
    limits = LIMITS.format(velocity=velocity, on=on, position=position)
    found = lint("moveit-parameter-type", joint_limits=limits)
    assert [right in message for message in found] == ([True] if right else [])


def test_several_of_a_file_are_one_finding(lint):
    found = lint(
        "moveit-parameter-type",
        joint_limits=LIMITS.format(velocity="2", on="true", position="1"),
    )
    assert len(found) == 1
    assert "the same applies to max_position of joint 'elbow'" in found[0]


def test_solvers_and_cartesian_limits(lint):
    found = lint(
        "moveit-parameter-type",
        kinematics="arm: {kinematics_solver_timeout: 5e-3, kinematics_solver_attempts: 3}\n",
        pilz_cartesian_limits="cartesian_limits: {max_trans_vel: 1, max_rot_vel: 1.57}\n",
    )
    assert found == [
        "kinematics_solver_timeout of group 'arm' is '5e-3', which YAML reads as text; write 0.005",
        "max_trans_vel of cartesian_limits is '1', which YAML reads as an integer; write 1.0",
    ]


def test_ros_1_converts_integers(lint):
    limits = LIMITS.format(velocity="2", on="true", position="1")
    rule = "moveit-parameter-type"
    assert lint(rule, targets=("moveit", "ros1"), joint_limits=limits) == []
    assert lint(rule, targets=("moveit",), joint_limits=limits)


@pytest.mark.parametrize(
    ("rest", "names", "what"),
    [
        (WHOLE, "arm_controller", None),
        (WHOLE.replace("action_ns: follow_joint_trajectory, ", ""), "arm_controller", "action_ns"),
        (WHOLE.replace("follow_joint_trajectory", "''"), "arm_controller", None),
        (WHOLE.replace("type: FollowJointTrajectory, ", ""), "arm_controller", "has no type"),
        (WHOLE.replace("[elbow]", "[]"), "arm_controller", "has no joints"),
        (WHOLE.replace("Trajectory,", "Trajectroy,"), "arm_controller", "'FollowJointTrajectory'?"),
        (WHOLE, "arm_controler", "did you mean 'arm_controller'?"),
    ],
)
def test_controllers_that_moveit_leaves_out(lint, rest, names, what):
    found = lint(
        "moveit-controller-incomplete", moveit_controllers=MANAGER.format(rest=rest, names=names)
    )
    assert [what in message for message in found] == ([True] if what else [])


def test_a_joint_of_a_controller_is_asked_for(lint):
    yaml = MANAGER.format(rest=WHOLE.replace("[elbow]", "[elbwo]"), names="arm_controller")
    (message,) = lint("moveit-controller-unknown-joint", moveit_controllers=yaml)
    assert "did you mean 'elbow'?" in message


def test_nothing_is_reported_without_an_srdf(lint, tmp_path):
    limits = LIMITS.format(velocity="2", on="true", position="1")
    assert lint("moveit-parameter-type", joint_limits=limits)
    (tmp_path / "arm.srdf").unlink()
    found = check("arm.urdf", select=("moveit-parameter-type",), targets=("moveit", "ros2"))
    assert found == []


def test_an_action_is_written_into_braces(lint, urdftool, tmp_path):
    rest = WHOLE.replace("action_ns: follow_joint_trajectory, ", "")
    yaml = MANAGER.format(rest=rest, names="arm_controller")
    whole = "{action_ns: follow_joint_trajectory, type: FollowJointTrajectory, joints: [elbow]}"
    rule = "moveit-controller-incomplete"
    assert lint(rule, moveit_controllers=yaml)
    urdftool("lint", "arm.urdf", "--select", rule, "--target", "moveit", "--fix", "--unsafe-fixes")
    text = (tmp_path / "moveit_controllers.yaml").read_text().strip()
    assert text == MANAGER.format(rest=whole, names="arm_controller").strip()
    assert lint(rule, moveit_controllers=text) == []


SOLVER = "{name}: {{kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin}}\n"


@pytest.mark.parametrize(
    ("files", "words"),
    [
        ({"kinematics": SOLVER.format(name="arm")}, []),
        ({"kinematics": SOLVER.format(name="amr")}, ["group 'amr', which the SRDF does not have"]),
        ({"kinematics": SOLVER.format(name="elbow")}, ["group 'elbow'"]),
        ({"kinematics": "/**:\n  ros__parameters: {a: {b: 1}}\n"}, []),
        ({"joint_limits": "joint_limits: {elbow: {max_velocity: 1.0}}"}, []),
        ({"joint_limits": "joint_limits: {elbwo: {max_velocity: 1.0}}"}, ["did you mean 'elbow'"]),
        ({"joint_limits": "default_velocity_scaling_factor: 0.1"}, []),
        ({"joint_limits": "- 1"}, []),
    ],
)
def test_unknown_name(lint, files, words):
    found = lint("moveit-unknown-name", **files)
    assert len(found) == len(words)
    assert all(word in message for word, message in zip(words, found, strict=True))


CONTROLLERS = """controller_manager:
  ros__parameters:
    arm_controller: {{type: {kind}}}
"""


@pytest.mark.parametrize(
    ("kind", "action", "words"),
    [
        ("joint_trajectory_controller/JointTrajectoryController", "FollowJointTrajectory", ""),
        (
            "joint_trajectory_controller/JointTrajectoryController",
            "GripperCommand",
            "write FollowJointTrajectory",
        ),
        ("position_controllers/GripperActionController", "GripperCommand", ""),
        (
            "parallel_gripper_action_controller/GripperActionController",
            "GripperCommand",
            "write ParallelGripperCommand",
        ),
        ("ur_controllers/ScaledJointTrajectoryController", "FollowJointTrajectory", ""),
        ("mine/Other", "GripperCommand", ""),
    ],
)
def test_type_of_a_controller(lint, kind, action, words):
    rest = f"type: {action}\n    joints: [elbow]"
    section = MANAGER.format(names="arm_controller", rest=rest)
    found = lint(
        "moveit-controller-mismatch",
        moveit_controllers=section,
        ros2_controllers=CONTROLLERS.format(kind=kind),
    )
    assert [words in message for message in found] == ([True] if words else [])


def test_controller_without_configuration(lint):
    section = MANAGER.format(names="arm_controler", rest="joints: [elbow]")
    kind = "joint_trajectory_controller/JointTrajectoryController"
    (message,) = lint(
        "moveit-controller-mismatch",
        moveit_controllers=section,
        ros2_controllers=CONTROLLERS.format(kind=kind),
    )
    assert message == (
        "MoveIt controller 'arm_controler' is not in ros2_controllers.yaml; "
        "did you mean 'arm_controller'?"
    )


ROS2 = """controller_manager:
  ros__parameters:
    arm_controller: {{type: {kind}}}
arm_controller:
  ros__parameters:
    joints: [{joints}]
    {more}
"""
TRAJECTORY = "joint_trajectory_controller/JointTrajectoryController"


@pytest.mark.parametrize(
    ("mine", "its", "more", "words"),
    [
        ("elbow", "elbow", "", None),
        ("elbow", "elbow, wrist", "", "does not send wrist"),
        ("elbow", "elbow, wrist", "allow_partial_joints_goal: true", None),
        ("elbow, wrist", "elbow", "", "sends wrist"),
        ("elbow, wrist", "elbow", "allow_partial_joints_goal: true", "sends wrist"),
        ("elbow", "$(var prefix)elbow", "", None),
    ],
)
def test_joints_of_both_controllers_are_the_same(lint, mine, its, more, words):
    section = WHOLE.replace("[elbow]", f"[{mine}]")
    found = lint(
        "moveit-controller-mismatch",
        moveit_controllers=MANAGER.format(names="arm_controller", rest=section).replace(
            "arm_controller:\n    {", "arm_controller: {"
        ),
        ros2_controllers=ROS2.format(kind=TRAJECTORY, joints=its, more=more),
    )
    assert len(found) == (words is not None)
    assert all(words in message for message in found)


@pytest.mark.parametrize(
    ("kind", "action", "right"),
    [
        (TRAJECTORY, "follow_joint_trajectory", None),
        (TRAJECTORY, "/follow_joint_trajectory", None),
        (TRAJECTORY, "follow_joint_traj", "write follow_joint_trajectory"),
        ("vendor_controllers/OwnController", "own_action", None),
    ],
)
def test_the_action_is_that_of_the_class(lint, kind, action, right):
    section = WHOLE.replace("follow_joint_trajectory", action)
    found = lint(
        "moveit-controller-mismatch",
        moveit_controllers=MANAGER.format(names="arm_controller", rest=section).replace(
            "arm_controller:\n    {", "arm_controller: {"
        ),
        ros2_controllers=ROS2.format(kind=kind, joints="elbow", more=""),
    )
    assert len(found) == (right is not None)
    assert all(right in message for message in found)
