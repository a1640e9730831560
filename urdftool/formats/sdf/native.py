"""Elements that an export of an SDF copies: sensors, plugins, lights and others."""

from __future__ import annotations

from dataclasses import replace

from ...diagnostic import Severity
from ...model.elements import Robot
from ...model.mechanism import NativeElement
from ...model.pose import IDENTITY, Pose, rotation_from_rpy
from ...model.provenance import Written as Source
from ...model.sensors import get_kind
from ..common.naming import get_free_name
from ..common.unexpressed import report_unexpressed
from ..written import Written
from .pose import set_pose
from .translation import Translation
from .xml import Node, append_copy

_UNREAD = (*("light", "projector", "particle_emitter", "battery", "audio_source", "gripper"),)
"""Codes of what the reader leaves out and an export copies."""


def report_uncopied(robot: Robot, written: Written) -> None:
    """Report what the reader left out, and parts that no element of the export has."""
    expressed: tuple[str, ...] = ("base", "joint-spring")
    if robot.format == "sdf":
        expressed = (*expressed, "camera", "sensor", "plugin")
        codes = {f"unread-{code}" for code in _UNREAD}
        robot = replace(robot, unread=[loss for loss in robot.unread if loss.code not in codes])
    report_unexpressed(robot, written, expressed=expressed)


def add_native(model: Node, t: Translation) -> None:
    """Add the copied elements of a robot to its model."""
    for element in t.robot.native if t.robot.format == "sdf" else ():
        place = _find_place(model, t, element)
        if place is None:
            _report(t, element)
            continue
        node, pose = place
        source = element.provenance
        assert isinstance(source, Source)
        assert source.element is not None
        made = append_copy(node, source.element)
        _set_pose(made, element, pose)
        taken = {other.get("name") for other in node if other is not made and other.get("name")}
        if made.get("name") in taken and made.tag != "plugin":
            made.set("name", get_free_name(made.get("name", ""), taken))
        if made.tag == "sensor" and not t.options.classic:
            if get_kind(made.get("type", "")).type == "lidar":
                made.set("type", "gpu_lidar")


def _find_place(model: Node, t: Translation, element: NativeElement) -> tuple[Node, Pose] | None:
    """Return the node of an element, and the pose of its link in the node; None without one."""
    kind, _, name = element.section.partition(" ")
    if kind == "model":
        return model, IDENTITY
    pose = IDENTITY
    if kind == "link":
        if name not in t.plan.owner:
            return None
        pose = t.plan.in_owner.get(name, IDENTITY)
        name = t.names.link(t.plan.owner[name])
    else:
        name = t.names.get_joint(name)
    node = next((one for one in model.findall(kind) if one.get("name") == name), None)
    return None if node is None else (node, pose)


def _set_pose(made: Node, element: NativeElement, in_node: Pose) -> None:
    """Replace the pose of an element of a link."""
    values = element.values.get("pose")
    if values is None:
        return
    for old in made.findall("pose"):
        made.remove(old)
    x, y, z, roll, pitch, yaw = values
    set_pose(made, in_node @ Pose(rotation_from_rpy((roll, pitch, yaw)), (x, y, z)))
    new = made.find("pose")
    if new is not None:
        made.insert(0, new)


def _report(t: Translation, element: NativeElement) -> None:
    text = f"<{element.tag}> '{element.name}' is not copied: the export has no {element.section}"
    t.written.report_loss(
        "sdf-element",
        text,
        element.place,
        kind="sensor" if element.tag == "sensor" else element.tag,
        name=element.name,
        severity=Severity.WARNING,
    )
