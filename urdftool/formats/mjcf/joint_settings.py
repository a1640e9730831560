"""User settings of joints: armature for all joints, and values of an actuator file."""

from __future__ import annotations

from dataclasses import replace

from lxml import etree

from ...diagnostic import Severity
from ..common.actuator_config import JointSettings, read_actuator_config
from ..written import Written
from .body import Bodies
from .digits import number_text
from .options import Options
from .structure import Structure, get_locked_at


def choose_joint_settings(structure: Structure, options: Options) -> dict[str, JointSettings]:
    """Choose the settings of each movable hinge and slide, by joint name.

    Raises:
        ConfigError: The file cannot be read, or has settings for a joint that does not move.
    """
    names = [
        joint.name
        for joint in structure.moving
        if structure.get_kind(joint) in ("hinge", "slide") and get_locked_at(joint) is None
    ]
    found = dict.fromkeys(names, JointSettings())
    if options.actuator_config is not None:
        found = read_actuator_config(options.actuator_config).match_joints(names)
    if options.armature is not None:
        for name, settings in found.items():
            if settings.armature is None:
                found[name] = replace(settings, armature=options.armature)
    return found


def apply_settings(
    structure: Structure, bodies: Bodies, settings: dict[str, JointSettings], written: Written
) -> dict[str, float]:
    """Write settings to the joints, and report changes of values of the description.

    Returns:
        The armature [kg·m² or kg] of each joint in the model.
    """
    armatures = {}
    for body in bodies.values():
        for element in body.iterchildren("joint"):
            name = element.get("name", "")
            if name in settings:
                _apply(structure, element, settings[name], written)
            armatures[name] = float(element.get("armature", "0"))
    return armatures


def _apply(
    structure: Structure, element: etree._Element, settings: JointSettings, written: Written
) -> None:
    changed = []
    for attribute, value in (
        ("armature", settings.armature),
        ("damping", settings.damping),
        ("frictionloss", settings.friction),
    ):
        if value is None:
            continue
        written_as = float(element.get(attribute, "0"))
        element.set(attribute, number_text(value))
        if attribute != "armature" and written_as != value:
            changed.append(f"{attribute} {value:g} instead of {written_as:g}")
    if settings.force_range is not None:
        before = str(element.attrib.pop("actuatorfrcrange", ""))
        low, high = settings.force_range
        if before and tuple(map(float, before.split())) != (low, high):
            changed.append(f"force {low:g} to {high:g} instead of {before.replace(' ', ' to ')}")
    if changed:
        joint = structure.robot.joint[element.get("name", "")]
        written.report_loss(
            "actuator-config",
            f"joint '{joint.name}' has, from --actuator-config, {', '.join(changed)}",
            joint.place,
            kind="joint",
            name=joint.name,
            severity=Severity.INFO,
        )
