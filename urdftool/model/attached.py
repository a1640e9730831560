"""Links that fixed joints connect to one rigid body, with their relative poses.

A rigid body may be written as one link or as several: a hub with its tire, a housing whose mass is
in a separate link. A rule that compares two properties of a body therefore needs all links that are
rigidly attached, ancestors and descendants.
"""

from __future__ import annotations

from .elements import Link, Robot
from .pose import IDENTITY, Pose, make_pose
from .world import WORLD

Attached = list[tuple[Link, Pose]]
"""Links with the pose of each in the frame of the first [m]."""


def find_attached_links(robot: Robot, link: Link) -> Attached:
    """Return the links of a rigid body, starting with one of them.

    Fixed joints are followed to parents and children. The link ``world`` is not part of a body;
    bodies fixed to it are not parts of each other.

    Args:
        robot: Any robot, also an invalid one.
        link: A link of the robot.

    Returns:
        The link itself with the identity, then each rigidly attached link with its pose in the
        frame of ``link``.
    """
    found: Attached = [(link, IDENTITY)]
    if link.name == WORLD:
        return found
    tree, seen = robot.tree, {link.name}
    for member, pose in found:  # the loop appends to this list
        above = tree.get_parent_joint(member.name)
        steps = [
            (joint.child, pose @ make_pose(joint.origin), joint)
            for joint in tree.get_child_joints(member.name)
        ]
        if above is not None:
            steps.append((above.parent, pose @ make_pose(above.origin).invert(), above))
        for name, at, joint in steps:
            if joint.is_fixed and name in robot.link and name not in seen and name != WORLD:
                seen.add(name)
                found.append((robot.link[name], at))
    return found


def is_fixed_to_world(robot: Robot, link: Link) -> bool:
    """Tell whether fixed joints connect a link to the link ``world``."""
    name, seen = link.name, set()
    while name != WORLD:
        joint = robot.tree.get_parent_joint(name)
        if joint is None or not joint.is_fixed or name in seen:
            return False
        seen.add(name)
        name = joint.parent
    return True
