"""Comparison of loop-closing joints."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ...compare.check import Check
from ...model.elements import Robot
from ...model.read import parse_numbers
from ...source.document import Element
from ..common.losses import DeclaredLosses
from .compiled import Compiled
from .declared_losses import LOOPS

HELD = {"revolute": "CONNECT", "continuous": "CONNECT", "ball": "CONNECT", "fixed": "WELD"}


def compare_loops(robot: Robot, compiled: Compiled, declared: DeclaredLosses, check: Check) -> None:
    """Compare each joint in a ``<gazebo>`` without reference with its equality constraint."""
    for block in robot.extensions.get(None, ()):
        for joint in block.element.list_children("joint"):
            held = _holds(joint, compiled)
            name = joint.get("name") or ""
            known = declared.has_for(LOOPS, block.reference or "", name)
            check.compare(0 if held else math.inf, f"joint '{name}' of a loop", known=known)


def list_loop_ends(robot: Robot, compiled: Compiled) -> Iterator[tuple[int, int]]:
    """Yield the bodies that each loop-closing joint connects."""
    for block in robot.extensions.get(None, ()):
        for joint in block.element.list_children("joint"):
            yield _get_body(joint, "child", compiled), _get_body(joint, "parent", compiled)


def _holds(joint: Element, compiled: Compiled) -> bool:
    model, kinds = compiled.model, compiled.mujoco.mjtEq
    kind = HELD.get(joint.get("type") or "")
    ends = [_get_body(joint, end, compiled) for end in ("child", "parent")]
    pose = joint.find_child("pose")
    plain = pose is None or not pose.attributes
    for number in range(model.neq if kind else 0):
        if model.eq_type[number] != getattr(kinds, f"mjEQ_{kind}") or not model.eq_active0[number]:
            continue
        if [model.eq_obj1id[number], model.eq_obj2id[number]] != ends:
            continue
        place = parse_numbers(pose.text, 6) if pose is not None else None
        anchor = np.array(place or [0.0] * 6)[:3]
        if kind == "WELD" or not plain or abs(model.eq_data[number][:3] - anchor).max() < 1e-12:
            return True
    return False


def _get_body(joint: Element, end: str, compiled: Compiled) -> int:
    element = joint.find_child(end)
    name = element.text.strip().rpartition("::")[2] if element is not None else ""
    found = compiled.get_body(name)
    return 0 if found < 0 and name == "world" else found
