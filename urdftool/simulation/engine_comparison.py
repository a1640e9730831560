"""Compare the runs of two engines: values that differ, and possible causes.

Nothing is simulated again. A cause is a property of the robot or of a run that the two engines
treat differently; causes that affect most of the different values come first.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..diagnostic import Severity
from ..model.elements import Robot
from ..model.settings import RESISTANCE_OF_URDF
from .fault import Fault
from .recording import Array
from .run import Run
from .verdict import Verdict

MOST_CAUSES = 3
"""Maximum number of causes that are reported. Chosen, no source."""

_SPENT = 0.95
"""Part of its effort limit that a saturated joint uses. Chosen, no source."""


@dataclass(frozen=True)
class Difference:
    """A value that differs between two engines by more than a tolerance.

    Attributes:
        what: Name of the value, such as ``height of link 'base'``.
        kind: ``link`` or ``joint``.
        name: Name of the link or joint.
        one: Value in the first engine.
        other: Value in the second engine.
        bound: Tolerance.
        unit: Unit of the three; ``s`` for the time at which the robot came to rest, NaN if it did
            not.
        trial: Number of the trial; 0 if there is only one.
    """

    what: str
    kind: str
    name: str
    one: float
    other: float
    bound: float
    unit: str
    trial: int = 0

    @property
    def excess(self) -> float:
        """Return the difference over its tolerance."""
        difference = abs(self.one - self.other)
        return difference / self.bound if math.isfinite(difference) else math.inf

    def write_value(self, number: float) -> str:
        """Write one of the two values with its unit."""
        if self.unit == "s":
            return "not within the duration" if math.isnan(number) else f"after {number:.2f} s"
        return f"{number:.4g} {self.unit}"


@dataclass(frozen=True)
class EngineComparison:
    """Comparison of two engines on the same trials of a robot."""

    engines: tuple[str, str]
    differences: tuple[Difference, ...] = ()
    causes: tuple[str, ...] = ()

    def report_faults(self, robot: Robot) -> list[Fault]:
        """Report each difference as a fault, with the causes in its ``cause``."""
        return [self._report_fault(robot, part) for part in self.differences]

    def _report_fault(self, robot: Robot, part: Difference) -> Fault:
        element = robot.joint.get(part.name) if part.kind == "joint" else robot.link.get(part.name)
        trial = f" in trial {part.trial}" if part.trial else ""
        one, other = self.engines
        if part.unit == "s":
            values = (
                f"{part.write_value(part.one)} in {one}, {part.write_value(part.other)} in {other}"
            )
        else:
            values = (
                f"is {part.write_value(part.one)} in {one} and "
                f"{part.write_value(part.other)} in {other}"
            )
        message = f"the engines differ{trial}: {part.what} {values}"
        place = None if element is None else element.place
        causes = "; ".join(self.causes)
        return Fault("engines-differ", Severity.ERROR, message, place, part.kind, part.name, causes)


def compare_engines(first: Sequence[Verdict], second: Sequence[Verdict]) -> EngineComparison:
    """Compare the verdicts of two engines on the same trials."""
    engines = first[0].run.recording.engine, second[0].run.recording.engine
    differences: list[Difference] = []
    causes: tuple[str, ...] = ()
    for number, (one, other) in enumerate(zip(first, second, strict=True), 1):
        found = compare(one, other, number if len(first) > 1 else 0)
        if found and not differences:
            causes = find_causes(one, other, found)
        differences += sorted(found, key=lambda part: -part.excess)
    return EngineComparison(engines, tuple(differences), causes)


def compare(one: Verdict, other: Verdict, trial: int = 0) -> list[Difference]:
    """Find the values at the end of one trial in which two engines differ."""
    return list(_list_differences(one, other, trial))


def _list_differences(one: Verdict, other: Verdict, trial: int) -> Iterator[Difference]:
    bodies, bounds = one.run.bodies, one.run.thresholds
    top = bodies.bodies[0].name
    settled = [verdict.rest.settled for verdict in (one, other)]
    if None in settled:
        if settled[0] is not settled[1]:
            times = [math.nan if time is None else time for time in settled]
            yield Difference(
                "the robot comes to rest", "link", top, times[0], times[1], 1.0, "s", trial
            )
        return  # a robot that moves has no final values
    length = max(bounds.differ_length * max(bodies.size, 1e-3), bounds.differ_length_min)
    rows: list[tuple[str, str, str, float, float, float, str]] = []
    a, b = _compute_last_poses(one.run), _compute_last_poses(other.run)
    if not bodies.fixed_base:
        tilts = [math.degrees(verdict.rest.tilt) for verdict in (one, other)]
        angle = math.degrees(bounds.differ_angle)
        rows.append((f"height of link '{top}'", "link", top, a[0, 2], b[0, 2], length, "m"))
        rows.append((f"tilt of link '{top}'", "link", top, tilts[0], tilts[1], angle, "°"))
    for column, joint in enumerate(bodies.joints):
        at, at2 = (float(part.run.recording.positions[-1, column]) for part in (one, other))
        if joint.kind == "continuous":  # modulo full turns
            at2 = at + math.remainder(at2 - at, 2 * math.pi)
        sliding = joint.kind == "prismatic"
        bound, unit = (length, "m") if sliding else (bounds.differ_angle, "rad")
        what = f"position of joint '{joint.name}'"
        rows.append((what, "joint", joint.name, at, at2, bound, unit))
    for what, kind, name, x, y, bound, unit in rows:
        found = Difference(what, kind, name, float(x), float(y), bound, unit, trial)
        if not found.excess <= 1:
            yield found


def _compute_last_poses(run: Run) -> Array:
    poses = run.recording.poses
    last: Array = poses[np.isfinite(poses).all(axis=(1, 2))][-1]
    return last


@dataclass(frozen=True)
class _Cause:
    """A property that two engines treat differently; without names, of the whole robot."""

    text: str
    names: tuple[str, ...] = ()


def find_causes(one: Verdict, other: Verdict, differences: Sequence[Difference]) -> tuple[str, ...]:
    """Choose the most probable causes of differences.

    Causes are sorted by the number of differences that they affect: those of its links and joints,
    of joints that carry them, and of the root.
    """
    if sunk := _explain_contact_softness(one, other, differences):
        return (sunk,)
    causes = [*_find_causes(one, other)]
    above = _find_joint_chains(one.run)

    def count_affected(cause: _Cause) -> int:
        near = set(cause.names).union(*(above.get(name, ()) for name in cause.names))
        return sum(
            not cause.names or part.kind == "link" or part.name in near for part in differences
        )

    ranked = sorted(causes, key=lambda cause: -count_affected(cause))
    return tuple(cause.text for cause in ranked if count_affected(cause))[:MOST_CAUSES]


def _find_joint_chains(run: Run) -> dict[str, set[str]]:
    """Find the joints between the root and each link or joint."""
    bodies = run.bodies.bodies
    found: dict[str, set[str]] = {}
    chains: list[set[str]] = []
    for body in bodies:
        chain = set(chains[body.parent]) if body.parent >= 0 else set()
        if body.joint is not None:
            chain.add(body.joint.name)
            found[body.joint.name] = chain
        chains.append(chain)
        for link in body.links:
            found.setdefault(link, chain)
    return found


def _explain_contact_softness(
    one: Verdict, other: Verdict, differences: Sequence[Difference]
) -> str:
    """Explain a height difference equal to that of the penetration depths; empty if it differs."""
    if len(differences) != 1 or differences[0].unit != "m" or differences[0].kind != "link":
        return ""
    depths = [float(verdict.run.recording.depths[-1]) for verdict in (one, other)]
    if not all(map(math.isfinite, depths)):
        return ""
    part = differences[0]
    if abs((part.one - part.other) - (depths[1] - depths[0])) >= part.bound:
        return ""
    return (
        f"contact softness: the robot penetrates the ground by {1000 * depths[0]:.2g} mm in one "
        f"engine and by {1000 * depths[1]:.2g} mm in the other"
    )


def _find_causes(one: Verdict, other: Verdict) -> Iterator[_Cause]:
    """Find properties that the two engines treat differently, the strongest effect first."""
    yield from _list_model_causes(one, other)
    yield from _list_joint_causes(one, other)
    bodies, bounds = one.run.bodies, one.run.thresholds
    margins = [v.rest.margin for v in (one, other) if v.rest.margin is not None]
    if not bodies.fixed_base and margins and abs(min(margins)) < bounds.differ_margin * bodies.size:
        yield _Cause(
            f"balance: the center of mass is {1000 * abs(min(margins)):.2g} mm from the edge of "
            "the support polygon, so small differences decide the outcome"
        )
    step = one.run.settings.timestep
    yield _Cause(
        f"time step: {step:g} s may be too long for this robot; try --timestep {step / 4:g}"
    )


def _list_model_causes(one: Verdict, other: Verdict) -> Iterator[_Cause]:
    bodies = one.run.bodies
    first, second = (verdict.run.recording.capabilities for verdict in (one, other))
    light = [
        b.name for n, b in enumerate(bodies.bodies) if not b.mass and (n or not bodies.fixed_base)
    ]
    if light:
        yield _Cause(
            (
                f"mass: {_format_names('link', light)} has no mass, which the engines treat "
                "differently"
            ),
            tuple(light),
        )
    recordings = [verdict.run.recording for verdict in (one, other)]
    loaded = [
        part.name
        for recording in recordings
        for part in recording.read_back
        if part.kind == "link" and part.name not in light
    ]
    if loaded:
        yield _Cause(
            f"inertia: an engine does not simulate {_format_names('link', loaded)} as written",
            tuple(loaded),
        )
    many = [s.link for b in bodies.bodies for s in b.shapes if len(s.pieces) > 1]
    if many and first.hull_per_object != second.hull_per_object:
        yield _Cause(
            f"collision hulls: the mesh of {_format_names('link', many)} has several objects; "
            f"{_format_title(one, other, 'hull_per_object')} makes a hull of each, the other "
            "engine one",
            tuple(many),
        )
    soft = [b.name for b in bodies.bodies if "contact_stiffness" in b.surface]
    if soft and first.uses_contact_stiffness != second.uses_contact_stiffness:
        yield _Cause(
            f"contact softness: the file gives {_format_names('link', soft)} a stiffness, which "
            "only "
            f"{_format_title(one, other, 'uses_contact_stiffness')} uses",
            tuple(soft),
        )
    lifted = [b.name for b in bodies.bodies if b.weightless is not None]
    if lifted:
        yield _Cause(
            f"gravity flags: gravity does not act on {_format_names('link', lifted)}, which the "
            "engines "
            "compensate in different ways",
            tuple(lifted),
        )


def _format_title(one: Verdict, other: Verdict, capability: str) -> str:
    known = (verdict.run.recording.capabilities for verdict in (one, other))
    return next(engine.title for engine in known if getattr(engine, capability))


def _list_joint_causes(one: Verdict, other: Verdict) -> Iterator[_Cause]:
    joints = one.run.bodies.joints
    sprung = [joint.name for joint in joints if joint.stiffness]
    if sprung:
        yield _Cause(
            f"springs: {_format_names('joint', sprung)} has a spring, which the engines integrate "
            "in "
            "different ways",
            tuple(sprung),
        )
    spent = _collect_joints_at(one, other, _is_spent)
    if spent:
        yield _Cause(
            f"effort: {_format_names('joint', spent)} is at its effort limit", tuple(spent)
        )
    stopped = _collect_joints_at(one, other, _is_stopped)
    if stopped:
        yield _Cause(
            f"limits: {_format_names('joint', stopped)} rests on its limit, which the engines "
            "model with "
            "different stiffness",
            tuple(stopped),
        )
    losing = [joint.name for joint in joints if any(joint.resistance.values())]
    if losing:
        yield _Cause(
            f"{' and '.join(sorted(RESISTANCE_OF_URDF, reverse=True))} of "
            f"{_format_names('joint', losing)}, which the engines combine with a motor in "
            "different ways",
            tuple(losing),
        )


def _collect_joints_at(one: Verdict, other: Verdict, at: Callable[[Run, int], bool]) -> list[str]:
    names = [joint.name for joint in one.run.bodies.joints]
    return [n for c, n in enumerate(names) if any(at(verdict.run, c) for verdict in (one, other))]


def _is_spent(run: Run, column: int) -> bool:
    limit = run.bodies.joints[column].effort
    return limit is not None and abs(float(run.recording.efforts[-1, column])) > _SPENT * limit


def _is_stopped(run: Run, column: int) -> bool:
    joint, at = run.bodies.joints[column], float(run.recording.positions[-1, column])
    bounds = run.thresholds
    near = bounds.differ_angle
    if joint.kind == "prismatic":
        near = max(bounds.differ_length * run.bodies.size, bounds.differ_length_min)
    return min(at - joint.lower, joint.upper - at) < near


def _format_names(kind: str, names: Sequence[str]) -> str:
    different = list(dict.fromkeys(names))
    more = f" (and {len(different) - 1} more)" if len(different) > 1 else ""
    return f"{kind} '{different[0]}'{more}"
