"""Which joint goes from where to where, in which unit, and how that is said."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ..model.elements import Joint, Robot
from ..model.kinematics import limits_of, movable_joints, with_mimics

TURN = math.pi
"""How far a joint without limits is turned either way [rad]."""

FARTHEST = 1e6
"""A limit beyond that [rad, m] is taken for none."""


@dataclass(frozen=True)
class Slider:
    """A joint with one position, as the page moves it.

    Attributes:
        name: The joint's.
        turns: Whether it turns [rad]; else it slides [m].
        lower: Its smallest position.
        upper: Its largest position.
        note: What should be known of it; empty where nothing.
        locked: Whether nobody can move it: it follows another, or its limits leave no room.
        follows: Whether it follows another.
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
        """Decimals in which a position is shown and chosen."""
        span = self.upper - self.lower
        return 3 if span >= 0.5 else 4 if span >= 0.02 else 6

    @property
    def step(self) -> float:
        """The smallest move [rad, m]."""
        return float(10.0**-self.digits)

    @property
    def shown_bounds(self) -> tuple[float, float]:
        """The bounds in as many decimals as are shown, not narrower than they are."""
        scale = 10.0**self.digits
        low = math.floor(self.lower * scale + 1e-6) / scale
        high = math.ceil(self.upper * scale - 1e-6) / scale
        return low, high

    def shown(self, position: float) -> float:
        """A position in as many decimals as are shown, within the shown bounds."""
        low, high = self.shown_bounds
        return min(max(round(position, self.digits), low), high)

    def meant(self, shown: float) -> float:
        """The position that somebody means who chooses a shown one."""
        return min(max(shown, self.lower), self.upper)

    @property
    def zero(self) -> float:
        """Zero, or the middle where zero is beyond a limit, as joint_state_publisher has it."""
        return 0.0 if self.lower <= 0.0 <= self.upper else (self.lower + self.upper) / 2

    def words(self, position: float) -> str:
        """A position in the unit people think in: degrees, or millimetres."""
        return in_words(position, self.turns)

    def brief(self, position: float) -> str:
        """The same without decimals, where it need not be exact; a label breaks after a point."""
        if self.turns:
            return _signed(f"{math.degrees(position):.0f}") + "°"
        return _signed(f"{position * 1000:.{0 if abs(position) >= 0.01 else 1}f}") + " mm"


def in_words(value: float, turns: bool) -> str:
    """An angle [rad] in degrees, or a length [m] in millimetres, in few digits."""
    if not math.isfinite(value):
        return "no limit"
    if turns:
        degrees = round(math.degrees(value), 1) + 0.0
        return f"{_signed(f'{degrees:g}')}°"
    if abs(value) >= 10:
        return f"{_signed(f'{value:.4g}')} m"
    return f"{_signed(f'{round(value * 1000, 2) + 0.0:g}')} mm"


def _signed(number: str) -> str:
    """A number with a minus that no line breaks after; minus nothing is nothing."""
    return number.lstrip("-") if not number.strip("-0.") else number.replace("-", "−")


def sliders_of(
    robot: Robot, start: Mapping[str, float] | None = None, reach: float = 1.0
) -> list[Slider]:
    """A slider for each joint that has one position, in the order of the file.

    Args:
        robot: Any robot, also a broken one.
        start: Positions that have to be within the bounds, whatever the limits say.
        reach: How far a sliding joint without limits goes either way [m].
    """
    start = start or {}
    movable = movable_joints(robot)
    extremes = _extremes(robot, {name: _bounds(joint, reach) for name, joint in movable.items()})
    found = []
    for name, joint in movable.items():
        low, high, note = _bounds(joint, reach)
        locked = high <= low
        follows = joint.mimic is not None and joint.mimic.joint in movable
        if follows:
            locked = True
            note = _formula(joint)
            ends = extremes.get(name, ())
            low, high = min(low, *ends, low), max(high, *ends, high)
        given = start.get(name, 0.0)
        if name in start and math.isfinite(given):
            low, high = min(low, given), max(high, given)
            locked = locked and follows
        found.append(Slider(name, joint.type != "prismatic", low, high, note, locked, follows))
    return found


def unmovable(robot: Robot) -> list[str]:
    """What cannot be moved by one number, in words: the joints of type floating and planar."""
    return [
        f"{joint.name} is {joint.type}: it has no single position, and stays where it is"
        for joint in robot.joints
        if joint.type in ("floating", "planar")
    ]


def _bounds(joint: Joint, reach: float) -> tuple[float, float, str]:
    """From where to where a joint is moved, and what should be known of that."""
    free = TURN if joint.type != "prismatic" else reach
    if joint.type == "continuous":
        return -free, free, "turns without end"
    lower, upper = limits_of(joint)
    if not (abs(lower) <= FARTHEST and abs(upper) <= FARTHEST):
        return -free, free, "no limit is written"
    if lower > upper:
        return upper, lower, f"its lower limit {lower:g} is above its upper limit {upper:g}"
    if lower == upper:
        return lower, upper, f"its limits leave no room: both are {lower:g}"
    return lower, upper, ""


def _extremes(
    robot: Robot, bounds: Mapping[str, tuple[float, float, str]]
) -> dict[str, tuple[float, ...]]:
    """Where each joint that follows another comes to at the ends of what it follows."""
    moved = {
        name: joint
        for name, joint in movable_joints(robot).items()
        if joint.mimic is None or joint.mimic.joint not in bounds
    }
    low = with_mimics(robot, {name: bounds[name][0] for name in moved})
    high = with_mimics(robot, {name: bounds[name][1] for name in moved})
    ends = {name: (low[name], high[name]) for name in low if name not in moved}
    return {name: pair for name, pair in ends.items() if all(abs(end) <= FARTHEST for end in pair)}


def _formula(joint: Joint) -> str:
    mimic = joint.mimic
    if mimic is None:
        return ""
    times = "" if mimic.multiplier == 1.0 else f", {mimic.multiplier:g} times"
    shift = f", {mimic.offset:+g}" if mimic.offset else ""
    return f"follows {mimic.joint}{times}{shift}"
