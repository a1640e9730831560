"""Joints that cannot be moved through their limits."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ..model.elements import Robot
from .fault import Fault
from .judge_inside import INTO, deep
from .recording import Swept
from .run import Run


def judge_sweep(robot: Robot, run: Run, swept: Iterable[Swept]) -> Iterator[Fault]:
    """Links that run into each other on the way, by the joint that drives them there."""
    least = deep(run.bodies, INTO)
    for joint in swept:
        hits = sorted((hit for hit in joint.hits if hit.depth > least), key=lambda hit: -hit.depth)
        if not hits:
            continue
        hit = hits[0]
        more = f", and {len(hits) - 1} more pairs" if len(hits) > 1 else ""
        part = robot.joint[joint.joint]
        yield Fault(
            "blocked",
            f"joint '{joint.joint}' may go from {joint.lower:.3g} to {joint.upper:.3g} and is free "
            f"from {joint.free_lower:.3g} to {joint.free_upper:.3g}: beyond, '{hit.one}' and "
            f"'{hit.other}' overlap{more}",
            (part.limit or part).place,
            "joint",
            joint.joint,
            "its limits are wider than its parts allow, by the hulls of their collision shapes; "
            "or one of those is too large",
            fails=False,
        )
