"""The verdict on a run: whether the robot stands, by the checks of its recording."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from ..diagnostic import Severity
from ..mechanics.standing import Motion
from ..model.elements import Robot
from .checks.contact import check_contacts
from .checks.controllers import check_controllers
from .checks.final_state import FinalState, measure_final_state
from .checks.interpenetration import check_sweep
from .checks.joints import check_joints
from .checks.settling import check_final_state
from .checks.support import check_support
from .fault import MOVES, Fault
from .model_checks.description import check_description
from .model_checks.unread_visuals import report_unread_visuals
from .motion import measure_run_motion
from .run import Run


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
    motion = measure_run_motion(run)
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
