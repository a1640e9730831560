"""Check the end of a run: diverged, fallen, or not at rest, with the cause of the motion."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from ...diagnostic import Severity
from ...listing import quote_first
from ...model.elements import Robot
from ...model.settings import RESISTANCE_OF_URDF
from ..element_names import name_element
from ..engines.registry import name_alternative
from ..fault import Fault
from ..recording import Array, Recording
from ..run import Run
from .final_state import FinalState, find_initial_support_links


def check_final_state(robot: Robot, run: Run, state: FinalState) -> Iterator[Fault]:
    """Report a robot that diverged, fell, does not come to rest, tipped over or slid."""
    recording, bodies = run.recording, run.bodies
    top = robot.link[bodies.bodies[0].name]
    if has_diverged(run, state) and not state.fell:
        name = _format_fastest_link(run)
        gain = f"by {state.gain:.3g} J" if math.isfinite(state.gain) else "without bound"
        yield Fault(
            "diverged",
            Severity.ERROR,
            f"simulation diverged at {_time_of_most_energy(recording):.2f} s: total energy "
            f"increased {gain}; fastest link '{name}'",
            robot.link[name].place,
            "link",
            name,
            "likely cause: overlapping collision geometry at spawn, or a link much lighter than "
            "its children",
            "tiny-moving-inertia",
        )
        return
    if state.fell:
        touching = any(body.shapes for body in bodies.bodies)
        yield Fault(
            "fell-through",
            Severity.ERROR,
            "the robot fell through the ground",
            top.place,
            "link",
            top.name,
            "collision geometry started below the ground plane"
            if touching
            else f"no link has a {name_element(robot, '<collision>')}, so no contact is possible",
            "missing-collision",
        )
        return
    if state.settled is None:
        name, does = _find_fastest_motion(run)
        joint = _find_fastest_joint(recording)
        at = f"; joint '{joint[0]}' moves at {joint[1]:.3g}" if joint else ""
        yield Fault(
            "not-settled",
            Severity.ERROR,
            f"the robot did not come to rest in {recording.times[-1]:.3g} s; link '{name}' still "
            f"{does}{at}",
            robot.link[name].place,
            "link",
            name,
            diagnose_motion(run, state.drift),
        )
    if bodies.fixed_base:
        return
    yield from _check_tipping(robot, run, state)


def has_diverged(run: Run, state: FinalState) -> bool:
    """Tell whether the simulation diverged: a value was not finite, or the energy increased."""
    size = max(run.bodies.size, 1e-3)
    lifting = max(run.bodies.mass * run.settings.gravity * size, 1e-9)  # J, by its own size
    bound = run.thresholds.energy_gain * lifting + 1e-3
    return run.recording.ended == "lost" or state.gain > bound


def _time_of_most_energy(recording: Recording) -> float:
    total = np.nan_to_num(recording.kinetic + recording.potential, nan=math.inf)
    return float(recording.times[int(total.argmax())])


def _compute_speeds(run: Run) -> Array:
    found: Array = np.linalg.norm(np.nan_to_num(run.recording.velocities[-1, :, :3]), axis=1)
    return found


def _format_fastest_link(run: Run) -> str:
    return run.recording.bodies[int(_compute_speeds(run).argmax())]


def _find_fastest_motion(run: Run) -> tuple[str, str]:
    """Find the fastest link at the end, with its motion: rotation if no link translates."""
    speeds = _compute_speeds(run)
    rates = np.linalg.norm(np.nan_to_num(run.recording.velocities[-1, :, 3:]), axis=1)
    turning = int(rates.argmax())
    bounds, window = run.thresholds, run.thresholds.settle_window
    slow = speeds.max() * window < bounds.settle_creep * run.bodies.size
    if slow and rates[turning] * window > bounds.settle_turn:
        return run.recording.bodies[turning], f"rotates at {rates[turning]:.3g} rad/s"
    return _format_fastest_link(run), f"moves at {speeds.max():.3g} m/s"


def _find_fastest_joint(recording: Recording) -> tuple[str, float] | None:
    if not recording.joints:
        return None
    rates = np.abs(np.nan_to_num(recording.rates[-1]))
    number = int(rates.argmax())
    return (recording.joints[number], float(rates[number])) if rates[number] > 0.01 else None


def diagnose_motion(run: Run, drift: float) -> str:
    """Diagnose the most probable cause of motion at the end of a run.

    Args:
        run: A run that did not come to rest.
        drift: Distance by which the root moved along the plane [m].
    """
    recording, joints, bounds = run.recording, run.bodies.joints, run.thresholds
    moves = [_moves(run, column) for column in range(len(joints))]
    loose = [j for j in joints if j.name not in run.bodies.held and not j.leader]
    if any(moves[recording.joints.index(joint.name)] for joint in loose):
        which, it, them = f"joint '{loose[0].name}' is", "it has", "it"
        if len(loose) > 1:
            which, it, them = f"{len(loose)} joints are", "they have", "them"
        why = f"{it} neither {' nor '.join(RESISTANCE_OF_URDF)}"
        if any(value for joint in loose for value in joint.resistance.values()):
            why = f"{' and '.join(RESISTANCE_OF_URDF)} have not stopped {them} yet"
        return f"{which} not held, and {why}"
    swinging = [joint.name for column, joint in enumerate(joints) if is_swinging(run, column)]
    if swinging:
        if len(swinging) > 1:
            return f"joints {quote_first(swinging, 4)} oscillate about their targets"
        return f"joint {quote_first(swinging, 4)} oscillates about its target"
    weak = [j.name for column, j in enumerate(joints) if moves[column] and _yields(run, column)]
    if weak:
        return f"effort limit of joint {quote_first(weak, 4)} is too low to hold the load"
    if not run.bodies.fixed_base and drift > run.bodies.size:
        return "the robot rolls or slides along the ground"
    velocities = np.abs(np.nan_to_num(recording.velocities[-1]))
    slow = velocities[:, :3].max() < bounds.creep_speed * run.bodies.size
    slow = slow and velocities[:, 3:].max() < bounds.creep_rate
    engine = recording.capabilities
    if slow and engine.creeps:
        other = name_alternative(engine.name, lambda known: not known.creeps)
        advice = f"; compare with {other}" if other else ""
        return f"the robot creeps, which the contacts of {engine.title} may cause{advice}"
    return "links push against each other, or the robot rolls"


def _moves(run: Run, column: int) -> bool:
    """Tell whether a joint moves at the end."""
    bounds = run.thresholds
    prismatic = run.bodies.joints[column].kind == "prismatic"
    rate = abs(float(run.recording.rates[-1, column]))
    return rate > (bounds.moving_speed if prismatic else bounds.moving_rate)


def _yields(run: Run, column: int) -> bool:
    """Tell whether a held joint is saturated and off its target."""
    recording, joint = run.recording, run.bodies.joints[column]
    if joint.name not in recording.targets or not joint.effort:
        return False
    off = float(recording.positions[-1, column]) - recording.targets[joint.name]
    used = float(recording.efforts[-1, column])
    bounds = run.thresholds
    least = bounds.yield_slide if joint.kind == "prismatic" else bounds.yield_turn
    return abs(off) > least and abs(used) > bounds.full_effort * joint.effort


def is_swinging(run: Run, column: int) -> bool:
    """Tell whether a held joint oscillates, saturated in both directions, to the end."""
    recording, joint = run.recording, run.bodies.joints[column]
    last = np.nan_to_num(recording.efforts[len(recording.times) // 2 :, column])
    if joint.name not in recording.targets or not joint.effort:
        return False
    most = run.thresholds.full_effort * joint.effort
    return bool(_moves(run, column) and last.min() < -most and last.max() > most)


def _check_tipping(robot: Robot, run: Run, state: FinalState) -> Iterator[Fault]:
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
