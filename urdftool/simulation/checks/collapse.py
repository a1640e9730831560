"""Check whether a robot collapsed, because a joint is not held."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...diagnostic import Severity
from ...model.elements import Robot
from ...model.pose import rotation_from_quaternion
from ..fault import Fault
from ..recording import Array
from ..run import Run


def check_collapse(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report the joint without actuation whose motion let the robot, or its load, sink."""
    recording, bodies, bounds = run.recording, run.bodies, run.thresholds
    moved = np.abs(recording.positions[-1] - recording.positions[0])
    alone = {
        column: _measure_sunk_alone(run, column)
        for column, joint in enumerate(bodies.joints)
        if joint.name not in recording.targets and joint.leader is None
        if moved[column]
        > (
            bounds.collapse_slide * bodies.size
            if joint.kind == "prismatic"
            else bounds.collapse_turn
        )
    }
    if not alone:
        return
    column = max(alone, key=lambda number: abs(alone[number]))
    name = bodies.joints[column].name
    whole = _measure_sunk(run)
    if (
        whole >= bounds.collapse_depth * bodies.size
        and abs(alone[column]) >= bounds.collapse_share * bodies.size
    ):
        what = f"the robot sank {whole:.3g} m; joint '{name}' moved"
    elif max(alone.values()) >= bounds.collapse_depth * bodies.size:
        column = max(alone, key=lambda number: alone[number])
        name = bodies.joints[column].name
        what = f"the load of joint '{name}' sank {alone[column]:.3g} m; the joint moved"
    else:
        return
    yield Fault(
        "collapsed",
        Severity.ERROR,
        f"{what} from {recording.positions[0, column]:.3g} to "
        f"{recording.positions[-1, column]:.3g}",
        robot.joint[name].place,
        "joint",
        name,
        "the joint is not held: " + _explain_why_not_held(run),
        "missing-control-plugin",
    )


def _measure_sunk(run: Run) -> float:
    """Measure how far the center of mass sank [m]: of the robot, without a fixed root."""
    numbers = range(int(run.bodies.fixed_base), len(run.bodies.bodies))
    first_at, last_at = (run.compute_center_of_mass(numbers, moment) for moment in (0, -1))
    return 0.0 if first_at is None or last_at is None else first_at[2] - last_at[2]


def _measure_sunk_alone(run: Run, column: int) -> float:
    """Measure how far the load of a joint sank by the motion of this joint alone [m]."""
    bodies, poses = run.bodies.bodies, run.recording.poses
    child = column + 1
    beyond = {child}
    for number in range(child + 1, len(bodies)):
        if bodies[number].parent in beyond:
            beyond.add(number)
    center = run.compute_center_of_mass(beyond, 0)
    if center is None:
        return 0.0
    own = _turn(poses[0, child]).T @ (center - poses[0, child, :3])
    parent = bodies[child].parent
    first, last = (
        _turn(poses[moment, parent]).T
        @ (_turn(poses[moment, child]) @ own + poses[moment, child, :3] - poses[moment, parent, :3])
        for moment in (0, -1)
    )
    return float((_turn(poses[-1, parent]) @ (first - last))[2])


def _turn(pose: Array) -> Array:
    x, y, z, w = pose[3:].tolist()
    return np.array(rotation_from_quaternion((w, x, y, z)))


def _explain_why_not_held(run: Run) -> str:
    if run.settings.controls is not None:
        return "no controller drives it"
    if run.settings.hold == "none":
        return "--limp leaves all joints unactuated"
    return "the file has no actuator for it; --hold holds all joints"
