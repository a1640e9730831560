"""Check joints for drift from their target, limits, and effort."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ...diagnostic import Severity
from ...model.elements import Joint, Robot
from ...model.pose import rotation_from_quaternion
from ..control import is_driven
from ..element_names import name_element
from ..fault import Fault
from ..model_checks.bodies import is_impossible
from ..recording import GROUND
from ..rigid_bodies import RigidBodyJoint
from ..run import Run
from .collapse import check_collapse
from .final_state import FinalState
from .settling import is_swinging


def check_joints(robot: Robot, run: Run, state: FinalState) -> Iterator[Fault]:
    """Report joints that left their target or limits, and joints near their effort limit."""
    recording = run.recording
    if not recording.joints:
        return
    if recording.ended != "lost" and not state.fell:
        drifting = list(_report_joint_drift(robot, run, state))
        yield from drifting
        yield from _report_beyond_limits(robot, run)
        yield from _report_misled_mimics(robot, run)
        if not drifting:
            yield from check_collapse(robot, run)
            yield from _report_near_effort_limit(robot, run)
    yield from _report_without_effort(robot, run)
    yield from _report_not_held(robot, run)
    yield from _report_capped_damping(robot, run)
    for name, value in run.bodies.moved_start.items():
        yield Fault(
            "zero-outside-limits",
            Severity.INFO,
            f"joint '{name}' starts at its limit {value:.4g} because 0 is outside its range",
            _make_joint(robot, name).place,
            "joint",
            name,
            rule="zero-outside-limits",
        )
    if robot.xml is None or not recording.capabilities.closes_loops:
        yield from _report_open_loops(robot)


def _report_open_loops(robot: Robot) -> Iterator[Fault]:
    """Report closures of the tree; an engine closes those in ``<gazebo>`` of a URDF, if any."""
    for closure in robot.closures:
        what = f"'{closure.name or closure.type}'"
        if robot.xml is not None:
            what = f"joint {what} in <gazebo>"
        yield Fault(
            "loop-open",
            Severity.INFO,
            f"{what} closes a kinematic loop and is not simulated; the joints of the loop are held "
            "separately",
            closure.place,
            "joint",
            closure.name,
        )


def _make_joint(robot: Robot, name: str) -> Joint:
    return robot.joint[name]


def get_drift_bound(joint: RigidBodyJoint, run: Run) -> float:
    """Return the distance from its target above which a held joint is reported [rad, m]."""
    bounds = run.thresholds
    if joint.kind == "prismatic":
        return bounds.joint_drift_slide * max(run.bodies.size, 1e-3)
    return bounds.joint_drift_turn


def _limit_bound(joint: RigidBodyJoint, run: Run) -> float:
    """Return the distance beyond a limit above which a joint is reported [rad, m]."""
    bounds = run.thresholds
    if joint.kind == "prismatic":
        return bounds.limit_slide * max(run.bodies.size, 1e-3)
    return bounds.limit_turn


def _choose_units(joint: RigidBodyJoint) -> tuple[str, str]:
    return ("m", "N") if joint.kind == "prismatic" else ("rad", "N·m")


def _report_joint_drift(robot: Robot, run: Run, state: FinalState) -> Iterator[Fault]:
    recording = run.recording
    for column, joint in enumerate(run.bodies.joints):
        if joint.name not in recording.targets or is_driven(run.settings.controls, joint.name):
            continue
        target, now = recording.targets[joint.name], float(recording.positions[-1, column])
        if not abs(now - target) > get_drift_bound(joint, run):
            continue
        if state.settled is not None and rolls(run, column):
            continue  # the wheel turned or slid; whether the robot stands does not depend on it
        need = compute_needed_effort(run, column)
        length, force = _choose_units(joint)
        allowed = joint.effort
        if allowed is None:
            why = "the joint has no effort limit; contacts push it away from its target"
        elif need is not None and abs(need) > allowed:
            why = f"holding it requires {abs(need):.4g} {force}; its effort limit is {allowed:.4g}"
        elif state.settled is None and is_swinging(run, column):
            why = (
                f"the joint oscillates: the effort limit {allowed:.4g} {force} is too low to stop "
                "the moving inertia"
            )
        elif (
            abs(used := float(recording.efforts[-1, column])) > run.thresholds.near_effort * allowed
        ):
            why = f"the effort limit {allowed:.4g} {force} is reached and too low"
        else:
            why = f"the motor uses {abs(used):.4g} of {allowed:.4g} {force}: "
            why += _explain_why_idle(run, column)
        yield Fault(
            "joint-drift",
            Severity.ERROR,
            f"joint '{joint.name}' is held at {target:.3g} {length} but "
            f"{'is' if state.settled is None else 'came to rest'} at {now:.3g} {length}",
            (_make_joint(robot, joint.name).limit or _make_joint(robot, joint.name)).place,
            "joint",
            joint.name,
            why,
            "implausible-effort",
        )


def rolls(run: Run, column: int) -> bool:
    """Tell whether a joint is that of a wheel on level ground, which requires no effort.

    The joint of a wheel is continuous, its body makes contact with the ground, and the center of
    mass is on the axis.
    """
    body = run.bodies.bodies[column + 1]
    joint = body.joint
    if joint is None or joint.kind != "continuous" or run.settings.slope:
        return False
    touching = {contact.one for contact in run.recording.contacts if contact.other == GROUND}
    if body.properties is None or not touching & set(body.links):
        return False
    center = np.array(body.properties.com)
    off = center - np.array(joint.axis) * (center @ np.array(joint.axis))
    return bool(np.linalg.norm(off) < run.thresholds.wheel_offset * run.bodies.size)


def _explain_why_idle(run: Run, column: int) -> str:
    """Explain why a joint is off its target below its effort limit."""
    body = run.bodies.bodies[column + 1]
    if body.properties is not None and is_impossible(
        body.properties.tensor, run.thresholds.tensor_excess
    ):
        return f"link '{body.name}' has a physically inconsistent inertia tensor"
    return "the joint is blocked, or too slow to reach its target in time"


def compute_needed_effort(run: Run, column: int) -> float | None:
    """Compute the effort that a joint requires to hold its load at the start [N·m, N].

    It balances the weights of all bodies beyond the joint, at their centers of mass, and the spring
    of the joint. None if a body beyond the joint makes contact with the plane.
    """
    bodies, recording = run.bodies.bodies, run.recording
    first = column + 1
    beyond = {first}
    for number in range(first + 1, len(bodies)):
        if bodies[number].parent in beyond:
            beyond.add(number)
    links = {link for number in beyond for link in bodies[number].links}
    if any(contact.other == GROUND and contact.one in links for contact in recording.contacts):
        return None
    gravity = np.array(run.settings.compute_gravity_at(math.inf))
    pose = recording.poses[0]
    turn = _get_rotation(pose[first])
    joint = bodies[first].joint
    assert joint is not None
    axis = turn @ np.array(joint.axis)
    total = joint.stiffness * (float(recording.positions[0, column]) - joint.spring_rest)
    for number in beyond:
        mass, com = bodies[number].weight
        center = pose[number, :3] + _get_rotation(pose[number]) @ com
        weight = mass * gravity
        if joint.kind == "prismatic":
            total -= float(axis @ weight)
        else:
            total -= float(axis @ np.cross(center - pose[first, :3], weight))
    return total


def _get_rotation(pose: np.ndarray) -> np.ndarray:
    x, y, z, w = pose[3:].tolist()
    return np.array(rotation_from_quaternion((w, x, y, z)))


def _report_misled_mimics(robot: Robot, run: Run) -> Iterator[Fault]:
    """Report mimic joints that their leader moves beyond a limit of their own."""
    columns = {name: column for column, name in enumerate(run.recording.joints)}
    for joint in run.bodies.joints:
        if joint.leader not in columns:
            continue
        led = float(run.recording.positions[-1, columns[joint.leader]])
        commanded = joint.multiplier * led + joint.offset
        if not max(joint.lower - commanded, commanded - joint.upper) > _limit_bound(joint, run):
            continue
        length, _ = _choose_units(joint)
        side, limit = ("upper", joint.upper) if commanded > joint.upper else ("lower", joint.lower)
        mimic = _make_joint(robot, joint.name).mimic
        yield Fault(
            "beyond-limit",
            Severity.ERROR,
            f"joint '{joint.name}' follows '{joint.leader}' to {commanded:.3g} {length}, beyond "
            f"its own {side} limit {limit:.3g}",
            (mimic or _make_joint(robot, joint.name)).place,
            "joint",
            joint.name,
            f"the multiplier or offset of its {name_element(robot, '<mimic>')}, or its limits, are "
            "wrong",
            "mimic-limits-inconsistent",
        )


def _report_beyond_limits(robot: Robot, run: Run) -> Iterator[Fault]:
    for column, joint in enumerate(run.bodies.joints):
        now = float(run.recording.positions[-1, column])
        past = max(joint.lower - now, now - joint.upper)
        if not past > _limit_bound(joint, run):
            continue
        length, _ = _choose_units(joint)
        side = "upper" if now > joint.upper else "lower"
        limit = joint.upper if now > joint.upper else joint.lower
        yield Fault(
            "beyond-limit",
            Severity.ERROR,
            f"joint '{joint.name}' is at {now:.3g} {length}, beyond its {side} limit {limit:.3g}",
            (_make_joint(robot, joint.name).limit or _make_joint(robot, joint.name)).place,
            "joint",
            joint.name,
            "the joint starts there, or follows its leader there"
            if joint.leader or not joint.lower <= run.bodies.positions[joint.name] <= joint.upper
            else "contacts push it there",
            "zero-outside-limits",
        )


def _report_near_effort_limit(robot: Robot, run: Run) -> Iterator[Fault]:
    recording = run.recording
    if run.recording.still_since is None:
        return
    for column, joint in enumerate(run.bodies.joints):
        used = abs(float(recording.efforts[-1, column]))
        near = run.thresholds.near_effort * (joint.effort or 0.0)
        if joint.name in recording.targets and joint.effort and used > near:
            need = compute_needed_effort(run, column)
            idle = need is not None and abs(need) < near
            if idle or rolls(run, column):
                continue  # the joint returns to its target, or wheels push against each other
            _, force = _choose_units(joint)
            yield Fault(
                "near-effort-limit",
                Severity.INFO,
                f"joint '{joint.name}' requires {used:.4g} {force} at rest; its effort limit is "
                f"{joint.effort:.4g}",
                (_make_joint(robot, joint.name).limit or _make_joint(robot, joint.name)).place,
                "joint",
                joint.name,
            )


def _report_without_effort(robot: Robot, run: Run) -> Iterator[Fault]:
    names = [
        joint.name
        for joint in run.bodies.joints
        if joint.name in run.recording.targets and joint.effort is None
    ]
    if names:
        more = f" and {len(names) - 1} more" if len(names) > 1 else ""
        is_mjcf = robot.format == "mjcf"
        gazebo = "" if is_mjcf else "; Gazebo does not actuate a joint of effort zero"
        yield Fault(
            "no-effort",
            Severity.INFO,
            f"joint '{names[0]}'{more} {'have' if more else 'has'} no effort limit above zero and "
            f"{'were' if more else 'was'} held with unlimited effort",
            _make_joint(robot, names[0]).place,
            "joint",
            names[0],
            f"write {name_element(robot, '<limit effort>')} to check whether the joint can hold "
            f"its load{gazebo}",
            "zero-effort-limit",
        )


def _report_capped_damping(robot: Robot, run: Run) -> Iterator[Fault]:
    for joint in run.bodies.joints:
        had = run.recording.capped.get(joint.name)
        if had is None:
            continue
        length, force = _choose_units(joint)
        part = robot.joint[joint.name]
        written = joint.resistance["damping"]
        least = run.settings.timestep * had / written
        yield Fault(
            "damping-capped",
            Severity.INFO,
            f"damping of joint '{joint.name}' was reduced from {written:.4g} to {had:.4g} "
            f"{force}·s/{length} for numerical stability",
            (part.dynamics or part).place,
            "joint",
            joint.name,
            "the specified damping is unstable with explicit integration at this time step; use "
            f"--timestep {least:.1g}",
            "stiff-joint-damping",
        )


def _report_not_held(robot: Robot, run: Run) -> Iterator[Fault]:
    if run.settings.hold != "actuated":
        return
    held = set(run.recording.held)
    names = [j.name for j in run.bodies.joints if j.name not in held and j.leader is None]
    if names and held:
        shown = ", ".join(f"'{name}'" for name in names[:4]) + (", …" if len(names) > 4 else "")
        yield Fault(
            "not-held",
            Severity.INFO,
            f"joint {shown} was not held, because the file has no actuator for it",
            _make_joint(robot, names[0]).place,
            "joint",
            names[0],
        )
