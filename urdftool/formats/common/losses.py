"""Losses of an export as records, and the question whether one was declared."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from ...finding import Finding


@dataclass(slots=True)
class Loss(Finding):
    """One thing of a robot that the target format does not carry, or carries changed.

    Attributes:
        data: The values of the loss by name. Code reads these, never the message.
    """

    data: dict[str, object] = field(default_factory=dict)

    @property
    def code(self) -> str:
        """Return the name of the kind of loss, such as ``lossy-mimic``."""
        return self.rule


@dataclass(frozen=True)
class DeclaredLosses:
    """The losses that an export reported, for a verification that excuses what they explain.

    Attributes:
        losses: Pairs of the code of a loss and the name of the link, joint or file it is about.
    """

    losses: frozenset[tuple[str, str]] = frozenset()

    @classmethod
    def from_findings(cls, findings: Iterable[Finding]) -> DeclaredLosses:
        """Collect the codes and names of findings."""
        return cls(frozenset((finding.rule, finding.name) for finding in findings))

    def any(self, *codes: str) -> bool:
        """Return whether a loss with one of these codes was reported anywhere."""
        return any(code in codes for code, _ in self.losses)

    def of(self, codes: Iterable[str], *names: str) -> bool:
        """Return whether a loss with one of these codes was reported for one of these names."""
        return any((code, name) in self.losses for code in codes for name in names)
