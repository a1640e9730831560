"""The result of a reader: a robot, and what the model cannot hold of the source."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from ..diagnostic import Severity
from ..finding import Finding
from ..model.elements import Robot
from ..source.location import Place

_SHOWN = 3


@dataclass
class Reading:
    """A robot with the losses of reading it.

    Attributes:
        robot: The robot.
        losses: What the robot does not hold, once for each kind, with the place of the first.
    """

    robot: Robot
    losses: list[Finding] = field(default_factory=list)


class Losses:
    """Collection of what a reader leaves out, merged by code."""

    def __init__(self) -> None:
        """Create an empty collection."""
        self._found: dict[str, tuple[Severity, str, list[tuple[str, Place]]]] = {}

    def add(
        self, code: str, what: str, name: str, place: Place, severity: Severity = Severity.WARNING
    ) -> None:
        """Record a part that is left out.

        Args:
            code: Code of the loss after ``unread-``.
            what: Sentence after the number of such parts: ``tendons are not read``.
            name: Name of the part; may be empty.
            place: Location in the source.
            severity: ``INFO`` if the part affects neither motion nor contact.
        """
        _, _, parts = self._found.setdefault(code, (severity, what, []))
        parts.append((name, place))

    def make_findings(self) -> list[Finding]:
        """Return a finding for each kind, with the number of parts and the first names."""
        return [
            Finding(
                f"unread-{code}",
                severity,
                f"{what}: {_count(name for name, _ in parts)}",
                parts[0][1],
                code,
                parts[0][0],
                data={"count": len(parts), "names": [name for name, _ in parts]},
            )
            for code, (severity, what, parts) in self._found.items()
        ]


def _count(names: Iterable[str]) -> str:
    """Return the number of parts, with the first names."""
    every = list(names)
    named = [f"'{name}'" for name in every if name]
    shown = ", ".join(named[:_SHOWN]) + (", …" if len(named) > _SHOWN else "")
    return f"{len(every)} ({shown})" if shown else str(len(every))
