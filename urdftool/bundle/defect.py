"""Defects that the verification of a bundle finds."""

from __future__ import annotations

from dataclasses import dataclass

OF_SOURCE = "missing-in-source"
"""Code of a reference without a file in the source."""

UNREADABLE_SOURCE = "unreadable-source"
"""Code of a source with which the bundle cannot be compared."""


@dataclass(frozen=True)
class Defect:
    """Defect of a bundle.

    Attributes:
        code: Kind of the defect, such as ``missing-file``.
        path: File in the bundle.
        message: Sentence about the file.
        written: Reference that it concerns, as written; empty for none.
    """

    code: str
    path: str
    message: str
    written: str = ""

    @property
    def is_of_source(self) -> bool:
        """Tell whether the source has the defect, too, so that the bundle may be complete."""
        return self.code in (OF_SOURCE, UNREADABLE_SOURCE)

    def __str__(self) -> str:
        """Return ``FILE: message [code]``."""
        return f"{self.path}: {self.message} [{self.code}]"
