"""The result of a writer: files, and the losses of the export."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ..finding import Finding, Severity
from ..source.location import Place
from .check import Check


@dataclass
class Written:
    """A robot in another format, not yet on disk.

    Attributes:
        files: Content by path relative to the output: bytes, or a file to copy.
        main: The path of the model in ``files``.
        losses: What was lost or changed, each with its place in the source.
        renamed: New names by ``kind`` and old name, such as ``("link", "wheel::left")``.
        checks: What was compared with the source, where that was asked for.
        summary: What the model is, in few words each, such as ``12 actuators``.
        advice: What the user may not expect of the model, in sentences.
    """

    main: str
    files: dict[str, bytes | Path] = field(default_factory=dict)
    losses: list[Finding] = field(default_factory=list)
    renamed: dict[tuple[str, str], str] = field(default_factory=dict)
    checks: list[Check] = field(default_factory=list)
    summary: list[str] = field(default_factory=list)
    advice: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        """The model."""
        content = self.files[self.main]
        return (content if isinstance(content, bytes) else content.read_bytes()).decode("utf-8")

    def report_loss(
        self,
        what: str,
        message: str,
        place: Place,
        *,
        kind: str = "",
        name: str = "",
        severity: Severity = Severity.WARNING,
        hint: str = "",
        data: Mapping[str, object] | None = None,
    ) -> None:
        """Add a loss to the record.

        Args:
            what: The code of the loss after ``lossy-``, such as ``mimic``.
            message: A sentence: what is lost, and what stands in its place.
            place: Where it is written in the source.
            kind: ``link``, ``joint``, …
            name: The name of that link or joint.
            severity: ``INFO`` where the robot behaves the same in the target.
            hint: What would carry it.
            data: The values of the loss by name, for code that reads it.
        """
        code, values = f"lossy-{what}", dict(data or {})
        loss = Finding(code, severity, message, place, kind, name, hint=hint, data=values)
        self.losses.append(loss)
