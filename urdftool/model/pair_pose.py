"""Joint positions at which two links touch, for pictures and pages."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class PairPose:
    """Joint positions at which two links touch.

    Attributes:
        link1: Name of one link.
        link2: Name of the other.
        positions: Positions of the joints between them by name [rad, m].
        reason: Why an SRDF disables the pair; empty if it does not, or gives no reason.
    """

    link1: str
    link2: str
    positions: Mapping[str, float]
    reason: str = ""

    @property
    def title(self) -> str:
        """Return both names, with the reason."""
        return f"{self.link1} and {self.link2}" + (f" ({self.reason})" if self.reason else "")
