"""The types of parameters of ros2_control's controllers."""

import pytest

from urdftool import check

ROBOT = """<robot name="cart">
  <link name="base"/><link name="wheel"/>
  <joint name="wheel_joint" type="continuous">
    <parent link="base"/><child link="wheel"/><axis xyz="0 1 0"/>
  </joint>
  <ros2_control name="wheels" type="system"><joint name="wheel_joint"/></ros2_control>
</robot>"""
MANAGER = """controller_manager:
  ros__parameters:
    update_rate: {rate}
    base:
      type: {kind}
base:
  ros__parameters:
    {parameter}
"""
DIFF, JTC = "diff_drive_controller/DiffDriveController", "jtc/JointTrajectoryController"


@pytest.fixture
def lint(write, monkeypatch, tmp_path):
    """Check a cart with a file of controllers; the messages."""
    monkeypatch.chdir(tmp_path)

    def run(parameter, kind=DIFF, rate="100"):
        write("package.xml", "<package format='3'><name>cart_description</name></package>")
        write("urdf/cart.urdf", ROBOT)
        write("config/cart.yaml", MANAGER.format(kind=kind, parameter=parameter, rate=rate))
        found = check("urdf/cart.urdf", select=("controller-parameter-type",), targets=("ros2",))
        return [finding.message for finding in found]

    return run


@pytest.mark.parametrize(
    ("parameter", "kind", "right"),
    [
        ("wheel_radius: 1", DIFF, "must be a double for ROS 2; write 1.0"),
        ("wheel_radius: 1.0", DIFF, None),
        ("wheel_radius: 1e-1", DIFF, None),
        ("wheels_per_side: 2", DIFF, None),
        ("wheels_per_side: 2.0", DIFF, "must be an integer for ROS 2; write 2"),
        ("odom_frame_id: 1", DIFF, None),
        ("linear.x.max_velocity: 1", DIFF, "write 1.0"),
        ("linear: {x: {max_velocity: 1}}", DIFF, "write 1.0"),
        ("pose_covariance_diagonal: [0, 0, 0, 0, 0, 1]", DIFF, "[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]"),
        ("pose_covariance_diagonal: [0.0, 0, 0, 0, 0, 1]", DIFF, None),
        ("gains: {wheel_joint: {p: 100, i: 1.0}}", JTC, "p of 'base' must be a double"),
        ("constraints: {goal_time: 0, wheel_joint: {goal: 0.1}}", JTC, "goal_time"),
        ("cmd_vel_timeout: 500", "tricycle_controller/TricycleController", None),
    ],
)
def test_types_of_parameters(lint, parameter, kind, right):
    found = lint(parameter, kind)
    assert [right in message for message in found] == ([True] if right else [])


def test_the_rate_of_the_manager_is_an_integer(lint):
    assert lint("wheel_radius: 0.1", rate="100.0") == [
        "update_rate of 'controller_manager' must be an integer for ROS 2; write 100"
    ]


def test_no_number_is_rounded_by_the_fix(lint, urdftool, tmp_path):
    assert lint("wheel_radius: 1", rate="99.5")
    urdftool("lint", "urdf/cart.urdf", "--select", "controller-parameter-type", "--fix")
    text = (tmp_path / "config/cart.yaml").read_text()
    assert "update_rate: 99.5" in text
    assert "wheel_radius: 1.0" in text
