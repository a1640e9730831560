"""Conversion of joints: the origin is in the parent's frame, the axis in the joint's frame."""

from __future__ import annotations

import math

from ...diagnostic import Severity
from ...model.elements import BALL_TYPES, Joint, Vector
from ...model.kinematics import MOVABLE
from ...model.numbers import format_numbers_text, number_text
from ...model.pose import IDENTITY, compute_cross, compute_norm
from ...model.settings import MAGNITUDES, RESISTANCE
from ..common.actuator_config import JointSettings
from ..common.missing_bounds import explain_default_bounds, explain_missing_bounds
from ..common.unexpressed import report_resistance
from .extensions import convert_joint_extensions, report_dissolved_joint
from .frames import get_parent_frame
from .inertials import WEIGHTLESS
from .joint_settings import get_effort
from .native import merge_native
from .pose import set_origin, set_pose
from .sensors import add_joint_sensors
from .translation import Translation
from .xml import Node, add, append_comment, get_or_create

SDF_TYPES = {
    "revolute": "revolute",
    "continuous": "revolute",
    "prismatic": "prismatic",
    "fixed": "fixed",
    **dict.fromkeys(sorted(BALL_TYPES), "ball"),
}
"""SDF type of each URDF joint type; ``floating`` is dropped, ``planar`` becomes three joints."""


_WRITTEN = tuple(row for row in RESISTANCE if row.path)
"""Values of the dynamics of an axis."""


def add_joint(model: Node, t: Translation, part: Joint) -> None:
    """Add a joint, unless it became a frame or SDF has no such joint."""
    if part.name in t.plan.dissolved:
        report_dissolved_joint(t, part)
        return
    if part.type == "floating":
        text = (
            f"joint '{part.name}' is floating; in SDF '{part.child}' is a free link without a joint"
        )
        t.report_note("floating", text, part, part)
        _report_mimic_loss(t, part)
        return
    if part.type == "planar":
        add_planar(model, t, part)
        _report_mimic_loss(t, part)
        return
    kind = _choose_type(t, part)
    node = start(model, t, part, t.names.get_joint(part.name), kind)
    if kind in ("revolute", "prismatic"):
        _add_axis(node, t, part)
    elif kind == "ball":
        _report_mimic_loss(t, part)
        report_resistance(part, _WRITTEN, t.written)
    _report_unspoken(node, t, part)
    add_joint_sensors(node, t, part)
    convert_joint_extensions(node, t, part)
    merge_native(node, t, f"joint {part.name}", part)


def _choose_type(t: Translation, part: Joint) -> str:
    """Return the type in SDF, and report a type or axis that it cannot have."""
    if part.has_axis and part.axis is not None and compute_norm(part.axis.xyz) < 1e-6:
        text = (
            f"axis of joint '{part.name}' is zero, so its motion is undefined; it is exported "
            "as fixed"
        )
        t.report_loss("axis", text, part.axis, part)
        return "fixed"
    if part.type not in SDF_TYPES:
        text = f"joint '{part.name}' has the unknown type '{part.type}'; it is fixed"
        t.report_loss("joint-type", text, part, part)
    return SDF_TYPES.get(part.type, "fixed")


def _add_axis(node: Node, t: Translation, part: Joint) -> None:
    axis = add(node, "axis")
    add(axis, "xyz", format_numbers_text(get_axis(part)))
    limit = add(axis, "limit")
    _add_bounds(limit, t, part)
    _set_most(limit, t, part)
    _add_dynamics(axis, t, part)
    _add_mimic(axis, t, part)


def _add_dynamics(axis: Node, t: Translation, part: Joint) -> None:
    chosen = t.settings.get(part.name, JointSettings()).list_resistance()
    for row in _WRITTEN:
        value = chosen.get(row.name, getattr(part.dynamics, row.name, None))
        if value is not None:
            add(get_or_create(axis, "dynamics"), row.name, number_text(value))


def _add_bounds(node: Node, t: Translation, part: Joint) -> None:
    limit = part.limit
    if part.type == "continuous":
        if limit is not None and (limit.lower is not None or limit.upper is not None):
            text = f"joint '{part.name}' is continuous; its lower and upper limits are ignored"
            t.report_note("limit", text, limit, part)
        return
    if limit is None:
        if t.robot.format == "urdf":  # the only format that requires a limit
            text = f"joint '{part.name}' has no limits; it moves without limits"
            t.report_loss("limit", text, part, part)
        return
    if part.turns_freely:
        t.report_loss("limit", explain_missing_bounds(part), limit, part)
        return
    if text := explain_default_bounds(part):
        t.report_loss("limit", text, limit, part)
    lower, upper = limit.lower or 0.0, limit.upper or 0.0
    if lower > upper:
        text = f"lower limit of joint '{part.name}' is above its upper limit; they are swapped"
        t.report_loss("limit", text, limit, part)
        lower, upper = upper, lower
    for tag, bound in (("lower", lower), ("upper", upper)):
        if math.isfinite(bound):
            add(node, tag, number_text(bound))


def _set_most(node: Node, t: Translation, part: Joint) -> None:
    """Set effort and velocity limits; SDF ignores negative ones, URDF uses the absolute value."""
    limit = part.limit
    chosen = t.settings.get(part.name, JointSettings()).force_range
    if chosen is not None:
        add(node, "effort", number_text(get_effort(chosen)))
    if limit is None:
        return
    for name in MAGNITUDES:
        value = getattr(limit, name)
        if value is None or (name == "effort" and chosen is not None):
            continue
        if value < 0:
            text = f"{name} limit of joint '{part.name}' is negative; its absolute value is written"
            t.report_loss("limit", text, limit, part)
        elif value == 0 and part.mimic is None:
            text = f"{name} limit of joint '{part.name}' is 0; Gazebo will not move the joint"
            t.report_note("limit", text, limit, part)
        add(node, name, number_text(abs(value)))


def _report_mimic_loss(t: Translation, part: Joint) -> None:
    if part.mimic is not None:
        text = (
            f"joint '{part.name}' is {part.type}; SDF has mimic for joints with an axis only, "
            "so it moves freely"
        )
        t.report_loss("mimic", text, part.mimic, part)


def _add_mimic(axis: Node, t: Translation, part: Joint) -> None:
    mimic = part.mimic
    if mimic is None:
        return
    leader = t.robot.joint.get(mimic.joint)
    can_lead = leader is not None and leader.type in MOVABLE
    if not can_lead or leader is part:
        text = f"joint '{part.name}' mimics '{mimic.joint}', which does not move; it moves freely"
        t.report_loss("mimic", text, mimic, part)
        return
    if not t.options.is_at_least("1.11"):
        t.report_loss(
            "mimic",
            f"joint '{part.name}' mimics '{mimic.joint}', which SDF {t.options.sdf_version} cannot "
            "say; it is free",
            mimic,
            part,
            hint="" if t.options.classic else "--sdf-version 1.11 can",
        )
        return
    made = add(axis, "mimic", joint=t.names.get_joint(mimic.joint))
    add(made, "multiplier", number_text(mimic.multiplier))
    add(made, "offset", number_text(mimic.offset))
    add(made, "reference", "0")


def _report_unspoken(node: Node, t: Translation, part: Joint) -> None:
    """Keep safety controller and calibration as comments, and report them."""
    for what, dropped in (("safety", part.safety_controller), ("calibration", part.calibration)):
        if dropped is None:
            continue
        element = dropped.element
        text = " ".join(f'{k}="{v}"' for k, v in element.attributes.items())
        append_comment(node, f"{element.tag} {text}")
        t.report_loss(
            what,
            (
                f"<{element.tag}> of joint '{part.name}' has no counterpart in SDF; it is kept as "
                "a "
                "comment"
            ),
            dropped,
            part,
            severity=Severity.INFO,
        )


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
        _add_free_axis(node, t, part, direction)
        before = link
    node = start(model, t, part, name, "revolute")
    _connect(node, before, "")
    _add_free_axis(node, t, part, normal)


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


def _add_free_axis(node: Node, t: Translation, part: Joint, direction: Vector) -> None:
    """Add an axis without limits, with the damping and friction of a planar joint."""
    axis = add(node, "axis")
    add(axis, "xyz", format_numbers_text(direction))
    add(axis, "limit")
    _add_dynamics(axis, t, part)


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
