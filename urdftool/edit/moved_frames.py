"""Joints turned round, where the frames of links on the way move to their joints."""

from __future__ import annotations

from collections.abc import Sequence

from ..model.elements import Joint, Link
from ..model.pose import IDENTITY, Pose, make_pose
from .closed_loops import check_loops
from .draft import Draft, is_identity
from .numbers import format_rotation, format_vector
from .positions import negate_axis
from .references import list_gazebo_blocks


def set_links(draft: Draft, joint: Joint, parent: str, child: str) -> None:
    """Write parent and child of a joint."""
    for element, name in ((joint.parent_element, parent), (joint.child_element, child)):
        assert element is not None
        draft.set(element, "link", name)


def turn_with_frames(draft: Draft, path: Sequence[Joint]) -> None:
    """Turn the joints from a new root up to the old one round.

    The old parent of a moving joint gets its frame at the joint: with X of each link, its new frame
    in its old one, the joint from C to P is X(C)⁻¹ M(-a, q) for X(P) = T, its origin before.
    """
    moved: dict[str, Pose] = {}
    for joint in path:
        pose = make_pose(joint.origin)
        before = moved.get(joint.child, IDENTITY).invert()
        if joint.is_fixed:
            before = before @ pose.invert()
        else:
            moved[joint.parent] = pose
            negate_axis(draft, joint)
        set_links(draft, joint, joint.child, joint.parent)
        draft.set_pose(joint.element, joint.origin, before)
    turned = {name: pose for name, pose in moved.items() if not is_identity(pose)}
    check_loops(draft, turned, "whose frame would move")
    for name, pose in moved.items():
        if not is_identity(pose):
            _move_link(draft, draft.robot.link[name], pose, {joint.name for joint in path})


def _move_link(draft: Draft, link: Link, pose: Pose, turned: set[str]) -> None:
    """Write the parts of a link in its new frame."""
    back = pose.invert()
    for part in (link.inertial, *link.visuals, *link.collisions):
        if part is not None:
            draft.set_pose(part.element, part.origin, back @ make_pose(part.origin))
    for joint in draft.robot.tree.get_child_joints(link.name):
        if joint.name not in turned:
            draft.set_pose(joint.element, joint.origin, back @ make_pose(joint.origin))
    for block in list_gazebo_blocks(draft, link.name):
        message = f"<gazebo> of '{link.name}': poses in it are relative to the frame before"
        draft.report("frame", message, block.place)
    xyz, rpy = format_vector(pose.translation), format_rotation(pose.rotation)
    draft.declare("frame", link.name, "xyz", *xyz.split(), "rpy", *rpy.split())
