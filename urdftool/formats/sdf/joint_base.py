"""Common parts of SDF joints: parent, child, pose and axis direction."""

from __future__ import annotations

from ...model.elements import Joint, Vector
from ...model.pose import IDENTITY, compute_norm
from .frames import get_parent_frame
from .pose import set_origin, set_pose
from .translation import Translation
from .xml import Node, add


def start(model: Node, t: Translation, part: Joint, name: str, kind: str) -> Node:
    """Add a joint with its parent, child and pose."""
    node = add(model, "joint", name=name, type=kind)
    anchored = t.plan.anchored and part.parent == "world"
    parent = "world" if anchored else t.names.link(t.plan.owner[part.parent])
    add(node, "parent", parent)
    add(node, "child", t.names.link(t.plan.owner[part.child]))
    if t.options.is_at_least("1.7"):
        set_origin(node, part.origin, get_parent_frame(t, part), t.options.is_at_least("1.9"))
    else:  # SDF 1.6 expresses the pose in the frame of the child link
        set_pose(node, t.plan.in_owner.get(part.child, IDENTITY))
    return node


def get_axis(part: Joint) -> Vector:
    """Return the axis, scaled to unit length unless it is so within 1e-12."""
    xyz = part.axis.xyz if part.axis is not None else (1.0, 0.0, 0.0)
    length = compute_norm(xyz)
    if abs(length - 1.0) <= 1e-12 or length == 0.0:
        return xyz
    return xyz[0] / length, xyz[1] / length, xyz[2] / length
