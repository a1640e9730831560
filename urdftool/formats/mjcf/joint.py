"""Joints: hinges, slides, and the conversion of the other URDF types."""

from __future__ import annotations

import math
from collections.abc import Iterator

from lxml import etree

from ...diagnostic import Severity
from ...model.elements import Joint, Limit, Vector
from ...model.kinematics import UNLIMITED
from ...model.numbers import format_numbers_text, number_text
from ...model.pose import compute_cross, compute_norm
from ...model.settings import JOINTS_OF_MUJOCO, RESISTANCE
from ..common.missing_bounds import (
    explain_default_bounds,
    explain_missing_bounds,
    explain_negative_effort,
)
from ..written import Written
from .gazebo import get_attributes
from .structure import Structure, get_bounds

PLANAR_SUFFIXES = ("_TX", "_TY", "_RZ")
"""Suffixes of the joint name for the two slides and the hinge of a planar joint."""

SITE = {"size": "0.005", "group": "5"}
"""Size [m] and group of a site; viewers hide this group by default."""

UNIT: Vector = (1.0, 0.0, 0.0)


def build_joint_elements(
    structure: Structure, joint: Joint, written: Written
) -> list[etree._Element]:
    """Build the elements of a movable joint, in the order in which MuJoCo applies them."""
    kind = structure.get_kind(joint)
    if kind == "free":
        return [etree.Element("freejoint", name=joint.name)]
    if kind == "planar":
        elements = _build_planar(joint, written)
    elif kind == "ball":
        elements = [etree.Element("joint", name=joint.name, type="ball")]
        if joint.limit is not None and joint.limit.upper is not None:
            elements[0].set("range", format_numbers_text((0.0, joint.limit.upper)))
    else:
        elements = [_build_single(structure, joint, kind, written)]
    for element in elements:
        _set_dynamics(element, joint)
        _set_spring(element, joint.spring)
        for name, value in get_attributes(joint.settings, JOINTS_OF_MUJOCO).items():
            element.set(name, value)
    return elements


def get_axis(joint: Joint) -> Vector:
    """Return the axis as written; x by default."""
    return UNIT if joint.axis is None else joint.axis.xyz


def create_locked_site(joint: Joint, written: Written) -> etree._Element:
    """Create the site of a joint with equal limits, and report that its link is welded."""
    assert joint.limit is not None
    for what, text, severity in _bound_losses(joint, joint.limit, welded=True):
        place = joint.limit.place
        written.report_loss(what, text, place, kind="joint", name=joint.name, severity=severity)
    return etree.Element("site", {"name": joint.name, **SITE})


def report_locked_joints(structure: Structure, written: Written) -> None:
    """Report that equal limits hold every joint, so that no joint of the model moves."""
    count = len(structure.locked)
    if count and all(joint.mimic is not None for joint in structure.moving):
        joints = f"all {count} joints" if count > 1 else "the only joint"
        written.report_loss(
            "locked",
            f"{joints} that could move {'have' if count > 1 else 'has'} equal limits: no joint of "
            f"the model moves, as {'their links are' if count > 1 else 'its link is'} welded",
            structure.robot.place,
            kind="robot",
            name=structure.robot.name,
            hint="write the limits, or the type continuous",
        )


def get_effort(joint: Joint) -> float | None:
    """Return the effort limit [N·m or N] of a joint; None if it has none or zero."""
    return joint.get_magnitude("effort") or None


def _build_single(
    structure: Structure, joint: Joint, kind: str, written: Written
) -> etree._Element:
    element = etree.Element("joint", name=joint.name)
    if kind == "slide":
        element.set("type", "slide")
    element.set("axis", format_numbers_text(get_axis(joint)))
    limits = get_bounds(joint)
    if limits is not None and limits[0] < limits[1] and any(map(math.isfinite, limits)):
        ends = [max(-UNLIMITED, min(limit, UNLIMITED)) for limit in limits]
        element.set("range", format_numbers_text(ends))
    effort = get_effort(joint) if structure.robot.format != "mjcf" else None  # which is copied
    forces = [
        abs(one.gear) * max(map(abs, one.force_range))
        for one in structure.robot.joint_actuators
        if one.joint == joint.name and one.force_range is not None
    ]
    if effort is not None and all(force > effort for force in forces):
        element.set("actuatorfrcrange", format_numbers_text((-effort, effort)))
    for what, text, severity in _limit_losses(joint, structure.robot.format):
        place = joint.place if joint.limit is None else joint.limit.place
        written.report_loss(what, text, place, kind="joint", name=joint.name, severity=severity)
    return element


def _limit_losses(joint: Joint, source: str) -> Iterator[tuple[str, str, Severity]]:
    """Yield code, text and severity of each loss; only URDF requires a limit."""
    limit = joint.limit
    if limit is None:
        if joint.is_limited and source == "urdf":
            yield (
                "limit-missing",
                (
                    f"joint '{joint.name}' of type {joint.type} has no <limit>; it moves without "
                    "limits"
                ),
                Severity.WARNING,
            )
        return
    yield from _bound_losses(joint, limit, welded=False)
    if limit.effort == 0:
        yield (
            "effort",
            f"effort 0 of joint '{joint.name}' cannot be written (0 is no bound in MuJoCo); its "
            "limit is left out",
            Severity.WARNING,
        )
    elif limit.effort is not None and limit.effort < 0:
        yield "effort", explain_negative_effort(joint), Severity.WARNING
    if limit.velocity is not None:
        yield (
            "velocity",
            f"MuJoCo has no velocity limits; that of joint '{joint.name}' ({limit.velocity:g}) is "
            "kept "
            "as a number in <custom>",
            Severity.INFO,
        )


def _bound_losses(
    joint: Joint, limit: Limit, *, welded: bool
) -> Iterator[tuple[str, str, Severity]]:
    if not joint.is_limited:
        if limit.lower or limit.upper:
            text = f"joint '{joint.name}' is continuous; its lower and upper limits are ignored"
            yield "limit-unused", text, Severity.INFO
        return
    lower, upper = limit.lower or 0.0, limit.upper or 0.0
    if joint.turns_freely:
        yield "limit-missing", explain_missing_bounds(joint), Severity.WARNING
    elif text := explain_default_bounds(
        joint, "its link is welded there" if welded else "an equality constraint holds it there"
    ):
        yield "limit-missing", text, Severity.WARNING
    elif lower == upper:
        unit = "m" if joint.type == "prismatic" else "rad"
        held = (
            "its link is welded there (--keep-locked-joints keeps the joint)"
            if welded
            else "an equality constraint holds it there"
        )
        text = f"both limits of joint '{joint.name}' are {lower:g} {unit}; {held}"
        yield "limit-equal", text, Severity.INFO
    elif lower > upper:
        yield (
            "limit-inverted",
            f"lower limit {lower:g} of joint '{joint.name}' is above the upper, {upper:g}; it "
            "moves without bounds",
            Severity.WARNING,
        )


def _build_planar(joint: Joint, written: Written) -> list[etree._Element]:
    """Build two slides in the plane and a hinge about its normal.

    The slides are the x and y axes of the joint frame after the minimal rotation to the normal.
    """
    x, y, normal = get_plane(get_axis(joint))
    if joint.limit is not None:
        written.report_loss(
            "planar-limit",
            f"limits of planar joint '{joint.name}' are not written; it moves without limits",
            joint.limit.place,
            kind="joint",
            name=joint.name,
        )
    elements = []
    for suffix, axis in zip(PLANAR_SUFFIXES, (x, y, normal), strict=True):
        element = etree.Element("joint", name=joint.name + suffix)
        if suffix != "_RZ":
            element.set("type", "slide")
        element.set("axis", format_numbers_text(axis))
        elements.append(element)
    return elements


def get_plane(axis: Vector) -> tuple[Vector, Vector, Vector]:
    """Return unit vectors x and y of a plane and its normal, by the minimal rotation from z."""
    length = compute_norm(axis)
    a, b, c = (part / length for part in axis)
    if c < -1 + 1e-12:
        return (1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0)
    x = (1 - a * a / (1 + c), -a * b / (1 + c), -a)
    return x, compute_cross((a, b, c), x), (a, b, c)


def _set_dynamics(element: etree._Element, joint: Joint) -> None:
    for row in RESISTANCE:
        if value := getattr(joint.dynamics, row.name, None):
            element.set(row.mjcf_attribute, number_text(value))


def _set_spring(element: etree._Element, spring: tuple[float, float] | None) -> None:
    """Set the spring: stiffness [N·m/rad or N/m] and reference position [rad or m]."""
    if spring is None:
        return
    stiffness, reference = spring
    element.set("stiffness", number_text(stiffness))
    if reference and element.get("type", "hinge") != "ball":
        element.set("springref", number_text(reference))
