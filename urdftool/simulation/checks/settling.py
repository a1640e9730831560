"""Check the end of a run: diverged, fallen, or not at rest, with the cause of the motion."""

from __future__ import annotations

import math
from collections.abc import Iterator

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
from .final_state import FinalState
from .tipping import check_tipping


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
    yield from check_tipping(robot, run, state)


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
