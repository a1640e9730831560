"""Joints that sag, leave their limits, or need more than they may."""

from __future__ import annotations

from collections.abc import Iterator

from ..model.elements import Robot
from .fault import Fault
from .judge_rest import Rest
from .run import Run


def judge_joints(robot: Robot, run: Run, rest: Rest) -> Iterator[Fault]:
    """What is to be said of joints."""
    yield from ()
