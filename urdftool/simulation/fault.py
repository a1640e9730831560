"""A fault or remark of a verdict."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

from ..diagnostic import Diagnostic, Severity, make_deprecated_name
from .old_names import OLD_KINDS

FALLEN = frozenset(
    {
        *("no-collision-geometry", "diverged", "fell-through", "not-settled", "tipped-over"),
        *("leans", "slid", "ground-penetration", "joint-drift", "collapsed", "unstable-gains"),
        "unsupported",
    }
)
"""Kinds of failures of the run; the others are errors in the file of a robot that stands."""


@dataclass(slots=True)
class Fault(Diagnostic):
    """Something that went wrong, or a remark.

    Attributes:
        code: Such as ``fell-through``; ``docs/commands/simulate.md`` lists them.
        severity: ``ERROR`` if the robot does not stand because of it; ``INFO`` for a remark.
        message: One sentence: what was measured.
        location: Where the link or joint is written.
        what: ``link``, ``joint`` or ``robot``.
        name: Of that.
        cause: The probable reason; empty if the message has it.
        rule: The lint rule that explains more; empty if there is none.
    """

    what: str = "robot"
    name: str = ""
    cause: str = ""
    rule: str = ""

    place = make_deprecated_name("place", "location")

    @property
    def kind(self) -> str:
        """Return the code by its old name; deprecated."""
        warnings.warn("'kind' is now 'code', with new names", DeprecationWarning, stacklevel=2)
        return OLD_KINDS.get(self.code, self.code)

    @property
    def old_kind(self) -> str | None:
        """Return the old name of the code; None if it has not changed."""
        return OLD_KINDS.get(self.code)

    @property
    def fails(self) -> bool:
        """Tell whether the robot does not stand because of it; otherwise it is a remark."""
        return self.severity is Severity.ERROR

    @property
    def fell(self) -> bool:
        """Tell whether a robot with it does not stand in the plain sense."""
        return self.fails and self.code in FALLEN

    @property
    def group(self) -> tuple[str, bool, str]:
        """Return a key that is equal for faults that differ in their part only."""
        return self.code, self.fails, self.cause + self.name * (self.code == "blocked")


def quote_names(names: Sequence[str], most: int = 4) -> str:
    """List names in quotes, the first few of them, and how many more there are."""
    shown = ", ".join(f"'{name}'" for name in names[:most])
    return shown + (f" and {len(names) - most} more" if len(names) > most else "")
