"""Elements of SDF that a block holds as they are: lights, projectors, emitters, batteries."""

from __future__ import annotations

from ...model.elements import Link
from ...model.pose import Pose, rotation_of_rpy
from ...model.read import numbers
from ...source.document import Element
from .pose import set_pose
from .translation import Translation
from .xml import Node, add, copied

PLACED = frozenset(
    ("light", "projector", "sensor", "audio_source", "particle_emitter", "collision", "visual")
)
"""Elements of a link that have a pose in it."""


def blob(node: Node, t: Translation, link: Link, element: Element) -> Node:
    """Copy an element of a link's block into the link that it is in now."""
    made = copied(node, element)
    if element.tag in PLACED:
        move(made, t, link)
    return made


def move(made: Node, t: Translation, link: Link) -> None:
    """Let the pose of something in a link mean the same in the link's owner."""
    rename_frames(made, t)
    pose = made.find("pose")
    if t.plan.stays(link.name) or (pose is not None and pose.get("relative_to")):
        return
    if not t.options.classic:
        if pose is None:
            pose = add(made, "pose", "0 0 0 0 0 0")
            made.remove(pose)
            made.insert(0, pose)
        pose.set("relative_to", t.names.link(link.name))
        return
    six = numbers(pose.text if pose is not None else "0 0 0 0 0 0", 6)
    if six is None:
        return
    local = Pose(rotation_of_rpy(six[3:]), six[:3])  # type: ignore[arg-type]
    if pose is not None:
        made.remove(pose)
    set_pose(made, t.plan.in_owner[link.name] @ local)
    placed = made.find("pose")
    if placed is not None:
        made.insert(0, placed)


def rename_frames(node: Node, t: Translation) -> None:
    """Rewrite references to frames whose names changed."""
    for pose in node.iter("pose"):
        frame = pose.get("relative_to")
        if frame is not None and ("link", frame) in t.names.renamed:
            pose.set("relative_to", t.names.link(frame))
