"""Conversion of planar joints, which SDF lacks, to two prismatic joints and a revolute one."""

from __future__ import annotations

from ...model.elements import Joint, Vector
from ...model.pose import compute_cross, compute_norm
from ..common.numbers import format_numbers_text, number_text
from .inertials import WEIGHTLESS
from .joint_base import get_axis, start
from .pose import set_pose
from .translation import Translation
from .xml import Node, add


def add_planar(model: Node, t: Translation, part: Joint) -> None:
    """Add three joints in series, with two almost massless links between them.

    ``NAME_x`` and ``NAME_y`` slide in the plane, ``NAME`` rotates about the normal.
    """
    name = t.names.get_joint(part.name)
    t.report_loss(
        "planar",
        f"joint '{part.name}' is planar; '{name}_x' and '{name}_y' slide, and '{name}' turns",
        part,
        part,
    )
    normal = get_axis(part)
    first, second = get_in_plane(normal)
    before = None
    for suffix, direction in (("_x", first), ("_y", second)):
        node = start(model, t, part, name + suffix, "prismatic")
        if not t.options.is_at_least("1.7"):
            for pose in node.findall("pose"):  # the pose applies to the last link only
                node.remove(pose)
        link = f"{name}{suffix}_link"
        _add_between(model, t, part, link, name + suffix)
        _connect(node, before, link)
        _add_slide(node, direction)
        before = link
    node = start(model, t, part, name, "revolute")
    _connect(node, before, "")
    _add_slide(node, normal)


def get_in_plane(normal: Vector) -> tuple[Vector, Vector]:
    """Return two axes in a plane that form a right-handed system with its normal: x and y for z."""
    helper = (1.0, 0.0, 0.0) if abs(normal[0]) < 0.9 * compute_norm(normal) else (0.0, 1.0, 0.0)
    second = compute_cross(normal, helper)
    length = compute_norm(second)
    second = (second[0] / length, second[1] / length, second[2] / length)
    return compute_cross(second, normal), second


def _connect(node: Node, parent: str | None, child: str) -> None:
    """Replace the parent or child of a joint by a link in between."""
    for tag, name in (("parent", parent), ("child", child)):
        found = node.find(tag)
        if name and found is not None:
            found.text = name


def _add_slide(node: Node, direction: Vector) -> None:
    axis = add(node, "axis")
    add(axis, "xyz", format_numbers_text(direction))
    add(axis, "limit")


def _add_between(model: Node, t: Translation, part: Joint, name: str, joint: str) -> None:
    link = add(model, "link", name=name)
    if t.options.is_at_least("1.7"):
        add(link, "pose", "0 0 0 0 0 0", relative_to=joint)
    else:
        set_pose(link, t.plan.in_model[part.child])
    inertial = add(link, "inertial")
    add(inertial, "mass", number_text(WEIGHTLESS))
    inertia = add(inertial, "inertia")
    for term in ("ixx", "iyy", "izz"):
        add(inertia, term, number_text(WEIGHTLESS * 1e-6))
