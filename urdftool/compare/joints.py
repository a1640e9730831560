"""Comparison of joints: type, axis, limits, dynamics and mimic."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..mechanics.reference import Array
from ..model.elements import BALL_TYPES, Joint, Limit, Mimic, Robot
from ..model.kinematics import UNLIMITED, follow_mimic_chain, get_limits
from ..model.part import Part
from ..model.settings import MAGNITUDES, RESISTANCE, split_unit
from .bodies import HINGES, compute_axis
from .difference import Comparison, Difference
from .frames import format_vector
from .pair import Pair, locate

_POSITION, _FORCE, _RATE = ("rad", "m"), ("N·m", "N"), ("rad/s", "m/s")
_NONE = ("", "")

_UNITS = {
    "limit": {"lower": _POSITION, "upper": _POSITION, "effort": _FORCE, "velocity": _RATE},
    "dynamics": {row.name: split_unit(row.unit) for row in RESISTANCE},
    "mimic": {"joint": _NONE, "multiplier": _NONE, "offset": _POSITION},
    "safety_controller": {
        "soft_lower_limit": _POSITION,
        "soft_upper_limit": _POSITION,
        "k_position": _NONE,
        "k_velocity": _NONE,
    },
    "calibration": {"rising": _POSITION, "falling": _POSITION, "reference_position": _POSITION},
}
"""Units of the values of each part of a joint: of one that turns, and of one that slides."""

OUTSIDE_ROWS = ("safety_controller", "calibration")
"""Parts of a joint that are not a property of its motion."""


class JointMatch(NamedTuple):
    """A joint of both robots.

    Attributes:
        one: The joint in the first robot.
        two: The joint in the second.
        turn: Rotation that maps the joint frame of ``two`` to that of ``one``, 3 × 3.
    """

    one: Joint
    two: Joint
    turn: Array


def get_unit(joint: Joint, part: str, attribute: str) -> str:
    """Return the unit of a value of a joint, such as ``limit`` and ``effort``."""
    return _UNITS[part][attribute][joint.type == "prismatic"]


def list_values(a: Joint, b: Joint, *parts: str) -> Iterator[WrittenValue]:
    """Yield the values that a joint has as attributes of its parts."""
    for part in parts or _UNITS:
        owners = one, two = getattr(a, part), getattr(b, part)
        for name in _UNITS[part]:
            values = getattr(one, name, None), getattr(two, name, None)
            yield WrittenValue(part, name, values, get_unit(b, part, name), owners)


class WrittenValue(NamedTuple):
    """Value of a joint in two robots."""

    part: str
    name: str
    values: tuple[float | str | None, float | str | None]
    unit: str
    owners: tuple[Part | None, Part | None]

    @property
    def what(self) -> str:
        """Return part and attribute as words."""
        return f"{self.part} {self.name}".replace("_", " ")


def get_kind(joint: Joint) -> str:
    """Return the motion of a joint: ``hinge``, ``ball``, or the type."""
    if joint.type in BALL_TYPES:
        return "ball"
    return "hinge" if joint.type in HINGES else joint.type


def compute_sign(match: JointMatch) -> float:
    """Return -1 if the axes of a joint are opposite, else 1."""
    return -1.0 if compute_axis(match.one) @ match.turn @ compute_axis(match.two) < 0 else 1.0


def compare_joint(pair: Pair, match: JointMatch, comparison: Comparison) -> float:
    """Compare everything of a joint but its origin; return the sign of its axis."""
    one, two, _ = match
    if get_kind(one) != get_kind(two):
        _add(comparison, match, "tree", "type", (one.type, two.type), "", math.inf)
        return 1.0
    sign = 1.0
    if one.has_direction:
        sign = _compare_axis(match, comparison)
        _compare_limits(pair, match, sign, comparison)
    elif one.type in BALL_TYPES:
        _compare_cone(match, comparison)
    _compare_dynamics(match, comparison)
    return sign


def _add(
    comparison: Comparison,
    match: JointMatch,
    row: str,
    what: str,
    values: tuple[object, object],
    unit: str,
    amount: float,
    note: str = "",
    parts: tuple[Part | None, Part | None] = (None, None),
) -> None:
    names = match.one.name, match.two.name
    places = locate(parts[0], match.one), locate(parts[1], match.two)
    comparison.add(Difference(row, "joint", names, what, values, unit, amount, places, note))


def _compare_axis(match: JointMatch, comparison: Comparison) -> float:
    """Compare the directions of the axes; return -1 if they are opposite."""
    x, y = compute_axis(match.one), match.turn @ compute_axis(match.two)
    sign = compute_sign(match)
    angle = math.atan2(float(np.linalg.norm(np.cross(x, y))), abs(float(x @ y)))
    values = format_vector(x), format_vector(y)
    parts = match.one.axis, match.two.axis
    if np.any(x) != np.any(y):
        _add(comparison, match, "axes", "axis", values, "", math.inf, "no direction", parts)
        return sign
    if sign < 0:
        note = "opposite direction: the sign of every position is reversed"
        _add(comparison, match, "axes", "axis", values, "", math.pi, note, parts)
    note = f"{math.degrees(angle):.4g}° apart"
    _add(comparison, match, "axes", "axis", values, "", angle, note, parts)
    return sign


def _compare_cone(match: JointMatch, comparison: Comparison) -> None:
    """Compare the largest angles of two ball joints from their zero."""
    parts = match.one.limit, match.two.limit
    x, y = (math.inf if one is None or one.upper is None else one.upper for one in parts)
    if math.isfinite(min(x, y)):
        values = _show(x), _show(y)
        _add(comparison, match, "limits", "upper limit", values, "rad", measure(x, y), "", parts)


def _compare_limits(pair: Pair, match: JointMatch, sign: float, comparison: Comparison) -> None:
    one, two, _ = match
    low, high = map(_bound, get_limits(one))
    low2, high2 = map(_bound, get_limits(two))
    if sign < 0:
        low2, high2 = -high2, -low2
    parts, unit = (one.limit, two.limit), get_unit(one, "limit", "lower")
    for what, x, y in (("lower limit", low, low2), ("upper limit", high, high2)):
        note = "negated, since the axis is opposite" if sign < 0 else ""
        values = _show(x), _show(y)
        _add(comparison, match, "limits", what, values, unit, measure(x, y), note, parts)
    for what in MAGNITUDES:
        unit = get_unit(one, "limit", what)
        limits = [_get_bound(limit, what) for limit in parts]
        if _is_unknown(pair, match, what):
            comparison.record_not_comparable("limits", f"limit of {what}: not in every MJCF")
            continue
        x, y = limits
        values = _show(x), _show(y)
        places: tuple[Part | None, Part | None] = parts
        if what == "effort":
            places = _find_bounding_part(pair.a.robot, one), _find_bounding_part(pair.b.robot, two)
        _add(
            comparison, match, "limits", f"limit of {what}", values, unit, measure(x, y), "", places
        )


def _find_bounding_part(robot: Robot, joint: Joint) -> Part | None:
    """Return what bounds the effort of a joint: its only actuator with that bound, or its limit."""
    own = [actuator for actuator in robot.joint_actuators if actuator.joint == joint.name]
    effort = joint.get_magnitude("effort")
    if len(own) != 1 or effort is None:
        return joint.limit
    ranges = (own[0].force_range, 1.0), (own[0].control_range, abs(own[0].gain))
    bounds = [abs(own[0].gear) * factor * max(map(abs, one)) for one, factor in ranges if one]
    return own[0] if any(math.isclose(bound, effort) for bound in bounds) else joint.limit


def _is_unknown(pair: Pair, match: JointMatch, what: str) -> bool:
    """Tell whether an MJCF does not limit the effort or velocity of a joint of another format."""
    return pair.formats[0] != pair.formats[1] and any(
        name == "mjcf" and (joint.limit is None or getattr(joint.limit, what) is None)
        for name, joint in zip(pair.formats, match[:2], strict=True)
    )


def _get_bound(limit: Limit | None, what: str) -> float:
    """Return a limit of effort or velocity; infinite if none is written."""
    value = None if limit is None else getattr(limit, what)
    return math.inf if value is None else _bound(value)


def _bound(value: float) -> float:
    return value if abs(value) < UNLIMITED else math.copysign(math.inf, value)


def _show(value: float) -> object:
    """Return a number; ``unlimited`` for an infinite one."""
    return value if math.isfinite(value) else "unlimited"


def measure(x: float, y: float) -> float:
    """Return the difference of two numbers, relative if they are larger than 1."""
    if x == y:
        return 0.0
    if not (math.isfinite(x) and math.isfinite(y)):
        return math.inf
    return abs(x - y) / max(1.0, abs(x), abs(y))


def _compare_dynamics(match: JointMatch, comparison: Comparison) -> None:
    for value in list_values(match.one, match.two, "dynamics"):
        x, y = (number if isinstance(number, int | float) else 0.0 for number in value.values)
        amount = measure(x, y)
        _add(
            comparison, match, "joint physics", value.name, (x, y), value.unit, amount, "",
            value.owners,
        )  # fmt: skip


def _follow_chain(joint: Joint, robot: Robot) -> Mimic:
    """Return how a joint depends on the last leader of its chain of ``<mimic>``."""
    assert joint.mimic is not None
    leader, multiplier, offset = follow_mimic_chain(joint, robot.joint)
    return replace(joint.mimic, joint=leader, multiplier=multiplier, offset=offset)


def compare_mimic(
    pair: Pair, one: Joint, two: Joint, signs: dict[str, float], comparison: Comparison
) -> None:
    """Compare the dependence of a joint on another."""
    match = JointMatch(one, two, np.eye(3))
    parts = x, y = one.mimic, two.mimic
    if x is None and y is None:
        return
    if x is None or y is None:
        words = [None if m is None else f"{m.multiplier:g} × {m.joint}" for m in parts]
        _add(comparison, match, "tree", "mimic", (words[0], words[1]), "", math.inf, "", parts)
        return
    if pair.joints.get(x.joint, x.joint) != y.joint:  # one may name the last leader of a chain
        x, y = _follow_chain(one, pair.a.robot), _follow_chain(two, pair.b.robot)
    leader = pair.joints.get(x.joint, x.joint)
    same = 0.0 if leader == y.joint else math.inf
    _add(comparison, match, "tree", "mimic joint", (x.joint, y.joint), "", same, "", parts)
    if same:
        return
    own = signs.get(one.name, 1.0)
    factor = own * signs.get(x.joint, 1.0) * y.multiplier
    values = x.multiplier, factor
    amount = measure(*values)
    _add(comparison, match, "tree", "mimic multiplier", values, "", amount, "", parts)
    values = x.offset, own * y.offset
    amount = measure(*values)
    unit = get_unit(one, "mimic", "offset")
    _add(comparison, match, "tree", "mimic offset", values, unit, amount, "", parts)
