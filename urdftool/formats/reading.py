"""The result of a reader: a robot, and what the model cannot hold of the source."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from ..diagnostic import Severity
from ..errors import LimitError, ModelError
from ..finding import Finding
from ..isolated import ProcessDied
from ..limited import LimitExceeded, Limits
from ..model.elements import Robot
from ..model.remarks import list_remarks
from ..projects import is_trusted
from ..source.document import STDIN, read_file
from ..source.location import Place, SourceFile
from ..source.packages import Packages
from ..suggestions import find_nearest
from ..workspace import Workspace

LARGEST = 1e30
"""Largest number of a mass, size or pose; products of larger ones overflow."""

_SHOWN = 3
"""Names in a finding. Chosen, no source."""

_LISTED = 20
"""Names of robots in a message. Chosen, no source."""


@dataclass
class Reading:
    """A robot with the losses of reading it.

    Attributes:
        robot: The robot.
        losses: What the robot does not hold, once for each kind, with the place of the first.
    """

    robot: Robot
    losses: list[Finding] = field(default_factory=list)


def find_remarks(robot: Robot) -> Iterator[Finding]:
    """Yield the remarks on the description of a robot."""
    for one in list_remarks(robot):
        yield Finding(one.code, Severity.WARNING, one.message, one.place, one.kind, one.name)


def find_chosen(name: str, known: Sequence[str], what: str, place: Place) -> int:
    """Return the number of the robot of a name; ends of paths count as names.

    Raises:
        ModelError: There is none, or several.
    """
    found = [i for i, other in enumerate(known) if other == name]
    found = found or [i for i, other in enumerate(known) if other.rpartition("/")[2] == name]
    if len(found) == 1:
        return found[0]
    names = ", ".join(known[:_LISTED]) + (", …" if len(known) > _LISTED else "")
    near = find_nearest(name, known)
    help_ = f"; did you mean '{near}'?" if near else ""
    count = f"{len(found)} {what}s with the name" if found else f"no {what}"
    raise ModelError(f"the file has {count} '{name}'; it has {names}{help_}", at=place)


class _Part(NamedTuple):
    """A part that is left out; see :meth:`Losses.add`."""

    name: str
    place: Place
    content: str | None


class Losses:
    """Collection of what a reader leaves out, merged by code."""

    def __init__(self) -> None:
        """Create an empty collection."""
        self._found: dict[str, tuple[Severity, str, list[_Part]]] = {}

    def add(
        self,
        code: str,
        what: str,
        name: str,
        place: Place,
        severity: Severity = Severity.WARNING,
        content: str | None = None,
    ) -> None:
        """Record a part that is left out.

        Args:
            code: Code of the loss after ``unread-``.
            what: Sentence after the number of such parts: ``tendons are not read``.
            name: Name of the part; may be empty.
            place: Location in the source.
            severity: ``INFO`` if the part affects neither motion nor contact.
            content: All that is written of the part, in equal words for equal parts; None if
                unknown. Two files of one format that have a part in equal words do not differ.
        """
        _, _, parts = self._found.setdefault(code, (severity, what, []))
        parts.append(_Part(name, place, content))

    def make_findings(self) -> list[Finding]:
        """Return a finding for each kind, with the number of parts and the first names."""
        return [
            Finding(
                f"unread-{code}",
                severity,
                f"{what}: {_count(part.name for part in parts)}",
                parts[0].place,
                code,
                parts[0].name,
                data={
                    "what": what,
                    "count": len(parts),
                    "names": [part.name for part in parts],
                    "contents": [part.content for part in parts],
                },
            )
            for code, (severity, what, parts) in self._found.items()
        ]


def _count(names: Iterable[str]) -> str:
    """Return the number of parts, with the first names."""
    every = list(names)
    named = [f"'{name}'" for name in every if name]
    shown = ", ".join(named[:_SHOWN]) + (", …" if len(named) > _SHOWN else "")
    return f"{len(every)} ({shown})" if shown else str(len(every))


class Opened(NamedTuple):
    """File of a description, finder of the files that it names, and access to those."""

    file: SourceFile
    packages: Packages
    workspace: Workspace


def open_description(
    path: str | Path,
    file: SourceFile | None,
    packages: Packages | None,
    workspace: Workspace | None,
) -> Opened:
    """Read a description (``-``: standard input) that is not read yet, and create what is None.

    Raises:
        SourceError: The file cannot be read.
    """
    workspace = workspace or Workspace()
    file = file or read_file(path, workspace)
    packages = packages or Packages(None if file.path == STDIN else file.path, workspace=workspace)
    return Opened(file, packages, packages.workspace)


def choose_limits(limits: Limits, workspace: Workspace) -> Limits:
    """Return the limits of a library that reads a description; only of time for trusted input."""
    return Limits(limits.time) if is_trusted(workspace) else limits


@contextmanager
def report_limits(library: str, what: str, place: Place) -> Iterator[None]:
    """Report that a library in another process crashed on a description or exceeded its limits.

    Raises:
        LimitError: It exceeded them.
        ModelError: It crashed.
    """
    try:
        yield
    except LimitExceeded as error:
        text = f"{library} needs more than {error.message} for the {what}, which is not read"
        help_ = "pass --trust to lift this limit of urdftool"
        raise LimitError(f"{text}; {help_}", at=place) from None
    except ProcessDied as error:
        text = f"{library} crashes on the {what}"
        raise ModelError(text, at=place, notes=error.output) from None


def take_name(name: str, taken: set[str]) -> str:
    """Return a name, with a number if it is taken, and take it."""
    found, count = name, 1
    while found in taken:
        count += 1
        found = f"{name}_{count}"
    taken.add(found)
    return found
