"""What a verification found: one row for each thing that was compared."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
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


def check_table(checks: Sequence[Check], not_compared: Sequence[str] = ()) -> str:
    """The comparisons as a table of text, with what differs below, and what is not compared."""
    rows = [("check", "compared", "worst", "tolerance", "verdict")]
    for check in checks:
        worst = "-" if check.tolerance == 0 and check.worst == 0 else f"{check.worst:.1e}"
        bound = "exact" if check.tolerance == 0 else f"{check.tolerance:.0e}"
        rows.append((check.name, check.what, worst, bound, check.verdict))
    widths = [max(len(row[column]) for row in rows) for column in range(5)]
    lines = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
    lines.insert(1, "  ".join("-" * width for width in widths))
    for check in checks:
        lines += [f"{check.name}: differs: {item}" for item in check.differing]
        if check.announced:
            lines.append(f"{check.name}: announced: {_some(check.announced)}")
    if not_compared:
        lines.append(f"not compared: {', '.join(not_compared)}")
    return "\n".join(lines) + "\n"


def _some(items: Sequence[str], shown: int = 3) -> str:
    """The first of several things that are no news; the JSON form has them all."""
    more = f" and {len(items) - shown} more" if len(items) > shown else ""
    return ", ".join(items[:shown]) + more
