"""A robot that stands elsewhere than it was put: on wheels that turned, or without grip."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from ..model.elements import Robot
from .fault import Fault, listed
from .run import Run

TURNED = 0.05
"""How far a wheel turned that rolled [rad]."""


def judge_slide(
    robot: Robot, run: Run, drift: float, supports: Sequence[str], stood: Sequence[str]
) -> Iterator[Fault]:
    """What is to be said of a root that moved along the plane.

    Args:
        robot: The robot.
        run: Its run.
        drift: How far it moved [m].
        supports: Links that touch the plane at the end.
        stood: Links that it was put on.
    """
    names = supports or (run.bodies.bodies[0].name,)
    slope, size = run.settings.slope, max(run.bodies.size, 1e-3)
    slick = [
        name
        for name in names
        if (friction := run.bodies.bodies[run.start.body_of(name)].surface.friction) is not None
        and friction < abs(math.tan(slope))
    ]
    rolled = _rolled(run, dict.fromkeys((*supports, *stood)))
    name = rolled[0] if rolled else slick[0] if slick else names[0]
    yield Fault(
        "slid",
        f"it moved {drift:.3g} m along the floor, {drift / size:.0%} of its size",
        robot.link[name].place,
        "link",
        name,
        _why(run, rolled, slick),
        "implausible-friction" if slick and not rolled else "",
        fails=bool(slope) or drift > 0.5 * size,
    )


def _why(run: Run, rolled: Sequence[str], slick: Sequence[str]) -> str:
    slope = run.settings.slope
    if rolled and slope:
        joint = run.bodies.bodies[run.start.body_of(rolled[0])].joint
        held = joint is not None and joint.name in run.recording.targets
        brake = "held with less effort than it takes" if held else "and nothing brakes them"
        return f"its wheels turned, {brake}"
    if slick:
        return f"the file gives {listed(slick)} less friction than the slope needs"
    if slope and run.settings.friction < abs(math.tan(slope)):
        return "--friction is less than the slope needs"
    return "it was pushed, or rolls"


def _rolled(run: Run, names: Iterable[str]) -> list[str]:
    """Those of some links that hang on a joint without end which turned."""
    turned = np.abs(run.recording.positions[-1] - run.recording.positions[0])
    found = []
    for name in names:
        number = run.start.body_of(name)
        joint = run.bodies.bodies[number].joint
        if joint is not None and joint.kind == "continuous" and turned[number - 1] > TURNED:
            found.append(name)
    return found
