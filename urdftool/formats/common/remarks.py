"""What a description writes and its robot does not hold, as losses of an export."""

from __future__ import annotations

from ...model.elements import Joint, Robot
from ...model.settings import LOST_SETTINGS, RESISTANCE_OF_URDF
from ..reading import find_remarks
from ..written import Written

NEGATIVE = "negative-dynamics"
"""Rule of ``lint``, and code of the loss, of damping or friction below zero."""


def add_remarks(robot: Robot, written: Written) -> None:
    """Add the remarks on a source that the writer does not report itself, by their place."""
    known = {(loss.location.path, loss.location.start) for loss in written.losses}
    for finding in find_remarks(robot):
        if (finding.location.path, finding.location.start) not in known:
            written.losses.append(finding)
    known_joints = {loss.name for loss in written.losses if loss.code == f"lossy-{NEGATIVE}"}
    for joint in robot.joints:
        if joint.name not in known_joints and not joint.is_fixed:
            report_negative_dynamics(joint, "which adds energy to the joint", written)


def report_negative_dynamics(joint: Joint, remark: str, written: Written) -> None:
    """Report negative damping or friction of a joint, with a remark on what the export does."""
    values = {name: getattr(joint.dynamics, name, None) or 0.0 for name in RESISTANCE_OF_URDF}
    negative = {name: value for name, value in values.items() if value < 0}
    if negative and joint.dynamics is not None:
        text = " and ".join(f"{name} {value:g}" for name, value in negative.items())
        written.report_loss(
            NEGATIVE,
            f"joint '{joint.name}' has {text}, {remark}",
            joint.dynamics.place,
            kind="joint",
            name=joint.name,
            data={LOST_SETTINGS: list(negative)},
        )
