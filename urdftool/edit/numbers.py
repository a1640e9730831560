"""Shortest texts of numbers and poses."""

from __future__ import annotations

import math
import re

from ..model.elements import Vector
from ..model.pose import Pose, Rotation, rotation_from_rpy, rpy_from_rotation

EXACT = 4e-15
"""Largest change of a number by its text, absolute below 1 and relative above.

Chosen, no source: it is some 20 times the rounding of one operation, and far below the 1e-9 m of
the proof.
"""


def format_number(value: float, tolerance: float = EXACT) -> str:
    """Return the shortest decimal text of a number.

    Args:
        value: A finite number.
        tolerance: Largest change, absolute for numbers below 1, relative above.
    """
    if abs(value) <= tolerance:
        return "0"
    bound = tolerance * max(1.0, abs(value))
    for digits in range(1, 17):
        text = f"{value:.{digits}g}"
        if abs(float(text) - value) <= bound:
            return _write_plain(text)
    return _write_plain(repr(value))


def _write_plain(text: str) -> str:
    """Return a number without an exponent of two digits or more than needed."""
    mantissa, mark, exponent = text.partition("e")
    return f"{mantissa}e{int(exponent)}" if mark else text


def format_relative(value: float, tolerance: float = 1e-15) -> str:
    """Return the shortest text of a number up to a relative change."""
    if value == 0.0:
        return "0"
    for digits in range(1, 17):
        text = f"{value:.{digits}g}"
        if abs(float(text) - value) <= tolerance * abs(value):
            return _write_plain(text)
    return _write_plain(repr(value))


def format_vector(values: Vector, tolerance: float = EXACT) -> str:
    """Return the shortest text of three numbers."""
    return " ".join(format_number(value, tolerance) for value in values)


_LESS = 6
"""Characters that angles beyond ±90° of pitch must save. Chosen, no source."""


def negate_text(text: str) -> str:
    """Return numbers with the other sign, each with the digits as written."""

    def negate(match: re.Match[str]) -> str:
        word = match[0]
        if float(word) == 0.0:
            return word
        return word[1:] if word.startswith("-") else "-" + word.removeprefix("+")

    return re.sub(r"\S+", negate, text)


def format_rotation(rotation: Rotation) -> str:
    """Return the ``rpy`` of a rotation; other equal angles only if they are far shorter."""
    texts = [format_vector(rpy) for rpy in _list_angles(rotation)]
    right = [text for text in texts if measure_turn(_parse_rotation(text), rotation) < 1e-14]
    return min(right or texts, key=lambda text: len(text) + _LESS * (text != texts[0]))


def _parse_rotation(text: str) -> Rotation:
    roll, pitch, yaw = map(float, text.split())
    return rotation_from_rpy((roll, pitch, yaw))


def _list_angles(rotation: Rotation) -> list[Vector]:
    roll, pitch, yaw = rpy_from_rotation(rotation)
    other = (_wrap(roll + math.pi), _wrap(math.pi - pitch), _wrap(yaw + math.pi))
    found = [(roll, pitch, yaw), other]
    if abs(abs(pitch) - math.pi / 2) < 1e-7:  # only roll - yaw or roll + yaw is known
        sign = -1.0 if pitch > 0 else 1.0
        found += [(0.0, pitch, _wrap(yaw + sign * roll)), (_wrap(roll + sign * yaw), pitch, 0.0)]
    return found


def _wrap(angle: float) -> float:
    return math.remainder(angle, math.tau)


def measure_turn(one: Rotation, other: Rotation) -> float:
    """Return the largest difference of the elements of two rotations."""
    return max(
        abs(x - y) for a, b in zip(one, other, strict=True) for x, y in zip(a, b, strict=True)
    )


def is_same_pose(one: Pose, other: Pose, tolerance: float = EXACT) -> bool:
    """Tell whether two poses are equal except for rounding [m, elements of the rotation]."""
    away = max(
        abs(x - y) / max(1.0, abs(x))
        for x, y in zip(one.translation, other.translation, strict=True)
    )
    return away <= tolerance and measure_turn(one.rotation, other.rotation) <= tolerance
