"""Bounds, units and labels of joint sliders."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ..model.elements import Joint, Robot
from ..model.kinematics import add_mimic_positions, find_movable_joints, get_limits

TURN = math.pi
"""Range to either side of a rotational joint without limits [rad]."""

FARTHEST = 1e6
"""Magnitude [rad or m] beyond which a limit counts as missing."""


@dataclass(frozen=True)
class Slider:
    """Slider of a joint with one degree of freedom.

    Attributes:
        name: Name of the joint.
        turns: Whether it is rotational [rad] or prismatic [m].
        lower: Smallest position.
        upper: Largest position.
        note: Hint for the user; may be empty.
        locked: Whether the user cannot move it: it mimics another joint, or its range is empty.
        follows: Whether it mimics another joint.
    """

    name: str
    turns: bool
    lower: float
    upper: float
    note: str = ""
    locked: bool = False
    follows: bool = False

    @property
    def digits(self) -> int:
        """Return the number of decimals of a displayed position."""
        span = self.upper - self.lower
        return 3 if span >= 0.5 else 4 if span >= 0.02 else 6

    @property
    def step(self) -> float:
        """Return the step of the slider [rad or m]."""
        return float(10.0**-self.digits)

    @property
    def shown_bounds(self) -> tuple[float, float]:
        """Return the bounds, rounded outward to the displayed decimals."""
        scale = 10.0**self.digits
        low = math.floor(self.lower * scale + 1e-6) / scale
        high = math.ceil(self.upper * scale - 1e-6) / scale
        return low, high

    def round_position(self, position: float) -> float:
        """Round a position to the displayed decimals, within the displayed bounds."""
        low, high = self.shown_bounds
        return min(max(round(position, self.digits), low), high)

    def clamp_position(self, shown: float) -> float:
        """Return the position for a displayed value, within the exact bounds."""
        return min(max(shown, self.lower), self.upper)

    @property
    def zero(self) -> float:
        """Return zero, or the middle if zero is out of range, as joint_state_publisher does."""
        return 0.0 if self.lower <= 0.0 <= self.upper else (self.lower + self.upper) / 2

    def format_position(self, position: float) -> str:
        """Format a position in degrees or millimeters."""
        return format_value(position, self.turns)

    def format_short(self, position: float) -> str:
        """Format a position in few digits for a label, which would wrap after a decimal point."""
        if self.turns:
            return _format_sign(f"{math.degrees(position):.0f}") + "°"
        return _format_sign(f"{position * 1000:.{0 if abs(position) >= 0.01 else 1}f}") + " mm"


def format_value(value: float, turns: bool) -> str:
    """Format an angle [rad] in degrees, or a length [m] in millimeters, in few digits."""
    if not math.isfinite(value):
        return "no limit"
    if turns:
        degrees = round(math.degrees(value), 1) + 0.0
        return f"{_format_sign(f'{degrees:g}')}°"
    if abs(value) >= 10:
        return f"{_format_sign(f'{value:.4g}')} m"
    return f"{_format_sign(f'{round(value * 1000, 2) + 0.0:g}')} mm"


def _format_sign(number: str) -> str:
    """Replace the hyphen by a minus sign, which does not wrap, and drop it before zero."""
    return number.lstrip("-") if not number.strip("-0.") else number.replace("-", "−")


def create_sliders(
    robot: Robot, start: Mapping[str, float] | None = None, reach: float = 1.0
) -> list[Slider]:
    """Create a slider for each joint with one degree of freedom, in the order of the file.

    Bounds include ``start``; ``reach`` is that of a prismatic joint without limits [m].
    """
    start = start or {}
    movable = find_movable_joints(robot)
    extremes = _compute_extremes(
        robot, {name: _get_bounds(joint, reach) for name, joint in movable.items()}
    )
    found = []
    for name, joint in movable.items():
        low, high, note = _get_bounds(joint, reach)
        locked = high <= low
        follows = joint.mimic is not None and joint.mimic.joint in movable
        if follows:
            locked = True
            note = _format_mimic(joint)
            ends = extremes.get(name, ())
            low, high = min(low, *ends, low), max(high, *ends, high)
        given = start.get(name, 0.0)
        if name in start and math.isfinite(given):
            low, high = min(low, given), max(high, given)
            locked = locked and follows
        found.append(Slider(name, joint.type != "prismatic", low, high, note, locked, follows))
    return found


def explain_unmovable(robot: Robot) -> list[str]:
    """List messages on the joints without a single position: floating and planar ones."""
    return [
        f"joint '{joint.name}' is {joint.type} and cannot be moved with a slider"
        for joint in robot.joints
        if joint.type in ("floating", "planar")
    ]


def _get_bounds(joint: Joint, reach: float) -> tuple[float, float, str]:
    """Return the bounds of a joint and a hint for the user."""
    free = TURN if joint.type != "prismatic" else reach
    if joint.type == "continuous":
        return -free, free, "continuous, no limits"
    lower, upper = get_limits(joint)
    if not (abs(lower) <= FARTHEST and abs(upper) <= FARTHEST):
        return -free, free, "limits not specified"
    if lower > upper:
        return upper, lower, f"lower limit {lower:g} is above upper limit {upper:g}"
    if lower == upper:
        return lower, upper, f"locked: lower and upper limit are {lower:g}"
    return lower, upper, ""


def _compute_extremes(
    robot: Robot, bounds: Mapping[str, tuple[float, float, str]]
) -> dict[str, tuple[float, ...]]:
    """Compute the positions of mimic joints at both bounds of the joints they follow."""
    moved = {
        name: joint
        for name, joint in find_movable_joints(robot).items()
        if joint.mimic is None or joint.mimic.joint not in bounds
    }
    low = add_mimic_positions(robot, {name: bounds[name][0] for name in moved})
    high = add_mimic_positions(robot, {name: bounds[name][1] for name in moved})
    ends = {name: (low[name], high[name]) for name in low if name not in moved}
    return {name: pair for name, pair in ends.items() if all(abs(end) <= FARTHEST for end in pair)}


def _format_mimic(joint: Joint) -> str:
    mimic = joint.mimic
    if mimic is None:
        return ""
    times = "" if mimic.multiplier == 1.0 else f" × {mimic.multiplier:g}"
    shift = f" {mimic.offset:+g}" if mimic.offset else ""
    return f"mimics {mimic.joint}{times}{shift}"
