"""Links that fixed joints join into one rigid body, with their poses relative to each other.

A body may be written as one link or as several: a hub with its tire, a housing whose mass has a
link of its own. A rule that compares one property of a body with another therefore takes all links
that are rigidly attached, above and below.
"""

from __future__ import annotations

from .elements import Link, Robot
from .pose import IDENTITY, Pose, pose_of
from .world import WORLD

Attached = list[tuple[Link, Pose]]
"""Links with the pose of each in the frame of the first [m]."""


def attached_links(robot: Robot, link: Link) -> Attached:
    """List the links of a rigid body, beginning with one of them.

    Fixed joints are followed upward and downward. The link ``world`` is not a part of a body, and
    bodies that are fixed to it are not parts of each other.

    Args:
        robot: Any robot, also a broken one.
        link: A link of the robot.

    Returns:
        The link itself with the identity, then every link that is rigidly attached to it, with its
        pose in the frame of ``link``.
    """
    found: Attached = [(link, IDENTITY)]
    if link.name == WORLD:
        return found
    tree, seen = robot.tree, {link.name}
    for member, pose in found:  # grows while it is gone through
        above = tree.parent_joint(member.name)
        steps = [
            (joint.child, pose @ pose_of(joint.origin), joint)
            for joint in tree.child_joints(member.name)
        ]
        if above is not None:
            steps.append((above.parent, pose @ pose_of(above.origin).inverse(), above))
        for name, at, joint in steps:
            if joint.is_fixed and name in robot.link and name not in seen and name != WORLD:
                seen.add(name)
                found.append((robot.link[name], at))
    return found


def is_fixed_to_world(robot: Robot, link: Link) -> bool:
    """Whether fixed joints join a link to the link ``world``."""
    name, seen = link.name, set()
    while name != WORLD:
        joint = robot.tree.parent_joint(name)
        if joint is None or not joint.is_fixed or name in seen:
            return False
        seen.add(name)
        name = joint.parent
    return True
