"""What a description writes and its robot does not hold, as losses of an export."""

from __future__ import annotations

from ...model.elements import Robot
from ..reading import find_remarks
from ..written import Written


def add_remarks(robot: Robot, written: Written) -> None:
    """Add the remarks on a source that the writer does not report itself, by their place."""
    known = {(loss.location.path, loss.location.start) for loss in written.losses}
    for finding in find_remarks(robot):
        if (finding.location.path, finding.location.start) not in known:
            written.losses.append(finding)
