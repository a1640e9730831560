"""Comparison of what only joints of URDF have: the safety controller and the calibration."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from ..model.elements import Joint
from .difference import Comparison, Difference
from .joints import OUTSIDE_ROWS, list_values, measure
from .pair import Pair, locate


def compare_references(
    pair: Pair, joints: tuple[Joint, Joint], sign: float, comparison: Comparison
) -> None:
    """Compare the safety controllers and calibrations of a joint of two URDF."""
    if pair.formats == ("urdf", "urdf"):
        one, two = joints
        for difference in list_references(one, _turn(two) if sign < 0 else two):
            comparison.add(difference)
        return
    for tag in OUTSIDE_ROWS:
        if any(getattr(joint, tag) is not None for joint in joints):
            comparison.record_not_comparable("limits", f"<{tag}>: not in every format")


def list_references(one: Joint, two: Joint) -> Iterator[Difference]:
    """Yield each value of the safety controllers and calibrations of a joint in two URDF."""
    for value in list_values(one, two, *OUTSIDE_ROWS):
        x, y = value.values
        if x is None and y is None:
            continue
        both = isinstance(x, int | float) and isinstance(y, int | float)
        places = locate(value.owners[0], one), locate(value.owners[1], two)
        yield Difference(
            "limits",
            "joint",
            (one.name, two.name),
            value.name.replace("_", " "),
            value.values,
            value.unit,
            measure(float(x), float(y)) if both and x is not None and y is not None else math.inf,
            places,
        )


def _turn(joint: Joint) -> Joint:
    """Return a joint with the values of its opposite axis: rising becomes falling."""
    soft, marks = joint.safety_controller, joint.calibration
    if soft is not None:
        lower, upper = -soft.soft_upper_limit, -soft.soft_lower_limit
        soft = replace(soft, soft_lower_limit=lower, soft_upper_limit=upper)
    if marks is not None:
        marks = replace(
            marks,
            rising=_negate(marks.falling),
            falling=_negate(marks.rising),
            reference_position=_negate(marks.reference_position),
        )
    return replace(joint, safety_controller=soft, calibration=marks)


def _negate(value: float | None) -> float | None:
    return None if value is None else -value
