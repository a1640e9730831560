"""Defects that the verification of a bundle finds."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Defect:
    """Defect of a bundle.

    Attributes:
        code: Kind of the defect, such as ``missing-file``.
        path: File in the bundle.
        message: Sentence about the file.
    """

    code: str
    path: str
    message: str

    def __str__(self) -> str:
        """Return ``FILE: message [code]``."""
        return f"{self.path}: {self.message} [{self.code}]"
