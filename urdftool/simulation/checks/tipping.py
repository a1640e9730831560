"""Check whether a robot tipped over, or moved along the ground."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from ...diagnostic import Severity
from ...listing import quote_first
from ...model.elements import Robot
from ..fault import Fault
from ..run import Run
from .final_state import FinalState, find_initial_support_links


def check_tipping(robot: Robot, run: Run, state: FinalState) -> Iterator[Fault]:
    """Report a free root that is tilted at the end, or else one that moved along the plane."""
    thresholds, size = run.thresholds, max(run.bodies.size, 1e-3)
    if state.tilt > thresholds.lean_tilt:
        top = robot.link[run.bodies.bodies[0].name]
        fallen = state.tilt > thresholds.tip_tilt
        yield Fault(
            "tipped-over" if fallen else "leans",
            Severity.ERROR,
            f"the robot {'tipped over' if fallen else 'leans'}: link '{top.name}' is tilted by "
            f"{math.degrees(state.tilt):.0f}°",
            top.place,
            "link",
            top.name,
            _explain_why_tilted(run, state),
        )
    elif state.drift > thresholds.slide_distance * size:
        yield from _check_sliding(robot, run, state)


def _explain_why_tilted(run: Run, state: FinalState) -> str:
    if reason := run.settings.fixed_in_exports:
        return f"the exports fix the root ({reason}); try --fixed-base"
    if _looks_like_manipulator(run):
        return "this looks like a fixed-base manipulator; try --fixed-base"
    names = find_initial_support_links(run)
    if state.margin is not None and state.margin < 0:
        why = "the center of mass is outside the support polygon"
    elif state.supports:
        why = f"now supported by {quote_first(state.supports, 4)}"
    else:
        why = "no link makes contact with the ground"
    stood = f"initially supported by {quote_first(names, 4)}; " if names else ""
    return f"{stood}{why}. Use --fixed-base if the robot is mounted"


def _looks_like_manipulator(run: Run) -> bool:
    """Tell whether a robot is one chain of revolute joints on a base, except for its gripper."""
    bodies = run.bodies.bodies
    chain = [0]
    while True:
        children = [number for number, body in enumerate(bodies) if body.parent == chain[-1]]
        if len(children) != 1:
            break
        chain.append(children[0])
    joints = [bodies[number].joint for number in chain[1:]]
    turning = [joint for joint in joints if joint is not None and joint.kind != "prismatic"]
    return len(turning) >= run.thresholds.arm_joints


def _check_sliding(robot: Robot, run: Run, state: FinalState) -> Iterator[Fault]:
    supports, drift = state.supports, state.drift
    names = supports or (run.bodies.bodies[0].name,)
    slope, size = run.settings.slope, max(run.bodies.size, 1e-3)
    slick = [
        name
        for name in names
        if (friction := run.bodies.bodies[run.start.get_body(name)].surface.get("friction"))
        is not None
        and friction < abs(math.tan(slope))
    ]
    rolled = _choose_rolled_links(run, dict.fromkeys((*supports, *find_initial_support_links(run))))
    name = rolled[0] if rolled else slick[0] if slick else names[0]
    yield Fault(
        "slid",
        Severity.ERROR
        if bool(slope) or drift > run.thresholds.slide_failure * size
        else Severity.INFO,
        f"the robot moved {drift:.3g} m along the ground, {drift / size:.0%} of its size",
        robot.link[name].place,
        "link",
        name,
        _format_why(run, rolled, slick),
        "implausible-friction" if slick and not rolled else "",
    )


def _format_why(run: Run, rolled: Sequence[str], slick: Sequence[str]) -> str:
    slope = run.settings.slope
    if rolled and slope:
        joint = run.bodies.bodies[run.start.get_body(rolled[0])].joint
        held = joint is not None and joint.name in run.recording.targets
        held_how = "the effort limit is too low to hold them" if held else "they are not held"
        return f"the wheels turned, because {held_how}"
    if slick:
        return f"friction of {quote_first(slick, 4)} is too low for the slope"
    if slope and run.settings.friction < abs(math.tan(slope)):
        return "--friction is too low for the slope"
    return "contacts push the robot, or it rolls"


def _choose_rolled_links(run: Run, names: Iterable[str]) -> list[str]:
    """Choose the links whose continuous joint turned."""
    turned = np.abs(run.recording.positions[-1] - run.recording.positions[0])
    found = []
    for name in names:
        number = run.start.get_body(name)
        joint = run.bodies.bodies[number].joint
        if (
            joint is not None
            and joint.kind == "continuous"
            and turned[number - 1] > run.thresholds.wheel_turn
        ):
            found.append(name)
    return found
