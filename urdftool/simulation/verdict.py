"""The verdict on a run: whether the robot stands, by the checks of its recording."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from ..diagnostic import Severity
from ..mechanics.standing import (
    DRIFT,
    THE_BASE,
    TILT,
    WINDOW,
    BaseMotion,
    Bounds,
    JointMotion,
    Motion,
    estimate_end,
)
from ..model.elements import Robot
from ..model.pose import rotation_from_quaternion
from .checks.contact import check_contacts
from .checks.controllers import check_controllers
from .checks.final_state import FinalState, measure_final_state, measure_tilt
from .checks.interpenetration import check_sweep
from .checks.joints import check_joints
from .checks.settling import check_final_state
from .checks.support import check_support
from .fault import MOVES, Fault
from .model_checks.description import check_description
from .model_checks.unread_visuals import report_unread_visuals
from .run import Run
from .shapes import compute_lowest_height


@dataclass(frozen=True, eq=False)
class Verdict:
    """Verdict on one trial.

    Attributes:
        run: The trial.
        rest: State of the robot at the end.
        motion: Motion of the base and the joints, by which it stands or not.
        faults: Faults, errors first, then warnings and remarks.
    """

    run: Run
    rest: FinalState
    motion: Motion
    faults: list[Fault] = field(default_factory=list)

    @property
    def stands(self) -> bool:
        """Tell whether the robot stands, even if its file has errors."""
        return not self.fell

    @property
    def passes(self) -> bool:
        """Tell whether there is no error: it stands, and its file has none that affects a run."""
        return not any(fault.fails for fault in self.faults)

    @property
    def fell(self) -> bool:
        """Tell whether the robot does not stand, by its motion or its contacts."""
        return any(fault.fell for fault in self.faults)

    @property
    def gaps(self) -> list[Fault]:
        """List the remarks that name what no check looked at: links with unread visuals."""
        return [fault for fault in self.faults if fault.is_gap]


def judge(robot: Robot, run: Run, *, strict: bool = False) -> Verdict:
    """Judge one trial; ``strict`` makes warnings errors."""
    rest = measure_final_state(run)
    motion = _measure_run_motion(run)
    faults = [_replace_cause(run, fault) for fault in _report_faults(robot, run, rest)]
    faults = [_mark_spared_base(fault, motion, run) for fault in faults]
    if not motion.stands and not any(fault.fell for fault in faults):
        faults.append(_report_motion(robot, run, motion))
    if strict:
        faults = [_make_error(fault) for fault in faults]
    faults.sort(key=lambda fault: fault.severity, reverse=True)
    return Verdict(run, rest, motion, faults)


def _mark_spared_base(fault: Fault, motion: Motion, run: Run) -> Fault:
    """Mark that the base stands in spite of a fault; a robot that stays and creeps has none."""
    is_short = run.recording.times[-1] < run.thresholds.settle_min_time
    moves = fault.code == "not-settled"
    if fault.code not in MOVES or not motion.stands or (moves and is_short):
        return fault
    severity = Severity.INFO if moves and motion.stays else fault.severity
    return replace(fault, spares_base=True, severity=severity)


def _report_motion(robot: Robot, run: Run, motion: Motion) -> Fault:
    """Report a motion of which no check knows the cause."""
    root = robot.link[run.bodies.bodies[0].name]
    joints = (text for text, _ in motion.describe_joints())
    what = next(
        iter((*motion.describe_base(), *joints)), "a number of the simulation is not finite"
    )
    return Fault("collapsed", Severity.ERROR, what, root.place, "link", root.name)


def _make_error(fault: Fault) -> Fault:
    """Make an error of a warning."""
    return replace(fault, severity=Severity.ERROR) if fault.is_warning else fault


_CONSEQUENCES = frozenset(
    {
        "diverged",
        "fell-through",
        "tipped-over",
        "leans",
        "slid",
        "ground-penetration",
        "not-settled",
    }
)
"""Kinds that a free root without mass may cause."""


def _replace_cause(run: Run, fault: Fault) -> Fault:
    """Replace the cause of a fault that follows from a root without mass."""
    root = run.bodies.bodies[0]
    if root.mass or run.bodies.fixed_base or fault.code not in _CONSEQUENCES:
        return fault
    cause = f"root link '{root.name}' has no mass, so contacts and joints cannot hold or move it"
    return replace(fault, cause=cause, rule="massless-root-body")


def _report_faults(robot: Robot, run: Run, rest: FinalState) -> Iterator[Fault]:
    yield from check_description(robot, run)
    yield from check_final_state(robot, run, rest)
    yield from check_support(robot, run, rest)
    yield from check_contacts(robot, run, rest)
    yield from check_joints(robot, run, rest)
    yield from check_controllers(robot, run)
    yield from check_sweep(robot, run)
    yield from report_unread_visuals(robot)


def _measure_run_motion(run: Run) -> Motion:
    """Measure how the base and the joints moved from the start of a run to its end.

    A run that was at rest does not go on. Joints that follow another one, that have a controller,
    and wheels that roll are omitted.
    """
    recording, bounds, size = run.recording, run.thresholds, max(run.bodies.size, 1e-3)
    if recording.ended == "lost" or not np.isfinite(recording.poses[-1]).all():
        return Motion(is_finite=False)
    last = len(recording.times) - 1
    window = [last - round(part * _count_samples(run)) for part in (1.0, 0.5)]
    samples = [max(0, sample) for sample in window] + [last]
    if recording.still_since is not None:
        samples = [last] * 3
    return Motion(
        [] if run.bodies.fixed_base else [_measure_base(run, samples)],
        list(_measure_joints(run)),
        bounds=Bounds(
            slide=bounds.slide_failure * size,
            lean=math.degrees(bounds.lean_tilt),
            turn=bounds.joint_drift_turn,
            length=bounds.joint_drift_slide * size,
        ),
    )


def _count_samples(run: Run) -> float:
    """Return the number of samples in the window at the end."""
    times = run.recording.times
    return WINDOW / float(times[1] - times[0]) if len(times) > 1 else 0.0


def _measure_base(run: Run, samples: list[int]) -> BaseMotion:
    poses = run.recording.poses[:, 0]
    moves = poses[samples, :3] - poses[0, :3]
    tilts = [math.degrees(measure_tilt(poses[sample], run)) for sample in samples]
    numbers = range(len(run.bodies.bodies))
    first, last = (run.compute_center_of_mass(numbers, sample) for sample in (0, -1))
    drop = shrinking = 0.0
    lows = _measure_low_points(run, 0)
    lowest = min(lows.values(), default=0.0)
    is_upright = not any(run.settings.start_rpy)  # a tilted start has other heights
    if lows and is_upright and first is not None and last is not None:
        height = max(first[2] - lowest, DRIFT)
        drop = (first[2] - last[2]) / height
        shrinking = drop - (lowest - min(_measure_low_points(run, -1).values())) / height
    return BaseMotion(
        THE_BASE,
        drift=float(np.linalg.norm(moves[-1])),
        slide=abs(estimate_end(np.linalg.norm(moves[:, :2], axis=1).tolist())),
        tilt=tilts[-1],
        lean=abs(estimate_end(tilts)),
        sink=-float(moves[-1, 2]),
        drop=drop,
        shrinking=shrinking,
        resting=tuple(_list_resting_links(run, lows, lowest)) if is_upright else (),
    )


def _measure_low_points(run: Run, sample: int) -> dict[int, float]:
    """Measure the height of the lowest point of each body with shapes in a sample [m]."""
    found = {}
    for number, (body, pose) in enumerate(
        zip(run.bodies.bodies, run.recording.poses[sample], strict=True)
    ):
        if body.shapes:
            x, y, z, w = pose[3:].tolist()
            turn = np.array(rotation_from_quaternion((w, x, y, z)))
            found[number] = compute_lowest_height(body.shapes, turn, pose[:3])
    return found


def _list_resting_links(run: Run, lows: dict[int, float], lowest: float) -> Iterator[str]:
    """List the links on the ground that a base that stays does not bring there."""
    places = run.recording.poses[0]
    for name in dict.fromkeys(contact.one for contact in run.recording.carrying):
        number = run.start.get_body(name)
        reach = math.dist(places[number, :2], places[0, :2]) + run.bodies.size / 10
        if lows.get(number, 0.0) - lowest > DRIFT + math.sin(math.radians(TILT)) * reach:
            yield name


def _measure_joints(run: Run) -> Iterator[JointMotion]:
    from .checks.joints import rolls
    from .control import is_driven

    recording = run.recording
    for column, joint in enumerate(run.bodies.joints):
        if joint.leader is not None or is_driven(run.settings.controls, joint.name):
            continue
        is_held = joint.name in recording.targets
        if (recording.still_since is not None or not is_held) and rolls(run, column):
            continue
        values = recording.positions[:, column]
        start = recording.targets.get(joint.name, float(values[0]))
        yield JointMotion(
            joint.name,
            abs(float(values[-1]) - start),
            is_held=is_held,
            is_slide=joint.kind == "prismatic",
            is_carried=not run.bodies.fixed_base,
        )
