"""Another zero or sign of a joint: frames, limits, mimic, and positions in files around."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ..errors import ModelError
from ..model.elements import Joint
from ..model.kinematics import MOVABLE, compute_motion
from ..model.numbers import number
from ..model.pose import make_pose
from ..model.urdf_schema import VOCABULARY
from ..source.document import Element
from .around import shift_files
from .change import SAME, Change
from .closed_loops import check_zeros
from .draft import Draft
from .numbers import format_number, negate_text
from .references import list_gazebo_blocks, report_text

_LOST = 1e-9
"""Largest change of a limit by rounding [rad, m], relative above 1; chosen, below the proof's."""


def change_positions(draft: Draft, changes: Mapping[str, Change]) -> None:
    """Give joints another sign and zero; all frames move as before.

    Raises:
        ModelError: A joint does not exist, or does not have one position.
    """
    check_zeros(draft, (name for name, change in changes.items() if change.zero))
    for name, change in changes.items():
        joint = draft.find_joint(name)
        if joint.type not in MOVABLE:
            raise ModelError(
                f"joint '{name}' is {joint.type or 'of no type'}; only revolute, continuous and "
                "prismatic joints have one position",
                at=joint.place,
            )
        _change_joint(draft, joint, change)
        zero, sign = format_number(change.zero), format_number(change.sign)
        draft.declare("joint", name, name, "sign", sign, "zero", zero)
    for joint in draft.robot.joints:
        if joint.mimic is not None:
            _change_mimic(draft, joint, changes)
    for block in draft.root.list_children("ros2_control"):
        for element in block.list_children("joint"):
            shift = changes.get(element.get("name") or "")
            if shift is not None:
                _change_interfaces(draft, element, shift)
            _change_follower(draft, element, changes)
    for block in draft.root.list_children("transmission"):
        for element in block.list_children("joint"):
            if (element.get("name") or "") in changes:
                _report_offset(draft, element, changes[element.get("name") or ""])
    shift_files(draft, changes)
    for name in changes:
        report_text(draft, name, "positions in it are not shifted", has_positions=True)


def _change_joint(draft: Draft, joint: Joint, change: Change) -> None:
    element = joint.element
    if change.zero:
        motion = compute_motion(joint, -change.sign * change.zero)
        draft.set_pose(element, joint.origin, make_pose(joint.origin) @ motion)
    if change.sign < 0:
        negate_axis(draft, joint)
    if joint.limit is not None and not joint.turns_freely:
        _change_pair(draft, joint.limit.xml, ("lower", "upper"), change)
    safety = joint.safety_controller
    if safety is not None:
        _change_pair(draft, safety.xml, ("soft_lower_limit", "soft_upper_limit"), change)
    if joint.calibration is not None and joint.calibration.xml is not None:
        _change_calibration(draft, joint.calibration.xml, change)
    for block in list_gazebo_blocks(draft, joint.name):
        rest = block.find_child("springReference")
        if rest is not None and (text := change.format(rest.text)):
            draft.set_text(rest, text)


def negate_axis(draft: Draft, joint: Joint) -> None:
    """Write the opposite axis; the default is x."""
    if joint.axis is None or joint.axis.xml is None or joint.axis.xml.get("xyz") is None:
        draft.append(joint.element, ['<axis xyz="-1 0 0"/>'])
    else:
        draft.set(joint.axis.xml, "xyz", negate_text(joint.axis.xml.get("xyz") or ""))


def _change_pair(
    draft: Draft, element: Element | None, names: tuple[str, str], change: Change
) -> None:
    """Shift two limits, which a negative sign exchanges; a missing one is 0."""
    if element is None:
        return
    low, high = (change.format(element.get(name) or "0") for name in names)
    if low is None or high is None:
        raise ModelError("a limit is not a number", at=element.place)
    before = [number(element.get(name) or "0") for name in names]
    for old, new in zip(before, map(number, (low, high)), strict=True):
        assert old is not None
        assert new is not None
        if not math.isclose(change.invert(new), old, rel_tol=_LOST, abs_tol=_LOST):
            raise ModelError(
                f"a zero at {-change.zero * change.sign:g} is too far for limits in double "
                "precision; give one near the limits",
                at=element.place,
            )
    if change.sign < 0:
        low, high = high, low
    for name, text in zip(names, (low, high), strict=True):
        if name in element.attributes or number(text):
            draft.set(element, name, text)


def _change_calibration(draft: Draft, element: Element, change: Change) -> None:
    texts = {
        name: change.format(element.get(name))
        for name in VOCABULARY["calibration"].attributes
        if element.get(name) is not None
    }
    if change.sign < 0:
        swapped = {"rising": "falling", "falling": "rising"}
        for name in set(swapped) & texts.keys():
            draft.remove_attribute(element, name)
        texts = {swapped.get(name, name): text for name, text in texts.items()}
    for name, text in texts.items():
        if text is not None:
            draft.set(element, name, text)


def _change_mimic(draft: Draft, joint: Joint, changes: Mapping[str, Change]) -> None:
    """Write follower = multiplier · leader + offset in the new positions of both."""
    mimic = joint.mimic
    assert mimic is not None
    own, leader = changes.get(joint.name, SAME), changes.get(mimic.joint, SAME)
    if own is SAME and leader is SAME:
        return
    factor = own.sign * mimic.multiplier * leader.sign
    offset = own.sign * mimic.offset + own.zero - factor * leader.zero
    for name, old, new in (
        ("multiplier", mimic.multiplier, factor),
        ("offset", mimic.offset, offset),
    ):
        if format_number(old) != format_number(new):
            draft.set(mimic.element, name, format_number(new))


def _change_follower(draft: Draft, joint: Element, changes: Mapping[str, Change]) -> None:
    """Write the multiplier of a follower in ``<ros2_control>``, where an offset has no place."""
    params = {e.get("name"): e for e in joint.list_children("param")}
    leading = params.get("mimic")
    name = joint.get("name") or ""
    leader = changes.get("" if leading is None else leading.text.strip(), SAME)
    own, written = changes.get(name, SAME), params.get("multiplier")
    factor = 1.0 if written is None else number(written.text.strip())
    if leading is None or factor is None or (own is SAME and leader is SAME):
        return
    new = own.sign * factor * leader.sign
    if new != factor:
        text = format_number(new)
        if written is None:
            draft.append(joint, [f'<param name="multiplier">{text}</param>'])
        else:
            draft.set_text(written, text)
    if offset := own.zero - new * leader.zero:
        draft.report(
            "offset",
            f"joint '{name}' follows '{leading.text.strip()}' in <ros2_control> without the offset "
            f"{format_number(offset)} that the new zero requires; <mimic> of the joint has it",
            leading.place,
            kind="joint",
            name=name,
        )


def _report_offset(draft: Draft, joint: Element, change: Change) -> None:
    """Report the offset of a transmission, whose motor may have another direction, too."""
    offset = joint.find_child("offset")
    new = None if offset is None else change.format(offset.text.strip())
    if offset is not None and new is not None and new != offset.text.strip():
        name = joint.get("name") or ""
        text = f"<offset> of joint '{name}' in a <transmission> is not changed; in the new "
        text += f"positions it is {new}"
        if change.sign < 0:
            text += ", with the opposite <mechanicalReduction>"
        draft.report("offset", text, offset.place, kind="joint", name=name)


def _change_interfaces(draft: Draft, joint: Element, change: Change) -> None:
    """Shift the positions and ranges in the ``<joint>`` of a ``<ros2_control>``."""
    for interface in joint.children:
        name = (interface.get("name") or "").rpartition("/")[2]
        if name not in ("position", "velocity", "effort"):
            continue
        used = change if name == "position" else Change(change.sign)
        params = {e.get("name"): e for e in interface.list_children("param")}
        ends = params.get("min"), params.get("max")
        texts = [None if end is None else used.format(end.text.strip()) for end in ends]
        if change.sign < 0:
            texts.reverse()
        initial = params.get("initial_value")
        new = None if initial is None else used.format(initial.text.strip())
        for element, text in (*zip(ends, texts, strict=True), (initial, new)):
            if element is not None and text is not None and element.text.strip() != text:
                draft.set_text(element, text)
