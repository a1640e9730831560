"""Elements that an export of an SDF copies: sensors, plugins, lights and others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ...diagnostic import Severity
from ...model.elements import Robot
from ...model.mechanism import Closure, NativeElement
from ...model.native import AROUND, LOOP, NESTED
from ...model.numbers import format_numbers_text
from ...model.part import Part
from ...model.pose import IDENTITY, Pose, make_pose, rotation_from_rpy
from ...model.provenance import Written as Source
from ...model.sensors import get_kind
from ...model.world import WORLD
from ...model.world_settings import OF_SDF
from ...source.document import Element
from ..common.naming import get_free_name
from ..common.unexpressed import report_unexpressed
from ..written import Written
from .names import remove_reserved
from .options import Options
from .pose import set_pose
from .translation import Translation
from .xml import Node, add, append_copy, append_native, merge

_UNREAD = (
    *("light", "projector", "particle_emitter", "battery", "audio_source", "gripper"),
    *("element", "look"),
)
"""Codes of what the reader leaves out and an export copies."""


_IN_PARTS = ("collision", "visual", "joint")
"""Tags of what shapes and joints have in addition."""


def report_uncopied(robot: Robot, options: Options, written: Written) -> None:
    """Report what the reader left out, and parts that no element of the export has."""
    in_world = {row.name for row in OF_SDF if options.world}
    robot = replace(robot, world={n: v for n, v in robot.world.items() if n not in in_world})
    expressed: tuple[str, ...] = ("base", "frame", "joint-spring", "origin")
    if robot.format == "sdf":
        expressed = (*expressed, "camera", "sensor", "plugin", "closure")
        codes = {f"unread-{code}" for code in _UNREAD}
        robot = replace(robot, unread=[loss for loss in robot.unread if loss.code not in codes])
    report_unexpressed(robot, written, expressed=expressed)


def add_native(model: Node, t: Translation) -> None:
    """Add the copied elements of a robot to its model."""
    for element in _list_native(t):
        if element.tag in (*_IN_PARTS, *NESTED, AROUND):
            continue  # in its shape or joint; the links of nested models are those of the model
        place = _find_place(model, t, element)
        if place is None:
            _report(t, element, element.section)
            continue
        node, pose = place
        made = append_copy(node, _get_source(element))
        _set_pose(made, element, pose)
        taken = {other.get("name") for other in node if other is not made and other.get("name")}
        if made.get("name") in taken and made.tag != "plugin":
            made.set("name", get_free_name(made.get("name", ""), taken))
        if made.tag == "sensor" and not t.options.classic:
            if get_kind(made.get("type", "")).type == "lidar":
                made.set("type", "gpu_lidar")
    for closure in t.robot.closures if t.robot.format == "sdf" else ():
        _add_loop(model, t, closure)


def merge_native(node: Node, t: Translation, section: str, part: Part) -> None:
    """Merge what an SDF has in a shape or joint, and the robot does not hold, into a node."""
    for element in t.rest.get((section, part.place), ()):
        if element.tag in _IN_PARTS:
            made = append_native(node, element)
            node.remove(made)
            merge(node, made)


def _list_native(t: Translation) -> Sequence[NativeElement]:
    return t.robot.native if t.robot.format == "sdf" else ()


def _get_source(element: NativeElement) -> Element:
    source = element.provenance
    assert isinstance(source, Source)
    assert source.element is not None
    return source.element


def _add_loop(model: Node, t: Translation, closure: Closure) -> None:
    """Add a joint that closes a loop, at its place in the exported links."""
    element = next(e for e in _list_native(t) if e.tag == LOOP and e.place == closure.place)
    owner = {**t.plan.owner, WORLD: WORLD}
    ends = [owner.get(name) for name in (closure.parent, closure.child)]
    if None in ends:
        _report(t, element, "links")
        return
    taken = {other.get("name") for other in model}
    name = get_free_name(remove_reserved(closure.name), taken)
    made = add(model, "joint", name=name, type=_get_source(element).get("type") or "")
    for tag, link in zip(("parent", "child"), ends, strict=True):
        add(made, tag, t.names.link(link or ""))
    at_child = make_pose(closure.child_origin)
    set_pose(made, t.plan.in_owner.get(closure.child, IDENTITY) @ at_child)
    if closure.axis is not None:
        add(add(made, "axis"), "xyz", format_numbers_text(closure.axis))
    rest = append_native(made, element)
    made.remove(rest)
    merge(made, rest)


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


def _report(t: Translation, element: NativeElement, missing: str) -> None:
    text = f"<{element.tag}> '{element.name}' is not copied: the export has no such {missing}"
    t.written.report_loss(
        "sdf-element",
        text,
        element.place,
        kind="sensor" if element.tag == "sensor" else element.tag,
        name=element.name,
        severity=Severity.WARNING,
    )
