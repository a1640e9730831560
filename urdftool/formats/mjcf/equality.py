"""Equality constraints for mimic joints, locked joints and loop-closing joints."""

from __future__ import annotations

from lxml import etree

from ...diagnostic import Severity
from ...model.elements import Joint
from ...model.numbers import format_numbers_text
from ..written import Written
from .loops import build_loop_equalities, get_softness
from .structure import Structure, get_locked_at


def build_equality_section(structure: Structure, written: Written) -> etree._Element | None:
    """Build ``<equality>``; None if no joint mimics another, is locked or closes a loop."""
    section = etree.Element("equality")
    for joint in structure.moving:
        if joint.mimic is not None:
            _follow(structure, joint, section, written)
        if not structure.is_single(joint):
            continue
        held = get_locked_at(joint)
        if held is not None:
            _hold(structure, joint, held, section)
    section.extend(build_loop_equalities(structure))
    return section if len(section) else None


def follows(structure: Structure, joint: Joint) -> bool:
    """Tell whether a joint mimics another one."""
    if joint.mimic is None or not structure.is_single(joint):
        return False
    leader = structure.robot.joint.get(joint.mimic.joint)
    return leader is not None and leader is not joint


def _follow(structure: Structure, joint: Joint, section: etree._Element, written: Written) -> None:
    mimic = joint.mimic
    assert mimic is not None
    leader = structure.robot.joint.get(mimic.joint)
    if leader is None or leader is joint or not structure.is_single(joint):
        _report_mimic_loss(joint, "its motion is not coupled", written)
    elif structure.get_kind(leader) == "weld":
        held = mimic.offset + mimic.multiplier * structure.locked.get(leader.name, 0.0)
        _hold(structure, joint, held, section)
        written.report_loss(
            "mimic-fixed",
            f"joint '{joint.name}' mimics '{mimic.joint}', which is fixed; it is held at {held:g}",
            mimic.place,
            kind="joint",
            name=joint.name,
            severity=Severity.INFO,
        )
    elif not structure.is_single(leader):
        _report_mimic_loss(
            joint,
            f"'{mimic.joint}' of type {leader.type} cannot be a mimic leader in MuJoCo",
            written,
        )
    else:
        coefficients = (mimic.offset, mimic.multiplier, 0, 0, 0)
        section.append(_build_equality(structure, joint, coefficients, joint2=leader.name))


def _hold(structure: Structure, joint: Joint, value: float, section: etree._Element) -> None:
    section.append(_build_equality(structure, joint, (value, 0, 0, 0, 0)))


def _build_equality(
    structure: Structure, joint: Joint, coefficients: tuple[float, ...], **leader: str
) -> etree._Element:
    attributes = {
        "joint1": joint.name,
        **leader,
        "polycoef": format_numbers_text(coefficients),
        **get_softness(structure),
    }
    return etree.Element("joint", attributes)


def _report_mimic_loss(joint: Joint, why: str, written: Written) -> None:
    assert joint.mimic is not None
    written.report_loss(
        "mimic",
        f"the mimic of joint '{joint.name}' is not exported: {why}",
        joint.mimic.place,
        kind="joint",
        name=joint.name,
    )
