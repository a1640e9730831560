"""Where a run ended: fallen, tilted, moved, and what carries the robot there."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...model.pose import IDENTITY, multiply_matrices, rotation_from_quaternion, transpose
from ..recording import GROUND, Array
from ..run import Run
from ..shapes import Shape, compute_lowest_height


@dataclass(frozen=True)
class FinalState:
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


def measure_final_state(run: Run) -> FinalState:
    """Measure the end of a run."""
    recording, bodies = run.recording, run.bodies
    root = recording.poses[:, 0, :]
    good = np.isfinite(root).all(axis=1)
    first, last = root[0], root[good][-1]
    supports = tuple(dict.fromkeys(c.one for c in recording.contacts if c.other == GROUND))
    centre = run.compute_center_of_mass(range(len(bodies.bodies)), -1)
    gain = np.nan_to_num(recording.kinetic + recording.potential, nan=math.inf).max()
    size = max(bodies.size, 1e-3)
    lost = (
        last[2] < first[2] - max(run.thresholds.fall_sizes * size, run.thresholds.fall_depth)
        and not supports
    )
    return FinalState(
        recording.still_since,
        float(first[2] - last[2]),
        float(math.hypot(*(last[:2] - first[:2]))),
        measure_tilt(first, last, run),
        centre,
        None if centre is None else _measure_margin(run, centre),
        supports,
        float(gain),
        bool(lost and not bodies.fixed_base),
    )


def measure_tilt(first: Array, last: Array, run: Run) -> float:
    """Measure how far the root's upright axis is turned at the end [rad]."""
    x, y, z, w = last[3:]
    now = rotation_from_quaternion((w, x, y, z))
    upright = IDENTITY.rotation
    turned = multiply_matrices(now, transpose(upright))
    return math.acos(max(-1.0, min(1.0, turned[2][2])))


def _measure_margin(run: Run, centre: tuple[float, float, float]) -> float | None:
    """Measure from the center of mass, along gravity, to the support polygon's nearest edge [m]."""
    points = collect_footprint(run)
    if not len(points):
        return None
    below = np.array([centre[0] + centre[2] * math.tan(run.settings.slope), centre[1]])
    return support_margin(points, below)


def support_margin(points: Array, at: Array) -> float:
    """Measure how far inside the hull of others a point is [m]; negative is outside.

    Args:
        points: Shape (n, 2), at least one.
        at: Shape (2,).
    """
    corners = _compute_corners(sorted(set(map(tuple, points.tolist()))))
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


def _compute_corners(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Compute the convex hull of sorted points, counterclockwise, by Andrew's chains."""
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


def find_initial_support_links(run: Run) -> list[str]:
    """Find the links whose shapes reach lowest at the start."""
    bottoms: dict[str, float] = {}
    for body, pose in zip(run.bodies.bodies, run.recording.poses[0], strict=True):
        x, y, z, w = pose[3:].tolist()
        turn = np.array(rotation_from_quaternion((w, x, y, z)))
        for shape in body.shapes:
            bottom = compute_lowest_height([shape], turn, pose[:3])
            bottoms[shape.link] = min(bottom, bottoms.get(shape.link, math.inf))
    least = min(bottoms.values(), default=0.0)
    return [
        name
        for name, low in bottoms.items()
        if low < least + run.thresholds.start_height * run.bodies.size
    ]


def collect_footprint(run: Run) -> Array:
    """Collect the points of the plane that carry the robot at the end [m], shape (n, 2)."""
    touching = run.recording.carrying
    found = [np.array([contact.point[:2] for contact in touching]).reshape(-1, 2)]
    links = {contact.one for contact in touching}
    for number, body in enumerate(run.bodies.bodies):
        shapes = [shape for shape in body.shapes if shape.link in links]
        if not shapes:
            continue
        pose = run.end.get_pose(number)
        turn, at = np.array(pose.rotation), np.array(pose.translation)
        highest = (
            compute_lowest_height(shapes, turn, at)
            + run.thresholds.footprint_height * run.bodies.size
        )
        for shape in shapes:
            corners = _place_corners(shape) @ turn.T + at
            found.append(corners[corners[:, 2] <= highest, :2])
    return np.concatenate(found)


def _place_corners(shape: Shape) -> Array:
    """Place the corners of a shape in its body's frame, (n, 3); round shapes have none."""
    if shape.kind not in ("mesh", "box"):
        return np.zeros((0, 3))
    turned = shape.get_corners() @ np.array(shape.pose.rotation).T
    placed: Array = turned + np.array(shape.pose.translation)
    return placed
