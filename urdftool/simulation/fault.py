"""A fault or remark of a verdict."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

from ..diagnostic import Diagnostic, Severity, make_deprecated_name
from .old_names import OLD_KINDS

MOVES = frozenset({"not-settled", "joint-drift", "collapsed"})
"""Kinds of faults with which a robot stands if its base does; see ``mechanics.standing``."""

FALLEN = MOVES | frozenset(
    {
        *("no-collision-geometry", "diverged", "fell-through", "tipped-over", "leans", "slid"),
        *("ground-penetration", "unstable-gains", "unsupported"),
    }
)
"""Kinds of faults of a robot that does not stand; the others are errors in its file."""

NOT_CHECKED = frozenset({"visual-not-read"})
"""Kinds of remarks that name what no check looked at."""


@dataclass(slots=True)
class Fault(Diagnostic):
    """A fault that a check found, or a remark.

    Attributes:
        code: Kind, such as ``fell-through``; ``docs/commands/simulate.md`` lists them.
        severity: ``ERROR`` fails the simulation; ``WARNING``, about masses and inertia in the file,
            fails it with ``--strict``; ``INFO`` is a remark.
        message: One sentence with the measured values.
        location: Location of the link or joint in the description.
        what: ``link``, ``joint`` or ``robot``.
        name: Name of the link, joint or robot.
        cause: Probable cause; empty if the message contains it.
        rule: Lint rule with more explanation; empty if there is none.
        spares_base: Whether the base stands in spite of it.
    """

    what: str = "robot"
    name: str = ""
    cause: str = ""
    rule: str = ""
    spares_base: bool = False

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
        """Tell whether it fails the simulation; otherwise it is a warning or a remark."""
        return self.severity is Severity.ERROR

    @property
    def is_warning(self) -> bool:
        """Tell whether it concerns what the file says; it fails with ``--strict``."""
        return self.severity is Severity.WARNING

    @property
    def is_gap(self) -> bool:
        """Tell whether it names what no check looked at."""
        return self.code in NOT_CHECKED

    @property
    def fell(self) -> bool:
        """Tell whether a robot with this fault does not stand; other errors are in its file."""
        return self.fails and self.code in FALLEN and not self.spares_base

    @property
    def group(self) -> tuple[str, Severity, str]:
        """Return a key that is equal for faults that differ only in their link or joint."""
        return self.code, self.severity, self.cause + self.name * (self.code == "blocked")
