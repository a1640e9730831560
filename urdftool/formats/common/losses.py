"""The losses that an export reported, for the verification of the result."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ...finding import Finding


@dataclass(frozen=True)
class DeclaredLosses:
    """Losses that an export reported; a verification accepts the differences that they explain.

    Attributes:
        losses: Pairs of the code of a loss and the name of its link, joint or file.
    """

    losses: frozenset[tuple[str, str]] = frozenset()

    @classmethod
    def from_findings(cls, findings: Iterable[Finding]) -> DeclaredLosses:
        """Collect the codes and names of findings."""
        return cls(frozenset((finding.code, finding.name) for finding in findings))

    def has_any(self, *codes: str) -> bool:
        """Return whether a loss with one of these codes was reported anywhere."""
        return any(code in codes for code, _ in self.losses)

    def has_for(self, codes: Iterable[str], *names: str) -> bool:
        """Return whether a loss with one of these codes was reported for one of these names."""
        return any((code, name) in self.losses for code in codes for name in names)
