"""What touches what should not, or does not touch what should."""

from __future__ import annotations

from collections.abc import Iterator

from ..model.elements import Robot
from .fault import Fault
from .judge_rest import Rest
from .run import Run


def judge_contacts(robot: Robot, run: Run, rest: Rest) -> Iterator[Fault]:
    """What is to be said of contacts."""
    yield from ()
