"""Measure the final state of a run: pose, support polygon and static margin."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...diagnostic import make_deprecated_name
from ...model.pose import multiply_matrices, rotation_from_quaternion, rotation_from_rpy, transpose
from ..recording import GROUND, Array
from ..run import Run
from ..shapes import Shape, compute_lowest_height


@dataclass(frozen=True)
class FinalState:
    """State of a robot at the end of a run.

    Attributes:
        settled: Time at which it came to rest [s]; None if it did not.
        drop: Distance by which the root sank [m].
        drift: Distance by which the root moved along the plane [m].
        tilt: Angle between the upright and the final direction of the robot [rad].
        center: Center of mass in the world [m]; None if the robot has no mass.
        margin: Distance from the center of mass, projected along gravity, to the nearest edge of
            the support polygon [m]; negative outside; None without a contact with the plane.
        supports: Links in contact with the plane.
        gain: Maximum increase of the total energy [J].
        fell: Whether the robot fell through the plane.
    """

    centre = make_deprecated_name("centre", "center")

    settled: float | None
    drop: float
    drift: float
    tilt: float
    center: tuple[float, float, float] | None
    margin: float | None
    supports: tuple[str, ...]
    gain: float
    fell: bool


def measure_final_state(run: Run) -> FinalState:
    """Measure the final state of a run."""
    recording, bodies = run.recording, run.bodies
    root = recording.poses[:, 0, :]
    good = np.isfinite(root).all(axis=1)
    first, last = root[0], root[good][-1]
    supports = tuple(dict.fromkeys(c.one for c in recording.contacts if c.other == GROUND))
    center = run.compute_center_of_mass(range(len(bodies.bodies)), -1)
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
        measure_tilt(last, run),
        center,
        None if center is None else _measure_margin(run, center),
        supports,
        float(gain),
        bool(lost and not bodies.fixed_base),
    )


def measure_tilt(last: Array, run: Run) -> float:
    """Measure the angle between the upright and the final direction of the robot [rad]."""
    x, y, z, w = last[3:]
    now = rotation_from_quaternion((w, x, y, z))
    upright = rotation_from_rpy(run.settings.upright_rpy)
    turned = multiply_matrices(now, transpose(upright))
    return math.acos(max(-1.0, min(1.0, turned[2][2])))


def _measure_margin(run: Run, center: tuple[float, float, float]) -> float | None:
    """Measure the distance of the projected center of mass to the support polygon's edge [m]."""
    points = collect_footprint(run)
    if not len(points):
        return None
    below = np.array([center[0] + center[2] * math.tan(run.settings.slope), center[1]])
    return support_margin(points, below)


def support_margin(points: Array, at: Array) -> float:
    """Measure how far a point is inside the support polygon [m]; negative is outside.

    Args:
        points: Contact points [m], shape (n, 2), at least one; the polygon is their convex hull.
        at: The point [m], shape (2,).
    """
    corners = _compute_support_polygon(sorted(set(map(tuple, points.tolist()))))
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


def _compute_support_polygon(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Compute the support polygon, counterclockwise: the convex hull of sorted contact points.

    Source: A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979.
    """
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
    """Find the links with the lowest collision geometry at the start."""
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
    """Collect the points of the support polygon at the end [m], shape (n, 2).

    They are the contacts with the plane, and corners of the collision geometry near the plane.
    """
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
    """Transform the corners of a shape to its body's frame [m], shape (n, 3); round ones: none."""
    if shape.kind not in ("mesh", "box"):
        return np.zeros((0, 3))
    turned = shape.get_corners() @ np.array(shape.pose.rotation).T
    placed: Array = turned + np.array(shape.pose.translation)
    return placed
