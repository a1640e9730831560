"""Where each link is when every joint is at zero."""

from __future__ import annotations

from ..model.elements import Robot
from ..model.pose import IDENTITY, Pose, pose_of


def zero_poses(robot: Robot) -> dict[str, Pose]:
    """The pose of each link in the frame of its root, by name.

    Each root stands in the same place; a link that hangs on none has no pose.
    """
    poses: dict[str, Pose] = {}
    for name in robot.tree.order:
        joint = robot.tree.parent_joint(name)
        if joint is None:
            poses[name] = IDENTITY
        elif joint.parent in poses:
            poses[name] = poses[joint.parent] @ pose_of(joint.origin)
    return poses
