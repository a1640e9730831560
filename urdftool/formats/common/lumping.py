"""The lumping plan: which links form one rigid body, and their poses in it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from ...model.elements import Joint, Robot
from ...model.pose import IDENTITY, Pose, make_pose


@dataclass(frozen=True)
class LumpingPlan:
    """Groups of links that fixed joints connect.

    Attributes:
        top: Topmost link of each link's group, by link name.
        members: Links of each group in the order of the tree, the topmost first, by its name.
        pose: Pose of each link in the frame of the topmost link of its group.
    """

    top: dict[str, str]
    members: dict[str, list[str]]
    pose: dict[str, Pose]


def get_pose_of_child(joint: Joint) -> Pose:
    """Return the pose of the child of a fixed joint in its parent."""
    return make_pose(joint.origin)


def plan_lumping(
    robot: Robot,
    links: Iterable[str],
    is_lumped: Callable[[Joint], bool],
    joint_pose: Callable[[Joint], Pose] = get_pose_of_child,
) -> LumpingPlan:
    """Group the links that lumped joints connect.

    Args:
        robot: A robot that is a tree, or several.
        links: Names of the links, parents first; links that are not listed are in no group.
        is_lumped: Returns whether the links of a joint become one body.
        joint_pose: Returns the pose of the child of a lumped joint in its parent.
    """
    plan = LumpingPlan({}, {}, {})
    for name in links:
        joint = robot.tree.get_parent_joint(name)
        if joint is not None and joint.parent in plan.top and is_lumped(joint):
            plan.top[name] = plan.top[joint.parent]
            plan.pose[name] = plan.pose[joint.parent] @ joint_pose(joint)
        else:
            plan.top[name], plan.pose[name] = name, IDENTITY
        plan.members.setdefault(plan.top[name], []).append(name)
    return plan
