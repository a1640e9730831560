"""Check the gains of a controller file: too low, too high for the time step, or undamped."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...diagnostic import Severity
from ...errors import UrdftoolError
from ...model.elements import Robot
from ...model.pose import rotation_from_quaternion
from ...source.document import read_file
from ...source.location import Place
from ..control import POSITION, VELOCITY, Control
from ..fault import Fault
from ..rigid_bodies import RigidBodyJoint
from ..run import Run
from .joints import compute_needed_effort, get_drift_bound


def check_controllers(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report joints that oscillate under the controllers of a run, or that they do not hold."""
    controls = run.settings.controls
    if controls is None:
        return
    yield from _report_not_controlled(robot, run)
    for column, joint in enumerate(run.bodies.joints):
        control = controls.get(joint.name)
        if control is None or control.pid is None or joint.name not in run.recording.targets:
            continue
        unstable = _explain_unstable(run, column, joint, control)
        if unstable:
            yield _report_fault(
                "unstable-gains",
                f"gains of controller '{control.controller}' make joint '{joint.name}' oscillate",
                control,
                joint,
                unstable,
            )
        elif run.recording.ended != "lost":
            yield from _report_too_weak(run, column, joint, control)


def _report_fault(
    kind: str, message: str, control: Control, joint: RigidBodyJoint, cause: str
) -> Fault:
    return Fault(kind, Severity.ERROR, message, _place(control), "joint", joint.name, cause)


def _place(control: Control) -> Place | None:
    path, start, end = control.at
    try:
        return Place(read_file(path), start, end)
    except UrdftoolError:
        return None


def _report_not_controlled(robot: Robot, run: Run) -> Iterator[Fault]:
    held = set(run.recording.held)
    names = [j.name for j in run.bodies.joints if j.name not in held and j.leader is None]
    if not names:
        return
    shown = ", ".join(f"'{name}'" for name in names[:4]) + (", …" if len(names) > 4 else "")
    yield Fault(
        "not-controlled",
        Severity.INFO,
        f"no controller holds joint {shown}",
        robot.joint[names[0]].place,
        "joint",
        names[0],
    )


def _explain_unstable(run: Run, column: int, joint: RigidBodyJoint, control: Control) -> str:
    """Explain how the gains make a joint oscillate; empty if they do not."""
    pid, recording = control.pid, run.recording
    assert pid is not None
    if recording.ended != "lost" and not _is_oscillating(run, column, joint):
        return ""
    step, inertia = run.settings.timestep, compute_moved_inertia(run, column)
    unit = "kg" if joint.kind == "prismatic" else "kg·m²"
    if inertia <= 0:
        return ""
    slope, stiff = (pid.d, pid.p) if control.kind == POSITION else (pid.p, 0.0)
    name = "d" if control.kind == POSITION else "p"
    what = f"for a moved inertia of {inertia:.3g} {unit} at a time step of {1000 * step:g} ms"
    if slope * step / inertia > 2:
        most = 2 * inertia / step
        return f"gain {name} = {slope:g} is unstable {what}; use a value below {most:.3g}"
    if stiff * step**2 / inertia > 4:
        most = 4 * inertia / step**2
        return f"gain p = {stiff:g} is unstable {what}; use a value below {most:.3g}"
    if control.kind == POSITION and recording.ended != "lost":
        damping = pid.d + joint.resistance["damping"]
        critical = 2 * (pid.p * inertia) ** 0.5
        if damping < run.thresholds.damping_ratio * critical and pid.p > 0:
            return (
                f"damping is too low: d and the joint damping add up to {damping:.3g}; with "
                f"p = {pid.p:g} and an inertia of {inertia:.3g} {unit}, use d = {critical:.3g}"
            )
    return ""


def _is_oscillating(run: Run, column: int, joint: RigidBodyJoint) -> bool:
    """Tell whether a joint oscillates at the end of a run."""
    recording = run.recording
    if recording.still_since is not None:
        return False
    late = recording.times > recording.times[-1] - 1.0
    rates = recording.rates[late, column]
    positions = recording.positions[late, column]
    if not np.isfinite(positions).all():
        return True
    bounds = run.thresholds
    least = bounds.oscillation_turn
    if joint.kind == "prismatic":
        least = bounds.oscillation_slide * max(run.bodies.size, 1e-3)
    turns = int((np.diff(np.sign(rates)) != 0).sum())
    return turns >= bounds.oscillation_reversals and float(np.ptp(positions)) > least


def _report_too_weak(
    run: Run, column: int, joint: RigidBodyJoint, control: Control
) -> Iterator[Fault]:
    pid, recording = control.pid, run.recording
    assert pid is not None
    target, now = recording.targets[joint.name], float(recording.positions[-1, column])
    bound = get_drift_bound(joint, run)
    if abs(now - target) <= bound:
        return
    length, force = ("m", "N") if joint.kind == "prismatic" else ("rad", "N·m")
    need = compute_needed_effort(run, column)
    used = abs(float(recording.efforts[-1, column]))
    load = abs(need) if need is not None else used
    parts = []
    if need is not None:
        parts.append(f"holding it requires {load:.3g} {force}")
    if joint.effort is not None and used >= run.thresholds.saturated_effort * joint.effort:
        parts.append(f"its effort limit of {joint.effort:.3g} {force} is reached")
    elif control.kind == VELOCITY:
        parts.append("a velocity controller damps the joint but does not return it to its setpoint")
    else:
        parts.append(
            f"p = {pid.p:g} gives {pid.p * bound:.3g} {force} at an error of {bound:.2g} {length}; "
            f"use p = {load / bound:.3g}"
        )
        if pid.i and not (pid.i_max or pid.i_min):
            parts.append("i has no effect, because i_clamp is zero by default")
        elif not pid.i:
            parts.append("or use i with an i_clamp above the required effort")
    yield _report_fault(
        "joint-drift",
        f"controller '{control.controller}' leaves joint '{joint.name}' at {now:.3g} {length}; its "
        f"setpoint is {target:.3g} {length}",
        control,
        joint,
        "; ".join(parts),
    )


def compute_moved_inertia(run: Run, column: int) -> float:
    """Compute the inertia of all bodies beyond a joint about its axis at the start [kg·m², kg].

    For a prismatic joint, it is their mass.
    """
    bodies, first = run.bodies.bodies, column + 1
    beyond = {first}
    for number in range(first + 1, len(bodies)):
        if bodies[number].parent in beyond:
            beyond.add(number)
    pose = run.recording.poses[0]
    joint = bodies[first].joint
    assert joint is not None

    def turn(number: int) -> np.ndarray:
        x, y, z, w = pose[number, 3:].tolist()
        return np.array(rotation_from_quaternion((w, x, y, z)))

    axis = turn(first) @ np.array(joint.axis)
    total = 0.0
    for number in beyond:
        body = bodies[number]
        if body.properties is None:
            continue
        if joint.kind == "prismatic":
            total += body.mass
            continue
        center = pose[number, :3] + turn(number) @ body.properties.com - pose[first, :3]
        own = turn(number).T @ axis
        total += float(own @ body.properties.inertia @ own)
        total += body.mass * float(np.cross(axis, center) @ np.cross(axis, center))
    return total
