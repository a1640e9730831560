"""Numbers in URDF syntax; numbers and values of settings as text without floating-point noise.

``2.375e-06``, not ``2.3749999999999997e-06``: xacro expressions and rotations of inertia tensors
leave such rounding errors. A number within a few units in the last place of one with at most ten
digits is replaced by that one: a relative change below 2e-15.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

_Content = bool | str | float | tuple[float, ...]

DIGITS = 10
"""Maximum number of significant digits of a number that a person wrote."""

NOISE = 8
"""Units in the last place that are attributed to rounding."""

NOTHING = 1e-15
"""Position [m] and angle [rad] that is rounding; chosen, far below the 1e-9 m of the proof."""


def number(text: str | None) -> float | None:
    """Return a finite number in URDF syntax, or None."""
    if text is None:
        return None
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) and "_" not in text else None


def parse_numbers(text: str | None, count: int) -> tuple[float, ...] | None:
    """Return exactly ``count`` finite numbers separated by whitespace, or None."""
    if text is None:
        return None
    words = text.split()
    if len(words) != count:
        return None
    try:
        values = tuple(map(float, words))
    except ValueError:
        return None
    return values if all(map(math.isfinite, values)) and "_" not in text else None


def describe_content(content: _Content) -> str | float:
    """Return a number; a flag, word or vector as text."""
    if isinstance(content, tuple):
        return " ".join(f"{part:g}" for part in content)
    return str(content).lower() if isinstance(content, bool) else content


def round_noise(value: float) -> float:
    """Round a number to ten significant digits if the change is within rounding noise."""
    if not math.isfinite(value) or value == 0:
        return value
    short = round_number(value)
    return short if abs(short - value) <= NOISE * math.ulp(value) else value


def remove_noise(values: Iterable[float]) -> list[float]:
    """Return positions [m], angles [rad] or parts of quaternions without rounding errors."""
    return [0.0 if abs(value) < NOTHING else round_noise(value) for value in values]


def round_number(value: float, digits: int = DIGITS) -> float:
    """Round a number to significant digits; the result is never a negative zero."""
    return float(f"{value:.{digits}g}") + 0.0


def number_text(value: float) -> str:
    """Format a number as the shortest text that reads back as the same double, without noise.

    Whole numbers have no decimal point; -0 is written as 0.
    """
    value = round_noise(float(value))
    if value == 0:
        return "0"
    if math.isfinite(value) and value == int(value) and abs(value) < 1e16:
        return str(int(value))
    return repr(value)


def format_numbers_text(values: Iterable[float]) -> str:
    """Format numbers, separated by blanks."""
    return " ".join(map(number_text, values))


def format_pose_text(values: Iterable[float]) -> str:
    """Format positions [m] and angles [rad], separated by blanks; rounding errors of 0 are 0."""
    return format_numbers_text(remove_noise(values))


def format_content(content: _Content) -> str:
    """Return the text of a setting's value: of a flag, a word, a number or a vector."""
    if isinstance(content, bool | str):
        return str(content).lower() if isinstance(content, bool) else content
    return format_numbers_text(content) if isinstance(content, tuple) else number_text(content)
