"""Comparison of the elements that an export of an MJCF copies: what is written, and what compiles.

The values are those that MuJoCo computes of the source and of the export.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence

from ...compare.check import Check
from ...model.elements import Robot
from ...model.mechanism import NativeElement
from ..common.losses import DeclaredLosses
from .options import Options
from .read_native_table import MERGED

TOLERANCE = 1e-6
"""Tolerance of the values of MuJoCo, relative to the larger; chosen above rounding errors of
points and poses that it computes."""

_LOST = "lossy-mujoco-element"
_NAMED = ("tendon", "contact")
"""Sections that only copies fill."""


def check_native(source: Robot, result: Robot, declared: DeclaredLosses, options: Options) -> Check:
    """Compare the copied elements of a source with those of its export.

    Args:
        source: The robot that was exported.
        result: The robot of the file.
        declared: Losses of the export.
        options: Options of the export; other actuators or another home position are no difference.
    """
    what = (
        "tendons, actuators, equalities, sensors, pairs, keys, settings: text and compiled values"
    )
    check = Check("MuJoCo's elements", what, TOLERANCE, is_empty=True)
    here, there = _group(source), _group(result)
    for section in here.keys() | {name for name in there if name in _NAMED}:
        if section == "actuator" and options.actuators not in ("auto", "described"):
            continue
        merged = section == "" or section in MERGED
        pairs = _match(here[section], there[section])
        for one, two in pairs:
            _compare(one, two, section, check, declared, part=merged)
    return check


def _group(robot: Robot) -> defaultdict[str, list[NativeElement]]:
    found: defaultdict[str, list[NativeElement]] = defaultdict(list)
    for element in robot.native:
        if element.section != "default":
            found[element.section].append(element)
    return found


def _match(
    here: Sequence[NativeElement], there: Sequence[NativeElement]
) -> list[tuple[NativeElement | None, NativeElement | None]]:
    """Pair elements by tag and name, and those without a name in their order."""
    rest: defaultdict[tuple[str, str], list[NativeElement]] = defaultdict(list)
    for element in there:
        rest[element.tag, element.name].append(element)
    pairs: list[tuple[NativeElement | None, NativeElement | None]] = []
    for element in here:
        found = rest[element.tag, element.name]
        pairs.append((element, found.pop(0) if found else None))
    return [*pairs, *((None, element) for found in rest.values() for element in found)]


def _compare(
    one: NativeElement | None,
    two: NativeElement | None,
    section: str,
    check: Check,
    declared: DeclaredLosses,
    *,
    part: bool,
) -> None:
    if one is None:
        if two is not None and section in _NAMED:
            check.compare(math.inf, f"{_describe(two)} is not in the source")
        return
    known = declared.has_for((_LOST,), one.name)
    if two is None:
        check.compare(math.inf, f"{_describe(one)} is missing", known=known)
        return
    text = _find_difference(one, two, part=part)
    check.compare(math.inf if text else 0.0, f"{_describe(one)}: {text}", known=known)
    for name, value in one.values.items():
        off = _measure(value, two.values.get(name, ()))
        check.compare(off, f"{_describe(one)}: {name} differs by {off:.3g}", known=known)


def _describe(element: NativeElement) -> str:
    return f"<{element.tag}>" + (f" '{element.name}'" if element.name else "")


def _find_difference(one: NativeElement, two: NativeElement, *, part: bool) -> str:
    """Return the first attribute or child that differs; of a part, only those of the source."""
    names = one.attributes if part else one.attributes.keys() | two.attributes.keys()
    for name in sorted(set(names) - {"class"}):
        if not _is_same(one.attributes.get(name), two.attributes.get(name)):
            return f"{name} is {two.attributes.get(name)}, not {one.attributes.get(name)}"
    for child, other in _match(one.children, two.children):
        if child is None and not part:
            return "it has more children"
        if child is not None and (other is None or (_find_difference(child, other, part=part))):
            return f"<{child.tag}> differs"
    return ""


def _is_same(one: str | None, two: str | None) -> bool:
    """Tell whether two values are the same text or numbers."""
    if one == two or one is None or two is None:
        return one == two
    try:
        return [*map(float, one.split())] == [*map(float, two.split())]
    except ValueError:
        return False


def _measure(one: Sequence[float], two: Sequence[float]) -> float:
    """Return the largest difference of values relative to the larger; inf if some are missing."""
    if len(one) != len(two):
        return math.inf
    return max((abs(a - b) / max(abs(a), abs(b), 1.0) for a, b in zip(one, two, strict=True)),
               default=0.0)  # fmt: skip
