"""Frames with the names of dissolved links and joints, at their poses.

A frame comes after the element it is attached to, as some readers misplace it otherwise.
"""

from __future__ import annotations

from ...diagnostic import Severity
from ...model.elements import Joint, Link
from ...model.world import WORLD
from ..common.unexpressed import report_moved_frames
from .names import remove_reserved
from .pose import set_origin, set_pose
from .translation import Translation
from .xml import Node, add

MODEL_FRAME = "__model__"


def add_frames(model: Node, t: Translation) -> None:
    """Add the frames of a model, parents first."""
    for name in t.plan.in_model:
        joint = t.robot.tree.get_parent_joint(name)
        link = t.robot.link[name]
        if joint is not None and joint.name in t.plan.dissolved:
            _add_joint_frame(model, t, joint)
        if not t.plan.stays(name):
            _link_frame(model, t, link, joint)


def add_own_frames(model: Node, t: Translation) -> None:
    """Add the frames of an SDF and the sites of an MJCF, if SDF has frames and the name is free."""
    taken = {node.get("name") for node in model}
    report_moved_frames(t.robot, t.written)
    for frame in t.robot.frames:
        if frame.kind == "body":
            continue
        name, exact = remove_reserved(frame.name), t.options.is_at_least("1.9")
        has_frames = t.options.is_at_least("1.7") and frame.link != WORLD  # which no frame may name
        if has_frames and name == frame.name and name and name not in taken:
            taken.add(name)
            made = add(model, "frame", name=name, attached_to=t.names.link(frame.link))
            set_origin(made, frame.origin, exact=exact)
        else:
            text = (
                f"frame '{frame.name}' is dropped" if frame.name else "an unnamed frame is dropped"
            )
            t.written.report_loss(
                "frame", text, frame.place, kind="frame", name=frame.name, severity=Severity.INFO
            )


def _add_joint_frame(model: Node, t: Translation, joint: Joint) -> None:
    owner, parent = t.plan.owner[joint.parent], t.names.link(joint.parent)
    below = owner == joint.child or owner in t.robot.tree.list_descendants(joint.child)
    held = t.names.link(owner) if below else parent
    frame = add(model, "frame", name=t.names.get_joint(joint.name), attached_to=held)
    set_origin(frame, joint.origin, parent if below else "", t.options.is_at_least("1.9"))


def _link_frame(model: Node, t: Translation, link: Link, joint: Joint | None) -> None:
    plan, names = t.plan, t.names
    frame = add(model, "frame", name=names.link(link.name))
    if joint is not None and joint.name in plan.dissolved:
        if plan.owner[link.name] in t.robot.tree.list_descendants(link.name):
            frame.set("attached_to", names.link(plan.owner[link.name]))
            add(frame, "pose", "0 0 0 0 0 0", relative_to=names.get_joint(joint.name))
        else:
            frame.set("attached_to", names.get_joint(joint.name))
        return
    # the topmost link of a body that another of its links owns: the model's root, or below a joint
    frame.set("attached_to", names.link(plan.owner[link.name]))
    place(frame, t, joint)


def place(node: Node, t: Translation, joint: Joint | None) -> None:
    """Set the pose of a link, or of the frame that replaces it, at its joint or the root."""
    is_frame = node.tag == "frame"
    if joint is None:
        if is_frame:
            add(node, "pose", "0 0 0 0 0 0", relative_to=MODEL_FRAME)
        return
    if not t.options.is_at_least("1.7"):
        set_pose(node, t.plan.in_model[joint.child])
        return
    if joint.type == "floating":  # SDF has no joint here, so the link has the pose of the joint
        parent = get_parent_frame(t, joint)
        set_origin(node, joint.origin, parent, t.options.is_at_least("1.9"))
        return
    add(node, "pose", "0 0 0 0 0 0", relative_to=t.names.get_joint(joint.name))


def get_parent_frame(t: Translation, joint: Joint) -> str:
    """Return the frame in which a joint's origin is expressed."""
    if t.plan.anchored and joint.parent == "world":
        return MODEL_FRAME
    return t.names.link(joint.parent)
