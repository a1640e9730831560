"""One line of the comparison: what was compared, by how much it differs, and what that means."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass
class Check:
    """A check.

    Attributes:
        name: What is compared.
        compared: How many things were.
        worst: The largest difference, in the unit of the tolerance; None where there is no number.
        tolerance: What may differ; None where all must be equal.
        differences: What differs and was not announced, a sentence each.
        announced: What differs and was.
        skipped: Why it was not done; empty if it was.
    """

    name: str
    compared: int = 0
    worst: float | None = None
    tolerance: float | None = None
    differences: list[str] = field(default_factory=list)
    announced: list[str] = field(default_factory=list)
    skipped: str = ""

    @property
    def failed(self) -> bool:
        """Whether something differs that nobody said."""
        return bool(self.differences)

    @property
    def equal(self) -> bool:
        """Whether nothing differs at all."""
        return not (self.differences or self.announced or self.skipped)

    @property
    def verdict(self) -> str:
        """``equal``, ``announced``, ``DIFFERS`` or ``not done``."""
        if self.skipped:
            return "not done"
        if self.failed:
            return "DIFFERS"
        return "announced" if self.announced else "equal"

    def see(self, difference: float, text: str, *, announced: bool) -> None:
        """Take a difference; one above the tolerance is kept with what it is about."""
        self.compared += 1
        if not announced or self.worst is None:
            self.worst = max(self.worst or 0.0, difference)
        if not difference <= (self.tolerance or 0.0):
            (self.announced if announced else self.differences).append(text)

    def record(self) -> dict[str, Any]:
        """Its JSON form."""
        return {
            "name": self.name,
            "verdict": self.verdict,
            "compared": self.compared,
            "worst": self.worst,
            "tolerance": self.tolerance,
            "differences": self.differences,
            "announced": self.announced,
            "skipped": self.skipped or None,
        }
