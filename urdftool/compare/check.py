"""Result of the comparison of an export with its source: one row for each compared property."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

WITHOUT_DIFFERENCE = frozenset(("equal", "none"))
"""Verdicts of rows of which every part was compared, and no difference was found."""


@dataclass
class Check:
    """One comparison of an export with its source.

    Attributes:
        name: Short name, such as ``mass matrix``.
        what: What was compared, for the table.
        tolerance: Largest difference that counts as equal.
        worst: The largest difference.
        differing: Descriptions of unreported differences.
        announced: Descriptions of differences that the export reported.
        skipped: Why the property was not compared; empty if it was.
        is_empty: Whether no robot has a part with the property, as far as it was compared.
        is_partial: Whether a format of the two lacks a part of the property.
    """

    name: str
    what: str
    tolerance: float
    worst: float = 0.0
    differing: list[str] = field(default_factory=list)
    announced: list[str] = field(default_factory=list)
    skipped: str = ""
    is_empty: bool = False
    is_partial: bool = False

    @property
    def verdict(self) -> str:
        """Return the result of the comparison.

        It is ``equal``, ``announced`` (every difference was reported), ``differs``, ``not
        compared``, or ``none`` (no robot has a part with the property).
        """
        if self.differing:
            return "differs"
        if self.skipped:
            return "not compared"
        if self.announced:
            return "announced"
        return "none" if self.is_empty else "equal"

    @property
    def shown(self) -> str:
        """Return the result for a table, with the case that only a part could be compared."""
        if self.is_partial and self.verdict in WITHOUT_DIFFERENCE:
            return "equal, in part" if self.verdict == "equal" else "not compared"
        return self.verdict

    def compare(self, difference: float, item: str, *, known: bool = False) -> None:
        """Record a difference."""
        self.is_empty = False
        if difference <= self.tolerance:
            self.worst = max(self.worst, difference)
            return
        self.worst = difference if difference != difference else max(self.worst, difference)
        place = self.announced if known else self.differing
        if item not in place:
            place.append(item)

    def as_dict(self) -> dict[str, object]:
        """Return the JSON form; a worst difference that is infinite or NaN becomes null."""
        worst = self.worst if abs(self.worst) < float("inf") else None
        return {
            "check": self.name,
            "compared": self.what,
            "worst": worst,
            "tolerance": self.tolerance,
            "verdict": self.verdict,
            "partial": self.is_partial,
            "differing": self.differing,
            "announced": self.announced,
            "skipped": self.skipped,
        }


def is_faithful(checks: Iterable[Check]) -> bool:
    """Tell whether every difference was reported by the export."""
    return all(check.verdict != "differs" for check in checks)
