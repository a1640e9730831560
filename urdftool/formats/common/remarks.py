"""What a description writes and its robot does not hold, as losses of an export."""

from __future__ import annotations

from collections.abc import Iterator

from ...diagnostic import Severity
from ...finding import Finding
from ...model.elements import Robot
from ...model.remarks import list_remarks
from ..written import Written


def find_remarks(robot: Robot) -> Iterator[Finding]:
    """Yield the remarks on the description of a robot."""
    for one in list_remarks(robot):
        yield Finding(one.code, Severity.WARNING, one.message, one.place, one.kind, one.name)


def add_remarks(robot: Robot, written: Written) -> None:
    """Add the remarks on a source that the writer does not report itself, by their place."""
    known = {(loss.location.path, loss.location.start) for loss in written.losses}
    for finding in find_remarks(robot):
        if (finding.location.path, finding.location.start) not in known:
            written.losses.append(finding)
