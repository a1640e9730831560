"""The change of the position of a joint."""

from __future__ import annotations

from typing import NamedTuple

from ..model.numbers import number
from .numbers import format_number, negate_text


class Change(NamedTuple):
    """A new position: ``sign`` times the old one, plus ``zero`` [rad, m]."""

    sign: float = 1.0
    zero: float = 0.0

    def apply(self, value: float) -> float:
        """Return the new position."""
        return self.sign * value + self.zero

    def invert(self, value: float) -> float:
        """Return the old position of a new one."""
        return self.sign * (value - self.zero)

    def format(self, text: str | None) -> str | None:
        """Return the text of a new position; None if the text is not a number."""
        value = number(text)
        if value is None:
            return None
        new = self.apply(value)
        if self.zero == 0.0:
            return text if self.sign > 0 else negate_text(text or "")
        return format_number(new)


SAME = Change()
