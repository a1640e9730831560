"""How a robot came to rest: fallen, tipped, collapsed, slid, blown up, or never."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..model.elements import Robot
from ..model.pose import IDENTITY, matrix_product, rotation_of_quaternion, transpose
from .centre import centre_of
from .engines.driver import CREEP, TURN, WINDOW
from .fault import Fault, listed
from .footprint import footprint
from .judge_slide import judge_slide
from .recording import GROUND, Array, Recording
from .run import Run
from .shapes import lowest
from .why_moving import why_moving

TIPPED = math.radians(30)
LEANS = math.radians(10)
FAR = 0.05
"""A drop, drift or collapse worth a word, as a part of the robot's size."""

GAIN = 0.5
"""Energy gained, as a part of what lifting the robot by its size takes, that is no rounding."""


STANDS = 0.003
"""How much higher than the lowest a link may be that a robot is put on, as a part of its size."""

ARM = 4
"""Turning joints in one chain from the root that make an arm."""


@dataclass(frozen=True)
class Rest:
    """Where a run ended.

    Attributes:
        settled: When it came to rest [s]; None where it did not.
        drop: How far the root sank [m].
        drift: How far the root moved along the plane [m].
        tilt: How far the root's upright axis turned from where it is at zero tilt [rad].
        centre: Centre of mass in the world at the end [m]; None where nothing weighs.
        margin: How far inside the support polygon the centre of mass is [m]; negative is outside;
            None where nothing touches the plane.
        supports: Links that touch the plane at the end.
        gain: The most total energy above the start's [J].
        fell: Whether it fell through the plane.
    """

    settled: float | None
    drop: float
    drift: float
    tilt: float
    centre: tuple[float, float, float] | None
    margin: float | None
    supports: tuple[str, ...]
    gain: float
    fell: bool


def rest_of(run: Run) -> Rest:
    """Measure the end of a run."""
    recording, bodies = run.recording, run.bodies
    root = recording.poses[:, 0, :]
    good = np.isfinite(root).all(axis=1)
    first, last = root[0], root[good][-1]
    supports = tuple(dict.fromkeys(c.one for c in recording.contacts if c.other == GROUND))
    centre = centre_of(run, range(len(bodies.bodies)), -1)
    gain = np.nan_to_num(recording.kinetic + recording.potential, nan=math.inf).max()
    size = max(bodies.size, 1e-3)
    lost = last[2] < first[2] - max(2 * size, 0.5) and not supports
    return Rest(
        recording.still_since,
        float(first[2] - last[2]),
        float(math.hypot(*(last[:2] - first[:2]))),
        tilt_of(first, last, run),
        centre,
        None if centre is None else _margin(run, centre),
        supports,
        float(gain),
        bool(lost and not bodies.nailed),
    )


def tilt_of(first: Array, last: Array, run: Run) -> float:
    """By how much the way up of a root that stands upright is turned at the end [rad]."""
    x, y, z, w = last[3:]
    now = rotation_of_quaternion((w, x, y, z))
    upright = IDENTITY.rotation
    turned = matrix_product(now, transpose(upright))
    return math.acos(max(-1.0, min(1.0, turned[2][2])))


def _margin(run: Run, centre: tuple[float, float, float]) -> float | None:
    """From the centre of mass, along gravity, to the nearest edge of the support polygon [m]."""
    points = footprint(run)
    if not len(points):
        return None
    below = np.array([centre[0] + centre[2] * math.tan(run.settings.slope), centre[1]])
    return support_margin(points, below)


def support_margin(points: Array, at: Array) -> float:
    """How far a point of the plane is inside the convex hull of others [m]; negative is outside.

    Args:
        points: Shape (n, 2), at least one.
        at: Shape (2,).
    """
    corners = _corners(sorted(set(map(tuple, points.tolist()))))
    if len(corners) < 3:  # a point or a line has no inside
        along = points - points.mean(axis=0)
        _, _, axes = np.linalg.svd(along, full_matrices=True)
        lengths = along @ axes[0]
        where = float(np.clip((at - points.mean(axis=0)) @ axes[0], lengths.min(), lengths.max()))
        nearest = points.mean(axis=0) + where * axes[0]
        return -float(np.linalg.norm(at - nearest))
    x, y = at.tolist()
    pairs = zip(corners, [*corners[1:], corners[0]], strict=True)
    margin: float = min(
        ((c - a) * (y - b) - (d - b) * (x - a)) / math.hypot(c - a, d - b)
        for (a, b), (c, d) in pairs
    )
    return margin


def _corners(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Corners of the convex hull of sorted points, counter-clockwise, by Andrew's chains."""
    found: list[tuple[float, float]] = []
    for order in (points, points[::-1]):
        chain: list[tuple[float, float]] = []
        for c, d in order:
            while len(chain) > 1:
                (a, b), (e, f) = chain[-2:]
                if (e - a) * (d - b) - (f - b) * (c - a) > 1e-15:
                    break
                chain.pop()
            chain.append((c, d))
        found += chain[:-1]
    return found


def judge_rest(robot: Robot, run: Run, rest: Rest) -> Iterator[Fault]:
    """What is to be said of the end."""
    recording, bodies = run.recording, run.bodies
    size = max(bodies.size, 1e-3)
    top = robot.link[bodies.bodies[0].name]
    heavy = max(bodies.mass * run.settings.gravity * size, 1e-9)
    blew = recording.ended == "lost" or rest.gain > GAIN * heavy + 1e-3
    if blew and not rest.fell:
        name = _fastest(run)
        gain = f"by {rest.gain:.3g} J" if math.isfinite(rest.gain) else "beyond all bounds"
        yield Fault(
            "blew-up",
            f"it blew up: its energy grew {gain} at {_when(recording):.2f} s, "
            f"most of it in link '{name}'",
            robot.link[name].place,
            "link",
            name,
            "parts that start in each other push each other off, or a link is far lighter, or its "
            "inertia far smaller, than what hangs on it",
            "tiny-moving-inertia",
        )
        return
    if rest.fell:
        touching = any(body.shapes for body in bodies.bodies)
        yield Fault(
            "fell-through",
            "it fell through the floor",
            top.place,
            "link",
            top.name,
            "a part that could touch the floor was below it at the start"
            if touching
            else "no link has a <collision>, so nothing of it can touch",
            "missing-collision",
        )
        return
    if rest.settled is None:
        name, does = _fastest_way(run)
        joint = _fastest_joint(recording)
        at = f"; joint '{joint[0]}' moves at {joint[1]:.3g}" if joint else ""
        yield Fault(
            "not-settled",
            f"it did not come to rest in {recording.times[-1]:.3g} s; link '{name}' still {does}"
            f"{at}",
            robot.link[name].place,
            "link",
            name,
            why_moving(run, rest.drift),
        )
    if bodies.nailed:
        return
    if rest.tilt > LEANS:
        fallen = rest.tilt > TIPPED
        yield Fault(
            "tipped-over" if fallen else "leans",
            f"it {'tipped over' if fallen else 'leans'}: link '{top.name}' is tilted by "
            f"{math.degrees(rest.tilt):.0f}°",
            top.place,
            "link",
            top.name,
            _why_tilted(run, rest),
        )
    elif rest.drift > FAR * size:
        yield from judge_slide(robot, run, rest.drift, rest.supports, stood_on(run))


def _why_tilted(run: Run, rest: Rest) -> str:
    if _is_arm(run):
        return "an arm is usually bolted down: --fixed-base simulates it so"
    names = stood_on(run)
    if rest.margin is not None and rest.margin < 0:
        why = "its centre of mass is not above where it touches the floor"
    elif rest.supports:
        why = f"it lies on {listed(rest.supports)}"
    else:
        why = "nothing under it touches the floor"
    stood = f"it was put on {listed(names)}; " if names else ""
    return f"{stood}{why}; a robot that is bolted down is simulated with --fixed-base"


def stood_on(run: Run) -> list[str]:
    """Links whose shapes reached lowest at the start, within ``STANDS`` of the robot's size."""
    bottoms: dict[str, float] = {}
    for body, pose in zip(run.bodies.bodies, run.recording.poses[0], strict=True):
        x, y, z, w = pose[3:].tolist()
        turn = np.array(rotation_of_quaternion((w, x, y, z)))
        for shape in body.shapes:
            bottom = lowest([shape], turn, pose[:3])
            bottoms[shape.link] = min(bottom, bottoms.get(shape.link, math.inf))
    least = min(bottoms.values(), default=0.0)
    return [name for name, low in bottoms.items() if low < least + STANDS * run.bodies.size]


def _is_arm(run: Run) -> bool:
    """Whether a robot is one chain of turning joints on a base, as arms are, but for its hand."""
    bodies = run.bodies.bodies
    chain = [0]
    while True:
        children = [number for number, body in enumerate(bodies) if body.parent == chain[-1]]
        if len(children) != 1:
            break
        chain.append(children[0])
    joints = [bodies[number].joint for number in chain[1:]]
    turning = [joint for joint in joints if joint is not None and joint.kind != "prismatic"]
    return len(turning) >= ARM


def _when(recording: Recording) -> float:
    total = np.nan_to_num(recording.kinetic + recording.potential, nan=math.inf)
    return float(recording.times[int(total.argmax())])


def _speeds(run: Run) -> Array:
    found: Array = np.linalg.norm(np.nan_to_num(run.recording.velocities[-1, :, :3]), axis=1)
    return found


def _fastest(run: Run) -> str:
    return run.recording.bodies[int(_speeds(run).argmax())]


def _fastest_way(run: Run) -> tuple[str, str]:
    """The link that moves most at the end, and how: where none goes anywhere, one turns."""
    speeds = _speeds(run)
    rates = np.linalg.norm(np.nan_to_num(run.recording.velocities[-1, :, 3:]), axis=1)
    turning = int(rates.argmax())
    if speeds.max() * WINDOW < CREEP * run.bodies.size and rates[turning] * WINDOW > TURN:
        return run.recording.bodies[turning], f"turns at {rates[turning]:.3g} rad/s"
    return _fastest(run), f"moves at {speeds.max():.3g} m/s"


def _fastest_joint(recording: Recording) -> tuple[str, float] | None:
    if not recording.joints:
        return None
    rates = np.abs(np.nan_to_num(recording.rates[-1]))
    number = int(rates.argmax())
    return (recording.joints[number], float(rates[number])) if rates[number] > 0.01 else None
