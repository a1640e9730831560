"""Find the links with which a robot rolls, stands and grips."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ...model.attached import find_attached_links
from ...model.elements import Collision, Cylinder, Joint, Link, Robot, Sphere
from ...model.pose import (
    IDENTITY,
    Pose,
    compute_cross,
    compute_dot,
    compute_norm,
    make_pose,
    rotate,
)

_WHEEL = re.compile(r"wheel|(^|_)tire(_|\d|$)", re.IGNORECASE)
_CASTER = re.compile(r"caster|castor", re.IGNORECASE)
_FOOT = re.compile(r"(^|[_\d])(foot|feet|toe)([_\d]|$)", re.IGNORECASE)
_FINGER = re.compile(r"finger|(^|_)(gripper_)?pad(_|\d|$)|(^|_)jaw(_|\d|$)", re.IGNORECASE)
_GRIPS = re.compile(r"finger|thumb|jaw|knuckle|claw|pad(_|\d|$)", re.IGNORECASE)
GRIPPER_PART = re.compile(_GRIPS.pattern + "|grip", re.IGNORECASE)
_NOT_WHEEL = re.compile(
    r"lidar|laser|scan|radar|rotor|prop|fan|thrust|impeller|camera|head|yaw|steer", re.IGNORECASE
)


_FRICTIONS = ("friction", "second_friction", "friction_direction", "slip")
"""Settings of which each shows that the friction of a collision was thought of."""


def get_contact_role(robot: Robot, link: Link) -> str:
    """Get the role of a link in contact: ``wheel``, ``caster``, ``foot``, ``finger`` or empty."""
    if not link.collisions:
        return ""
    joint = robot.tree.get_parent_joint(link.name)
    if joint is None:
        return ""
    if _CASTER.search(link.name):
        turned = any(below.type == "continuous" for below in robot.tree.get_child_joints(link.name))
        return "" if turned else "caster"
    if _is_rolling(robot, link):
        return "wheel"
    leaf = not any(not below.is_fixed for below in robot.tree.get_child_joints(link.name))
    if leaf and _FOOT.search(link.name) and _is_moving(robot, link):
        return "foot"
    if leaf and _FINGER.search(link.name) and _is_gripping(robot, link):
        return "finger"
    return ""


def _is_gripping(robot: Robot, link: Link) -> bool:
    """Tell whether a finger moves, or another finger moves toward it.

    A finger of a gripper without moving joints is a part of the wrist: the joint that moves it has
    an unrelated name, and no finger moves relative to it.
    """
    members = [one for one, _ in find_attached_links(robot, link)]
    for member in members:
        joint = robot.tree.get_parent_joint(member.name)
        if joint is not None and not joint.is_fixed:
            if GRIPPER_PART.search(joint.name) or _GRIPS.search(member.name):
                return True
        for below in robot.tree.get_child_joints(member.name):
            if not below.is_fixed and _GRIPS.search(f"{below.name} {below.child}"):
                return True
    return False


def are_fingers(joints: Sequence[Joint]) -> bool:
    """Tell whether joints are all those of fingers."""
    return bool(joints) and all(
        GRIPPER_PART.search(joint.name) or GRIPPER_PART.search(joint.child) for joint in joints
    )


def is_wheel(robot: Robot, link: Link) -> bool:
    """Tell whether a link, or one that is fixed to it, rolls on the ground."""
    return any(
        get_contact_role(robot, one) == "wheel" for one, _ in find_attached_links(robot, link)
    )


def _is_rolling(robot: Robot, link: Link) -> bool:
    """Tell whether a link is round and turns continuously about a horizontal axis.

    The link may be fixed to the one that the joint moves, as a tire to its hub.
    """
    members = find_attached_links(robot, link)
    hub, pose = next(((one, at) for one, at in members if _is_moved(robot, one)), (link, IDENTITY))
    joint = robot.tree.get_parent_joint(hub.name)
    if joint is None or joint.type != "continuous" or _NOT_WHEEL.search(link.name):
        return False
    if any(
        not below.is_fixed for one, _ in members for below in robot.tree.get_child_joints(one.name)
    ):
        return False
    place = pose.invert()
    is_round = any(_is_round_about(collision, joint, place) for collision in link.collisions)
    if _WHEEL.search(link.name) and (hub is link or is_round or not hub.collisions):
        return True
    return is_round and abs(compute_axis_elevation(robot, hub, joint)) < 0.5


def _is_moved(robot: Robot, link: Link) -> bool:
    """Tell whether a link is the child of a joint that is not fixed."""
    joint = robot.tree.get_parent_joint(link.name)
    return joint is not None and not joint.is_fixed


def _is_round_about(collision: Collision, joint: Joint, place: Pose = IDENTITY) -> bool:
    """Tell whether a shape is a cylinder or sphere with its center on the axis of a joint.

    Args:
        collision: The shape.
        joint: The joint that turns it.
        place: The pose of the shape's link in the frame of the joint's child.
    """
    shape, pose = collision.geometry, place @ make_pose(collision.origin)
    axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    length = compute_norm(axis)
    if not isinstance(shape, Cylinder | Sphere) or not length:
        return False
    if isinstance(shape, Cylinder):
        along = rotate(pose.rotation, (0.0, 0.0, 1.0))
        if abs(compute_dot(along, axis)) < 0.9 * length:
            return False
    return compute_norm(compute_cross(pose.translation, axis)) / length < 0.3 * shape.radius


def compute_axis_elevation(robot: Robot, link: Link, joint: Joint) -> float:
    """Compute the vertical component of a joint's unit axis, with all joints at 0."""
    pose = make_pose(joint.origin)
    for name in robot.tree.list_ancestors(link.name):
        above = robot.tree.get_parent_joint(name)
        pose = (make_pose(above.origin) if above is not None else IDENTITY) @ pose
    axis = joint.axis.xyz if joint.axis is not None else (1.0, 0.0, 0.0)
    return rotate(pose.rotation, axis)[2] / (compute_norm(axis) or 1.0)


def _is_moving(robot: Robot, link: Link) -> bool:
    """Tell whether a moving joint is between a link and the root."""
    names = [link.name, *robot.tree.list_ancestors(link.name)]
    joints = [robot.tree.get_parent_joint(name) for name in names]
    return any(joint is not None and not joint.is_fixed for joint in joints)


def has_friction(link: Link) -> bool:
    """Tell whether the friction of a link is set."""
    surfaces = [link.surface, *(shape.surface for shape in link.collisions)]
    return any(name in surface for surface in surfaces for name in _FRICTIONS)
