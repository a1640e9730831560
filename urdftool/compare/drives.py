"""Comparison of the drives of joints in files of different formats."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import zip_longest

from ..model.drives import GAINS, Drive, is_driven_alone, list_drives
from ..model.elements import Joint, Robot
from .difference import Comparison, Difference
from .joints import measure
from .pair import Pair, locate

_ROW = "actuators"
_TOLERANCE = 1e-5
"""Largest difference of gains and forces, relative above 1; of the 32-bit numbers of USD."""

_UNITS = {"gear": "", **GAINS}


def compare_drives(pair: Pair, comparison: Comparison) -> None:
    """Compare existence, kind, gear, gains and range of the drives of matched joints."""
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
    undriven = dict(zip(pair.formats, (not one, not two), strict=True))
    if undriven.get("urdf") and (one or two):
        comparison.skipped[_ROW] = "a URDF need not say what drives its joints"
        return
    for x, y in pair.joints.items():
        joints = pair.a.joints[x], pair.b.joints[y]
        if all(is_driven_alone(joint) for joint in joints):
            for drives in _match(one.get(x, []), two.get(y, [])):
                _compare(pair, joints, drives, comparison)


def _index(robot: Robot) -> dict[str, list[Drive]]:
    """Return the drives of each joint: every actuator, or the last of what blocks say."""
    found: dict[str, list[Drive]] = {}
    for drive in list_drives(robot):
        known = found.setdefault(drive.joint, [])
        if drive.source != "actuator":
            known.clear()
        known.append(drive)
    return found


_Pair = tuple[Drive | None, Drive | None]


def _match(one: list[Drive], two: list[Drive]) -> Iterator[_Pair]:
    """Yield the drives of a joint that correspond: of one kind, then in their order."""
    left, right = list(one), list(two)
    for drive in one:
        same = next((other for other in right if other.mode == drive.mode), None)
        if same is not None:
            left = [other for other in left if other is not drive]
            right = [other for other in right if other is not same]
            yield drive, same
    yield from zip_longest(left, right)


def _compare(
    pair: Pair, joints: tuple[Joint, Joint], drives: _Pair, comparison: Comparison
) -> None:
    names = joints[0].name, joints[1].name
    places = locate(drives[0], joints[0]), locate(drives[1], joints[1])

    def add(what: str, values: tuple[object, object], amount: float, unit: str = "") -> None:
        difference = Difference(_ROW, "joint", names, what, values, unit, amount, places)
        comparison.add(difference)

    one, two = drives
    comparison.record_parts(_ROW, one, two)
    if one is None or two is None:
        modes = (None if one is None else one.mode, None if two is None else two.mode)
        owners = tuple(drive.owner for drive in drives if drive is not None and drive.owner)
        what = "actuator"
        comparison.add(
            Difference(_ROW, "joint", names, what, modes, "", math.inf, places, owners=owners)
        )
        return
    if one.mode != two.mode:
        add("kind of actuator", (one.mode, two.mode), math.inf)
        return
    for what, unit in _UNITS.items():
        x, y = getattr(one, what), getattr(two, what)
        if (x is None) != (y is None) and what != "gear" and "urdf" in pair.formats:
            comparison.record_not_comparable(_ROW, "gains of actuators: not in every URDF")
        if x is None or y is None:
            continue
        amount = measure(x, y)
        add(f"{what} of actuator", (x, y), amount if amount > _TOLERANCE else 0.0, unit)
    if one.commands is not None and two.commands is not None:
        ends = zip(one.commands, two.commands, strict=True)
        amount = max(measure(x, y) for x, y in ends)
        values = one.commands, two.commands
        add("range of commands", values, amount if amount > _TOLERANCE else 0.0)
