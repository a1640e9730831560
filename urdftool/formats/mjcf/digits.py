"""Numbers as text without floating-point noise: ``2.375e-06``, not ``2.3749999999999997e-06``."""

from __future__ import annotations

from collections.abc import Iterable

from ..common import numbers
from ..common.numbers import round_noise


def number_text(value: float) -> str:
    """Format a number as the shortest text that reads back as the same double, without noise."""
    return numbers.number_text(round_noise(value))


def format_numbers_text(values: Iterable[float]) -> str:
    """Format numbers without noise, separated by blanks."""
    return " ".join(map(number_text, values))
