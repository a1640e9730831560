"""What a verification found: one row for each thing that was compared."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field


@dataclass
class Check:
    """One comparison of an export with its source.

    Attributes:
        name: Its short name, such as ``mass matrix``.
        what: What was compared, for the table.
        tolerance: Up to which difference it counts as equal.
        worst: The largest difference.
        differing: What differs and nobody said so, in words.
        announced: What differs and was said by the export.
    """

    name: str
    what: str
    tolerance: float
    worst: float = 0.0
    differing: list[str] = field(default_factory=list)
    announced: list[str] = field(default_factory=list)

    @property
    def verdict(self) -> str:
        """``equal``, ``announced`` or ``differs``."""
        if self.differing:
            return "differs"
        return "announced" if self.announced else "equal"

    def compare(self, difference: float, item: str, *, known: bool = False) -> None:
        """Take a difference into account.

        Args:
            difference: How far apart the two are; NaN counts as far.
            item: What it is of, in words.
            known: Whether the export said that it is changed.
        """
        if difference <= self.tolerance:
            self.worst = max(self.worst, difference)
            return
        self.worst = difference if difference != difference else max(self.worst, difference)
        place = self.announced if known else self.differing
        if item not in place:
            place.append(item)

    def as_dict(self) -> dict[str, object]:
        """The JSON form."""
        worst = self.worst if abs(self.worst) < float("inf") else None
        return {
            "check": self.name,
            "compared": self.what,
            "worst": worst,
            "tolerance": self.tolerance,
            "verdict": self.verdict,
            "differing": self.differing,
            "announced": self.announced,
        }


def is_faithful(checks: Iterable[Check]) -> bool:
    """Whether nothing differs that was not announced."""
    return all(check.verdict != "differs" for check in checks)
