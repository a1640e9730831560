"""Elements of MJCF that an export must hold: those of its source, and no other tendon or pair."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace

from ...model.elements import Robot
from ...model.mechanism import NativeElement
from .copied import has_copied_actuators, has_copied_home, list_native
from .options import Options
from .read_native_table import MERGED

_NAMED = ("tendon", "contact")
"""Sections that only copies fill."""


def select_native(source: Robot, options: Options) -> list[NativeElement]:
    """Return the elements of a source that its export copies: all but replaced ones."""
    return [e for e in list_native(source) if _is_copied(e, source, options)]


def _is_copied(element: NativeElement, source: Robot, options: Options) -> bool:
    """Tell whether an export copies an element; it does not in parts of links without a name."""
    if element.section == "actuator":
        return has_copied_actuators(source, options)
    if element.section == "keyframe" and element.name == "home":
        return has_copied_home(source, options)
    return not element.section.startswith("link ")


def list_force_ranges(robot: Robot) -> dict[str, tuple[float, float]]:
    """Return the bounds of force that an MJCF writes of its joints [N·m or N], by joint."""
    ranges = {joint.name: (-math.inf, math.inf) for joint in robot.joints if joint.has_axis}
    for one in robot.native:
        if one.tag == "joint" and not one.section:
            low, high = map(float, one.attributes.get("actuatorfrcrange", "0 0").split())
            if low < high and one.attributes.get("actuatorfrclimited") != "false":
                ranges[one.name] = low, high
    return ranges


def keep_native(expected: Robot, result: Robot) -> list[NativeElement]:
    """Return the elements of an export without those that the writer adds.

    These are sensors, keys and other elements without a counterpart in the source, and further
    attributes of settings and parts.
    """
    here: defaultdict[tuple[str, str, str], list[NativeElement]] = defaultdict(list)
    for element in expected.native:
        here[element.section, element.tag, element.name].append(element)
    kept = []
    for element in result.native:
        found = here[element.section, element.tag, element.name]
        other = found.pop(0) if found else None
        if other is not None or element.section in _NAMED:
            is_whole = other is None or element.section not in ("", *MERGED)
            kept.append(element if is_whole or other is None else _restrict(element, other))
    return kept


def _restrict(element: NativeElement, source: NativeElement) -> NativeElement:
    """Return an element with the attributes and children that the source has, too."""
    attributes = {a: v for a, v in element.attributes.items() if a in source.attributes}
    return replace(element, attributes=attributes, children=[*_pair(element, source)])


def _pair(element: NativeElement, source: NativeElement) -> Iterator[NativeElement]:
    left = list(source.children)
    for child in element.children:
        other = next((one for one in left if (one.tag, one.name) == (child.tag, child.name)), None)
        if other is not None:
            left.remove(other)
            yield _restrict(child, other)
