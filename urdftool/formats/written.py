"""The result of a writer: files, and the losses of the export."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ..compare.check import Check
from ..diagnostic import Severity
from ..finding import Finding
from ..model.elements import Robot
from ..source.location import Place


@dataclass
class Written:
    """A robot in another format, in memory.

    Attributes:
        files: Content by path relative to the output: bytes, or the path of a file to copy.
        main: Path of the model in ``files``.
        losses: Losses and changes, each with its location in the source.
        renamed: New names by ``kind`` and old name, such as ``("link", "wheel::left")``.
        checks: Results of the comparison with the source, if requested.
        summary: Short properties of the model, such as ``12 actuators``.
        advice: Sentences about properties that the user may not expect.
        planned: The robot with every choice of the export; None if its writer makes none.
        unread: What the robot does not hold of its source, and the export does not copy either;
            None for all that the reader left out.
    """

    main: str
    files: dict[str, bytes | Path] = field(default_factory=dict)
    losses: list[Finding] = field(default_factory=list)
    renamed: dict[tuple[str, str], str] = field(default_factory=dict)
    checks: list[Check] = field(default_factory=list)
    summary: list[str] = field(default_factory=list)
    advice: list[str] = field(default_factory=list)
    planned: Robot | None = field(default=None, repr=False)
    unread: Sequence[Finding] | None = None

    @property
    def text(self) -> str:
        """Return the model as text."""
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
        """Record a loss.

        Args:
            what: Code of the loss after ``lossy-``, such as ``mimic``.
            message: Sentence with the loss and its substitute.
            place: Location in the source.
            kind: ``link``, ``joint``, …
            name: Name of that link or joint.
            severity: ``INFO`` if the robot behaves the same in the target.
            hint: Remedy.
            data: Values of the loss by name, for code that reads them.
        """
        code, values = f"lossy-{what}", dict(data or {})
        loss = Finding(code, severity, message, place, kind, name, hint=hint, data=values)
        self.losses.append(loss)
