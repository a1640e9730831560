"""The pose of the base in the description, and the links in a frame whose z axis points up."""

from __future__ import annotations

from collections.abc import Mapping

from ...model.elements import Origin, Robot, Vector
from ...model.kinematics import link_poses
from ...model.pose import Pose, make_pose
from ...model.read import parse_numbers


def get_robot_origin(robot: Robot) -> Origin | None:
    """Return the pose of the root in the world; ``<origin>`` of ``<robot>`` in URDF."""
    if robot.base is not None:
        return robot.base.origin
    element = robot.find_child_xml("origin")
    if element is None:
        return None
    zero: Vector = (0.0, 0.0, 0.0)
    xyz, rpy = parse_numbers(element.get("xyz"), 3), parse_numbers(element.get("rpy"), 3)
    return Origin(
        element,
        zero if xyz is None else (xyz[0], xyz[1], xyz[2]),
        zero if rpy is None else (rpy[0], rpy[1], rpy[2]),
    )


def compute_level_poses(robot: Robot, positions: Mapping[str, float]) -> dict[str, Pose]:
    """Compute the poses of the links in a frame at the root that is turned as the world."""
    poses = link_poses(robot, positions)
    origin = get_robot_origin(robot)
    if origin is None or not any(origin.rpy):
        return poses
    turn = Pose(make_pose(origin).rotation)
    return {name: turn @ pose for name, pose in poses.items()}
