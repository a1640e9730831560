"""Refusal of robots that cannot be written or simulated: one finding for each defect."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from .diagnostic import Severity
from .errors import ModelError
from .finding import Finding
from .source.location import Place

FATAL = frozenset(
    ("no-links", "no-root", "multiple-roots", "multiple-parents", "duplicate-link-name",
     "duplicate-joint-name", "unknown-parent-link", "unknown-child-link", "missing-parent-or-child",
     "missing-name", "detached-cycle", "immense-number", "too-many-links")
)  # fmt: skip

"""Defects that leave no robot to write or simulate."""


class Refused(ModelError):  # noqa: N818 -- reads as what happened
    """The robot has defects past which it cannot be written."""

    def __init__(self, findings: Sequence[Finding]) -> None:
        """Take the findings, of which there is at least one."""
        first, *others = findings
        super().__init__(first.message, at=first.location, notes=[str(other) for other in others])
        self.findings = list(findings)


def refuse(findings: Iterable[Finding], *, force: bool, fatal: frozenset[str] = FATAL) -> None:
    """Raise where defects forbid a use.

    Args:
        findings: Defects.
        force: Go past those that leave a robot.
        fatal: Names of those that leave none.

    Raises:
        Refused: With those that forbid it.
    """
    forbidding = [f for f in findings if not force or f.code in fatal]
    if forbidding:
        raise Refused(forbidding)


def make_defect(
    rule: str,
    message: str,
    place: Place,
    kind: str = "",
    name: str = "",
    hint: str = "",
    data: Mapping[str, object] | None = None,
) -> Finding:
    """Make a finding of severity error."""
    return Finding(rule, Severity.ERROR, message, place, kind, name, hint=hint, data=data or {})
