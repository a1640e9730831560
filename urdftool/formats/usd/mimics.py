"""Joints that follow others: chains end at a joint that follows none, as Newton requires."""

from __future__ import annotations

from ...model.elements import Joint
from ...model.kinematics import follow_mimic_chain
from .joints import JointWriter

_MOVABLE = ("revolute", "continuous", "prismatic")


def write_mimics(writer: JointWriter) -> None:
    """Write each ``<mimic>`` whose follower and leader move; report the others."""
    bodies = writer.bodies
    movable = {j.name: j for j in bodies.joints if j.type in _MOVABLE and bodies.is_movable(j)}
    for joint in bodies.robot.joints:
        if joint.mimic is None:
            continue
        reason = _find_obstacle(joint, movable)
        leader, factor, offset = joint.name, 1.0, 0.0
        if not reason:
            leader, factor, offset = follow_mimic_chain(joint, movable)
            follows = movable[leader].mimic
            if leader == joint.name or (follows is not None and follows.joint in movable):
                reason = "it follows itself"
        if reason:
            writer.written.report_loss(
                "mimic",
                f"<mimic> of joint '{joint.name}' is dropped: {reason}",
                joint.mimic.place,
                kind="joint",
                name=joint.name,
            )
        else:
            writer.write_mimic(joint, leader, factor, offset)


def _find_obstacle(joint: Joint, movable: dict[str, Joint]) -> str:
    """Return why a joint cannot follow its leader; empty if it can."""
    assert joint.mimic is not None
    if joint.name not in movable:
        return f"a joint of type {joint.type} has no position that could follow"
    if not joint.mimic.joint:
        return "it names no joint"
    if joint.mimic.joint not in movable:
        return f"joint '{joint.mimic.joint}' does not exist or has no position"
    return ""
