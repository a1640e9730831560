"""Comparison of the drives of joints in files of different formats."""

from __future__ import annotations

import math

from ..model.drives import Drive, is_driven_alone, list_drives
from ..model.elements import Robot
from .difference import Comparison, Difference
from .joints import measure
from .pair import Pair, locate

_ROW = "actuators"
_TOLERANCE = 1e-5
"""Largest difference of gains and forces, relative above 1; of the 32-bit numbers of USD."""

_UNITS = {"gear": "", "stiffness": "N·m/rad or N/m", "damping": "N·m·s/rad or N·s/m"}


def compare_drives(pair: Pair, comparison: Comparison) -> None:
    """Compare existence, kind, gear and gains of the drives of matched joints."""
    formats = {*pair.formats}
    if _ROW not in comparison.tolerances or len(formats) == 1:
        return  # two files of one format have the same kinds of parts
    if formats & {"sdf"}:
        comparison.skipped[_ROW] = "SDF has none: its plugins drive the joints"
        return
    if formats == {"urdf", "usd"}:
        comparison.skipped[_ROW] = "URDF has no gains, and a drive in USD is not an actuator"
        return
    one, two = (_index(bodies.robot) for bodies in (pair.a, pair.b))
    if "urdf" in formats:
        comparison.record_not_comparable("gains of actuators: not in URDF")
    for x, y in pair.joints.items():
        _compare(pair, (x, y), (one.get(x), two.get(y)), comparison)


def _index(robot: Robot) -> dict[str, Drive]:
    """Return the drive of each joint that can have one; the last of several."""
    return {
        drive.joint: drive
        for drive in list_drives(robot)
        if is_driven_alone(robot.joint[drive.joint])
    }


def _compare(
    pair: Pair,
    names: tuple[str, str],
    drives: tuple[Drive | None, Drive | None],
    comparison: Comparison,
) -> None:
    joints = pair.a.joints[names[0]], pair.b.joints[names[1]]
    if not all(is_driven_alone(joint) for joint in joints):
        return
    places = locate(drives[0], joints[0]), locate(drives[1], joints[1])

    def add(what: str, values: tuple[object, object], amount: float, unit: str = "") -> None:
        difference = Difference(_ROW, "joint", names, what, values, unit, amount, places)
        comparison.add(difference)

    one, two = drives
    comparison.record_parts(_ROW, one, two)
    if one is None or two is None:
        if _is_undriven(pair, drives):
            comparison.record_not_comparable("actuators of joints that the URDF does not drive")
        elif one is not two:
            modes = (None if drive is None else drive.mode for drive in drives)
            add("actuator", (next(modes), next(modes)), math.inf)
        return
    if one.mode != two.mode:
        add("kind of actuator", (one.mode, two.mode), math.inf)
        return
    for what, unit in _UNITS.items():
        x, y = getattr(one, what), getattr(two, what)
        if x is None or y is None:
            continue
        amount = measure(x, y)
        add(f"{what} of actuator", (x, y), amount if amount > _TOLERANCE else 0.0, unit)


def _is_undriven(pair: Pair, drives: tuple[Drive | None, Drive | None]) -> bool:
    """Tell whether only the other file drives a joint of a URDF, which need not drive it."""
    sides = zip(pair.formats, drives, strict=True)
    return any(form == "urdf" and drive is None for form, drive in sides) and any(drives)
