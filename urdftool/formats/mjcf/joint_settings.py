"""User settings of joints: armature for all joints, and values of an actuator file."""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import replace

from ...diagnostic import Severity
from ...model.elements import Dynamics, Joint, Limit, Robot
from ...model.settings import RESISTANCE
from ..common import described_gains
from ..common.actuator_config import JointSettings
from ..written import Written
from .inertials import LEAF_ARMATURE, get_massless_leaves
from .joint import get_effort
from .options import Options
from .structure import Structure, get_locked_at

MOVING = ("hinge", "slide", "ball", "planar")
"""Kinds of joints with dynamics."""


def choose_joint_settings(structure: Structure, options: Options) -> dict[str, JointSettings]:
    """Choose the settings of each movable hinge and slide, by joint name.

    Raises:
        ConfigError: The file cannot be read, or has settings for a joint that does not move.
    """
    names = [
        joint.name
        for joint in structure.moving
        if structure.is_single(joint) and get_locked_at(joint) is None
    ]
    usual = JointSettings(armature=options.armature)
    settings = described_gains.choose_joint_settings(
        structure.robot, names, options.actuator_config
    )
    return {name: own.override(usual) for name, own in settings.items()}


def set_joint_values(
    structure: Structure,
    settings: Mapping[str, JointSettings],
    singular: Set[str],
    written: Written,
) -> Robot:
    """Return the robot with dynamics and effort of its joints as exported.

    Joints of massless leaf links get an armature, and joints that move no mass against another.
    Changes of values of the description are reported.

    Singular joints turn against another without moving mass.
    """
    leaves = get_massless_leaves(structure)
    joints = []
    for joint in structure.robot.joints:
        if structure.get_kind(joint) in MOVING:
            own = settings.get(joint.name)
            has_armature = structure.group[joint.child] in leaves
            if joint.name in singular and not _has_armature(joint, own):
                has_armature = True
                _report_armature(joint, written)
            joint = _set_values(joint, own, has_armature, written)
        joints.append(joint)
    return replace(structure.robot, joints=joints)


def _has_armature(joint: Joint, settings: JointSettings | None) -> bool:
    """Tell whether the description or the user gives a joint an armature."""
    if joint.get_resistance("armature"):
        return True
    return settings is not None and bool(settings.armature)


def _report_armature(joint: Joint, written: Written) -> None:
    written.report_loss(
        "armature",
        f"joint '{joint.name}' and another turn against each other without moving mass; it has an "
        f"armature of {LEAF_ARMATURE:g}, without which the simulation may diverge",
        joint.place,
        kind="joint",
        name=joint.name,
        severity=Severity.INFO,
    )


def _set_values(
    joint: Joint, settings: JointSettings | None, has_armature: bool, written: Written
) -> Joint:
    before = joint.dynamics or Dynamics(joint.provenance)
    after = replace(before, armature=LEAF_ARMATURE) if has_armature else before
    if settings is None:
        return joint if after is joint.dynamics else replace(joint, dynamics=after)
    after = replace(after, **settings.list_resistance())
    changed = [
        f"{row.mjcf_attribute} {new:g} instead of {old:g}"
        for row in RESISTANCE
        for new, old in [[getattr(one, row.name) or 0.0 for one in (after, before)]]
        if row.path and new != old
    ]
    limit = joint.limit
    if settings.force_range is not None:
        low, high = settings.force_range
        effort = get_effort(joint)
        if effort is not None and (low, high) != (-effort, effort):
            changed.append(f"force {low:g} to {high:g} instead of {-effort:g} to {effort:g}")
        limit = replace(limit or Limit(joint.provenance), effort=max(abs(low), abs(high)))
    if changed:
        written.report_loss(
            "actuator-config",
            f"joint '{joint.name}' has, from --actuator-config, {', '.join(changed)}",
            joint.place,
            kind="joint",
            name=joint.name,
            severity=Severity.INFO,
        )
    return replace(joint, dynamics=after, limit=limit)
