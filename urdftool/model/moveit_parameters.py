"""Names in the parameter files of MoveIt 2."""

from __future__ import annotations

MANAGER = "moveit_simple_controller_manager"
"""Section of ``moveit_controllers.yaml`` with the list of controllers."""

ACTIONS = {
    "FollowJointTrajectory": "follow_joint_trajectory",
    "GripperCommand": "gripper_cmd",
    "ParallelGripperCommand": "gripper_cmd",
}
"""Name of the action of a ros2_control controller, by its type in MoveIt."""


def get_action_type(kind: str) -> str:
    """Return the type in MoveIt of the action that a controller class offers; empty if unknown.

    Args:
        kind: Class with its package, such as ``position_controllers/GripperActionController``.
    """
    package, _, name = kind.partition("/")
    if name.endswith("JointTrajectoryController"):
        return "FollowJointTrajectory"
    if name == "GripperActionController":
        parallel = package == "parallel_gripper_action_controller"
        return "ParallelGripperCommand" if parallel else "GripperCommand"
    return ""
