"""Two engines on one robot: in what they differ, and why, found by trying.

A cause is not guessed: what may be behind a difference is taken out of both runs, one thing after
the other, and what makes the difference go away is said to be it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..errors import UrdftoolError
from ..model.elements import Inertia, Inertial, Joint, Limit, Link, Robot
from .bodies import Bodies, Body
from .checks.final_state import FinalState
from .engines.registry import REGISTRY
from .fault import Fault
from .run import Run, simulate
from .settings import Settings
from .shapes import hull
from .verdict import Verdict, judge

HEIGHT = 0.01
"""By how much heights and sliding joints may differ, of the robot's size; at least 1 mm."""

TURN = math.radians(1.0)
"""By how much tilts may differ, and joints [rad]."""

_LEAST = 1e-3  # m
_EDGE = 0.02  # of the robot's size: a static margin below it is an edge


@dataclass(frozen=True)
class Difference:
    """One number that two engines have otherwise.

    Attributes:
        what: Such as ``height of link 'base'``.
        kind: ``link`` or ``joint``.
        name: Of that.
        one: In the first engine.
        other: In the second.
        bound: By how much they may differ.
        unit: Of the numbers.
    """

    what: str
    kind: str
    name: str
    one: float
    other: float
    bound: float
    unit: str

    @property
    def excess(self) -> float:
        """The difference over its bound."""
        apart = abs(self.one - self.other)
        return apart / self.bound if math.isfinite(apart) else math.inf


def differences(
    robot: Robot, settings: Settings, first: Sequence[Verdict], second: Sequence[Verdict]
) -> list[Fault]:
    """In what two engines differ beyond what they may, trial by trial; the cause once.

    Args:
        robot: The robot.
        settings: Of the runs.
        first: The verdicts of one engine.
        second: Those of the other, on the same trials.
    """
    found: list[Fault] = []
    for number, (one, other) in enumerate(zip(first, second, strict=True), 1):
        apart = compare(one, other)
        if not apart:
            continue
        cause = "" if found else explained(robot, one, other, apart)
        trial = f" in trial {number}" if len(first) > 1 else ""
        engines = one.run.recording.engine, other.run.recording.engine
        for difference in sorted(apart, key=lambda part: -part.excess):
            found.append(_fault(robot, difference, engines, trial, cause))
            cause = found[0].cause
    return found


def _fault(
    robot: Robot, part: Difference, engines: tuple[str, str], trial: str, cause: str
) -> Fault:
    element = robot.joint.get(part.name) if part.kind == "joint" else robot.link.get(part.name)
    said = (
        f"the engines differ{trial}: {part.what} is {part.one:.4g} {part.unit} in {engines[0]} and "
        f"{part.other:.4g} {part.unit} in {engines[1]}"
    )
    if part.unit == "s":
        ends = ["not in the time" if math.isnan(end) else f"after {end:.2f} s"
                for end in (part.one, part.other)]  # fmt: skip
        said = f"the engines differ{trial}: {part.what} {ends[0]} in {engines[0]}, {ends[1]} in " \
               f"{engines[1]}"  # fmt: skip
    place = None if element is None else element.place
    return Fault("engines-differ", said, place, part.kind, part.name, cause)


def compare(one: Verdict, other: Verdict) -> list[Difference]:
    """What two runs of one trial have otherwise at their ends."""
    return list(_compare(one.run, one.rest, other.run, other.rest))


def _compare(one: Run, rest: FinalState, other: Run, rest2: FinalState) -> Iterator[Difference]:
    top = one.bodies.bodies[0].name
    size = max(one.bodies.size, _LEAST)
    length = max(HEIGHT * size, _LEAST)
    if rest.settled is None or rest2.settled is None:
        if rest.settled is not rest2.settled:
            times = [math.nan if part.settled is None else part.settled for part in (rest, rest2)]
            yield Difference("it comes to rest", "link", top, times[0], times[1], 1.0, "s")
        return  # what still moves is nowhere yet
    a, b = (_last(run) for run in (one, other))
    if not one.bodies.nailed:
        what = f"height of link '{top}'"
        yield from _apart(what, "link", top, a[0, 2], b[0, 2], length, "m")
        tilt, tilt2 = math.degrees(rest.tilt), math.degrees(rest2.tilt)
        what = f"tilt of link '{top}'"
        yield from _apart(what, "link", top, tilt, tilt2, math.degrees(TURN), "°")
    for column, joint in enumerate(one.bodies.joints):
        at, at2 = (float(run.recording.positions[-1, column]) for run in (one, other))
        if joint.kind == "continuous":  # a full turn is none
            at2 = at + math.remainder(at2 - at, 2 * math.pi)
        bound, unit = (length, "m") if joint.kind == "prismatic" else (TURN, "rad")
        what = f"position of joint '{joint.name}'"
        yield from _apart(what, "joint", joint.name, at, at2, bound, unit)


def _apart(
    what: str, kind: str, name: str, one: float, other: float, bound: float, unit: str
) -> Iterator[Difference]:
    found = Difference(what, kind, name, float(one), float(other), bound, unit)
    if not found.excess <= 1:
        yield found


def _last(run: Run) -> np.ndarray:
    poses = run.recording.poses
    good = np.isfinite(poses).all(axis=(1, 2))
    last: np.ndarray = poses[good][-1]
    return last


@dataclass(frozen=True)
class _Try:
    """Something taken out of both runs."""

    cause: str
    robot: Callable[[Robot], Robot] = lambda robot: robot
    settings: Callable[[Settings], Settings] = lambda settings: settings
    bodies: Callable[[Bodies], Bodies] | None = None


def explained(robot: Robot, one: Verdict, other: Verdict, apart: Sequence[Difference]) -> str:
    """The probable cause of differences; what was tried without effect, where none is found."""
    if cause := _sunk(one, other, apart):
        return cause
    worst = max(part.excess for part in apart)
    tried = []
    for attempt in _tries(robot, one, other):
        try:
            left = _again(robot, one.run.settings, attempt)
        except UrdftoolError:
            continue
        tried.append(attempt.cause)
        if not left:
            return f"{attempt.cause}: without that both agree"
        if left[0] < worst / 5:
            if math.isinf(worst):
                return (
                    f"{attempt.cause}: without that they agree on whether it comes to rest, and "
                    f"are {left[0]:.3g} times as far apart as they may be"
                )
            return f"{attempt.cause}: without that they are {worst / left[0]:.0f} times closer"
    return (
        "it is still there without any of these: " + "; ".join(tried)
        if tried
        else "nothing in the file makes engines differ; a smaller --timestep may tell more"
    )


def _again(robot: Robot, settings: Settings, attempt: _Try) -> list[float]:
    """How far apart two runs are when something is taken out, over what they may."""
    changed = attempt.robot(robot)
    chosen = attempt.settings(replace(settings, trials=1, sweep=False))
    verdicts = []
    for engine in REGISTRY:
        (run,) = simulate(changed, chosen, engine=engine, alter=attempt.bodies)
        verdicts.append(judge(changed, run))
    return sorted((part.excess for part in compare(*verdicts)), reverse=True)


def _sunk(one: Verdict, other: Verdict, apart: Sequence[Difference]) -> str:
    """Whether heights differ by as much as contacts are deep."""
    if len(apart) != 1 or apart[0].unit != "m" or apart[0].kind != "link":
        return ""
    depths = [float(verdict.run.recording.depths[-1]) for verdict in (one, other)]
    if not all(map(math.isfinite, depths)):
        return ""
    sunk = depths[1] - depths[0]
    if abs((apart[0].one - apart[0].other) - sunk) < apart[0].bound:
        return (
            f"contact softness: it is {1000 * depths[0]:.2g} mm in the floor in one and "
            f"{1000 * depths[1]:.2g} mm in the other"
        )
    return ""


def _tries(robot: Robot, one: Verdict, other: Verdict) -> Iterator[_Try]:
    bodies = one.run.bodies
    light = [b.name for n, b in enumerate(bodies.bodies) if not b.mass and (n or not bodies.nailed)]
    if light:
        yield _Try(
            f"inertia that is invented: {_names('link', light)} weighs nothing, and each engine "
            "makes something else of that",
            robot=lambda robot: _weighted(robot, light, bodies),
        )
    taken = [
        (part.kind, part.name)
        for verdict in (one, other)
        for part in verdict.run.recording.read_back
    ]
    heavy = [name for kind, name in taken if kind == "link"]
    if heavy:
        yield _Try(
            f"inertia that no body has: {_names('link', heavy)} is taken for another by an engine",
            robot=lambda robot: _balanced(robot, set(heavy)),
        )
    many = [s.link for b in bodies.bodies for s in b.shapes if len(s.pieces) > 1]
    if many:
        yield _Try(
            f"collision hulls: the mesh of {_names('link', many)} has several objects, which "
            "PyBullet takes for a hull each and MuJoCo for one",
            bodies=_one_hull,
        )
    soft = [b.name for b in bodies.bodies if b.surface.stiffness is not None]
    if soft:
        yield _Try(
            f"contact softness: the file gives {_names('link', soft)} a stiffness, which PyBullet "
            "takes and MuJoCo does not",
            bodies=_plain_surfaces,
        )
    lifted = [b.name for b in bodies.bodies if b.weightless is not None]
    if lifted:
        yield _Try(
            f"gravity flags: gravity does not act on {_names('link', lifted)}, which engines "
            "compensate in different ways",
            bodies=_with_gravity,
        )
    sprung = [joint.name for joint in bodies.joints if joint.stiffness]
    if sprung:
        yield _Try(
            f"springs: {_names('joint', sprung)} is sprung, which engines integrate in different "
            "ways",
            bodies=_without_springs,
        )
    for what, names in _joints_at_bounds(one, other):
        yield _Try(what, robot=partial(_unbound, names=names))
    losing = [j.name for j in bodies.joints if j.damping or j.friction]
    if losing:
        yield _Try(
            f"friction and damping of {_names('joint', losing)}, which engines apply otherwise "
            "beside a motor",
            robot=lambda robot: _without_losses(robot),
        )
    margins = [v.rest.margin for v in (one, other) if v.rest.margin is not None]
    if not bodies.nailed and margins and abs(min(margins)) < _EDGE * bodies.size:
        yield _Try(
            f"balance: its centre of mass is {1000 * abs(min(margins)):.2g} mm from the edge of "
            "what carries it, so a trifle decides where it goes",
            settings=lambda settings: replace(settings, nudge=0.0),
        )
    yield _Try(
        "the timestep: it is too coarse for this robot",
        settings=lambda settings: replace(settings, timestep=settings.timestep / 4),
    )


def _joints_at_bounds(one: Verdict, other: Verdict) -> Iterator[tuple[str, set[str]]]:
    spent, stopped = set(), set()
    for verdict in (one, other):
        recording = verdict.run.recording
        for column, joint in enumerate(verdict.run.bodies.joints):
            effort = abs(float(recording.efforts[-1, column]))
            if joint.effort is not None and effort > 0.95 * joint.effort:
                spent.add(joint.name)
            at = float(recording.positions[-1, column])
            if min(at - joint.lower, joint.upper - at) < TURN:
                stopped.add(joint.name)
    if spent:
        yield f"effort: {_names('joint', sorted(spent))} is at the edge of what it may use", spent
    if stopped:
        yield f"limits: {_names('joint', sorted(stopped))} is at its stop, which give way", stopped


def _names(kind: str, names: Sequence[str]) -> str:
    different = list(dict.fromkeys(names))
    more = f" (and {len(different) - 1} more)" if len(different) > 1 else ""
    return f"{kind} '{different[0]}'{more}"


def _weighted(robot: Robot, names: Sequence[str], bodies: Bodies) -> Robot:
    """The robot with a little mass where it has none."""
    mass = max(0.01 * bodies.mass, 1e-3)
    moment = 0.1 * mass * max(bodies.size, 0.01) ** 2

    def heavier(link: Link) -> Link:
        if link.name not in names:
            return link
        inertia = Inertia(link.element, ixx=moment, iyy=moment, izz=moment)
        return replace(link, inertial=Inertial(link.element, None, mass, inertia))

    return replace(robot, links=[heavier(link) for link in robot.links])


def _balanced(robot: Robot, names: set[str]) -> Robot:
    """The robot with a ball's tensor for those that no body has."""

    def rounder(link: Link) -> Link:
        inertial = link.inertial
        if link.name not in names or inertial is None or inertial.inertia is None:
            return link
        moment = max(map(abs, inertial.inertia.moments))
        inertia = Inertia(inertial.inertia.element, ixx=moment, iyy=moment, izz=moment)
        return replace(link, inertial=replace(inertial, inertia=inertia))

    return replace(robot, links=[rounder(link) for link in robot.links])


def _unbound(robot: Robot, names: set[str]) -> Robot:
    """The robot with room beyond the limits of some joints, and without bound of effort."""

    def freer(joint: Joint) -> Joint:
        limit = joint.limit
        if joint.name not in names or limit is None:
            return joint
        wide = Limit(
            limit.element, (limit.lower or 0.0) - 1.0, (limit.upper or 0.0) + 1.0, None,
            limit.velocity,
        )  # fmt: skip
        return replace(joint, limit=wide)

    return replace(robot, joints=[freer(joint) for joint in robot.joints])


def _without_losses(robot: Robot) -> Robot:
    return replace(robot, joints=[replace(joint, dynamics=None) for joint in robot.joints])


def _one_hull(bodies: Bodies) -> Bodies:
    def whole(body: Body) -> Body:
        shapes = []
        for shape in body.shapes:
            if len(shape.pieces) > 1:
                points, faces = hull(np.concatenate(shape.pieces))
                shape = replace(shape, pieces=(points,), faces=(faces,))
            shapes.append(shape)
        return replace(body, shapes=tuple(shapes))

    return replace(bodies, bodies=tuple(whole(body) for body in bodies.bodies))


def _plain_surfaces(bodies: Bodies) -> Bodies:
    return replace(
        bodies,
        bodies=tuple(
            replace(body, surface=replace(body.surface, stiffness=None, damping=None))
            for body in bodies.bodies
        ),
    )


def _with_gravity(bodies: Bodies) -> Bodies:
    return replace(bodies, bodies=tuple(replace(b, weightless=None) for b in bodies.bodies))


def _without_springs(bodies: Bodies) -> Bodies:
    def stiff(body: Body) -> Body:
        return body if body.joint is None else replace(body, joint=replace(body.joint, stiffness=0))

    return replace(bodies, bodies=tuple(stiff(body) for body in bodies.bodies))
