"""Fitting of boxes, cylinders, capsules and spheres to a surface.

Each is fitted by least squares of the signed distances of surface points, so that noise averages
out instead of enlarging the shape, from several initial axes. A second fit gives large distances
more weight, for surfaces that only resemble the shape.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ..errors import MeshError
from ..geometry.mesh import Points
from .convex import compute_hull
from .piece import Piece, make_primitive

POINTS = 1500
"""Number of points to which a shape is fitted. Chosen, no source."""

SHARP = 4.0
"""Exponent of the second fit. Chosen, no source."""

# chosen, no source, where a line gives none
_STARTS = 3  # frames from which a fit starts, the best ones
_DIGITS = 7  # significant digits of a size, as of 32 bits
_UPRIGHT = 2e-3  # angles [rad] below this are noise


def measure_box_distance(points: Points, size: Points) -> Points:
    """Compute the signed distance [m] of points to a box about the origin."""
    beyond = np.abs(points) - np.asarray(size) / 2
    return np.asarray(
        np.linalg.norm(np.maximum(beyond, 0), axis=1) + np.minimum(beyond.max(axis=1), 0)
    )


def measure_cylinder_distance(points: Points, size: Points) -> Points:
    """Compute the signed distance [m] to a cylinder about z; ``size`` is radius and length."""
    beyond = np.stack(
        [
            np.hypot(points[:, 0], points[:, 1]) - size[0],
            np.abs(points[:, 2]) - size[1] / 2,
        ],
        axis=1,
    )
    return np.asarray(
        np.linalg.norm(np.maximum(beyond, 0), axis=1) + np.minimum(beyond.max(axis=1), 0)
    )


def measure_capsule_distance(points: Points, size: Points) -> Points:
    """Compute the signed distance [m] to a capsule about z; ``size`` is radius and length."""
    half = size[1] / 2
    z = points[:, 2] - np.clip(points[:, 2], -half, half)
    return np.asarray(np.sqrt(points[:, 0] ** 2 + points[:, 1] ** 2 + z**2) - size[0])


def measure_sphere_distance(points: Points, size: Points) -> Points:
    """Compute the signed distance [m] of points to a sphere about the origin."""
    return np.asarray(np.linalg.norm(points, axis=1) - size[0])


DISTANCES: dict[str, Callable[[Points, Points], Points]] = {
    "box": measure_box_distance,
    "cylinder": measure_cylinder_distance,
    "capsule": measure_capsule_distance,
    "sphere": measure_sphere_distance,
}


def measure_primitive_distance(piece: Piece, points: Points) -> Points:
    """Compute the signed distance [m] of points to a primitive."""
    return DISTANCES[piece.kind](piece.transform_to_local(points), np.array(piece.size))


def fit_primitives(points: Points, kinds: tuple[str, ...] = tuple(DISTANCES)) -> list[Piece]:
    """Fit each kind of primitive twice: by least squares, and with more weight on large distances.

    Args:
        points: Points spread evenly over the surface [m].
        kinds: Kinds to fit.
    """
    some = points[:: max(1, len(points) // POINTS)]
    middle = (some.max(axis=0) + some.min(axis=0)) / 2
    scale = float(np.linalg.norm(np.ptp(some, axis=0))) or 1.0
    unit = (some - middle) / scale
    frames = list(_list_frames(unit))
    found = []
    for kind in kinds:
        for rotation, center, size in _list_fits(kind, unit, frames):
            if min(size) > 1e-6:
                found.append(
                    _canonicalize(kind, rotation, center * scale + middle, size * scale, scale)
                )
    return found


def _list_fits(
    kind: str, points: Points, frames: list[Points]
) -> Iterator[tuple[Points, Points, Points]]:
    distance = DISTANCES[kind]
    starts: list[tuple[float, int, Points, Points, Points]] = []
    for frame in _list_starts(kind, frames):
        local = points @ frame
        low, high = local.min(axis=0), local.max(axis=0)
        size = _estimate_size(kind, high - low)
        center = frame @ ((low + high) / 2)
        score = float(np.mean(distance((points - center) @ frame, size) ** 2))
        starts.append((score, len(starts), frame, center, size))
    starts.sort(key=lambda start: start[:2])
    plain = [
        _refine(distance, points, frame, center, size, kind == "sphere")
        for _, _, frame, center, size in starts[: _STARTS if kind != "sphere" else 1]
    ]
    best = min(plain, key=lambda fit: fit[0])
    yield best[1:]
    yield _refine(distance, points, *best[1:], kind == "sphere", power=SHARP)[1:]


def _refine(
    distance: Callable[[Points, Points], Points],
    points: Points,
    frame: Points,
    center: Points,
    size: Points,
    round_: bool,
    power: float = 2.0,
) -> tuple[float, Points, Points, Points]:
    from scipy.optimize import least_squares
    from scipy.spatial.transform import Rotation

    turns = 0 if round_ else 3
    smallest = 1e-4

    def parts(values: Points) -> tuple[Points, Points, Points]:
        turned = frame if round_ else frame @ Rotation.from_rotvec(values[:3]).as_matrix()
        return turned, values[turns : turns + 3], np.maximum(values[turns + 3 :], smallest)

    def residuals(values: Points) -> Points:
        turned, middle, lengths = parts(values)
        off = distance((points - middle) @ turned, lengths)
        return off if power == 2.0 else np.abs(off) ** (power / 2) * 10

    start = np.concatenate([np.zeros(turns), center, size])
    found = least_squares(residuals, start, method="trf", x_scale=0.1, max_nfev=40)
    turned, middle, lengths = parts(found.x)
    return float(found.cost), turned, middle, lengths


def _estimate_size(kind: str, extent: Points) -> Points:
    across = (extent[0] + extent[1]) / 4
    if kind == "box":
        return np.asarray(np.maximum(extent, 1e-3))
    if kind == "sphere":
        return np.array([extent.mean() / 2])
    length = extent[2] if kind == "cylinder" else max(extent[2] - 2 * across, 1e-3)
    return np.array([max(across, 1e-3), max(length, 1e-3)])


def _list_frames(points: Points) -> Iterator[Points]:
    """Yield candidate axes: the mesh's, its principal axes, and those of its tightest box."""
    yield np.eye(3)
    centered = points - points.mean(axis=0)
    _, axes = np.linalg.eigh(centered.T @ centered)
    yield _make_right_handed(axes)
    try:
        yield _compute_tight_frame(points)
    except MeshError:  # for a flat mesh the other two are sufficient
        return


def _compute_tight_frame(points: Points) -> Points:
    """Compute the axes of the smallest box with a side on one of the 200 largest hull faces."""
    vertices, faces = compute_hull(points)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    unit = normals / np.maximum(areas, 1e-300)[:, None]
    best, least = np.eye(3), np.inf
    for index in np.argsort(-areas, kind="stable")[:200]:
        z = unit[index]
        x = np.cross(z, np.eye(3)[int(np.argmin(np.abs(z)))])
        x /= np.linalg.norm(x)
        y = np.cross(z, x)
        flat = np.stack([vertices @ x, vertices @ y], axis=1)
        angles = np.linspace(0, np.pi / 2, 46)[:-1]
        turn = np.stack([np.cos(angles), np.sin(angles)])
        widths = np.ptp(flat @ turn, axis=0)
        heights = np.ptp(flat @ np.stack([-turn[1], turn[0]]), axis=0)
        smallest = int(np.argmin(widths * heights))
        volume = float(widths[smallest] * heights[smallest] * np.ptp(vertices @ z))
        if volume < least:
            cos, sin = turn[:, smallest]
            least, best = volume, np.stack([cos * x + sin * y, cos * y - sin * x, z], axis=1)
    return _make_right_handed(np.asarray(best))


def _list_starts(kind: str, frames: list[Points]) -> Iterator[Points]:
    """Yield the frames, and for round shapes each of their axes as the axis of revolution."""
    if kind == "sphere":
        yield np.eye(3)
        return
    for frame in frames:
        if kind == "box":
            yield frame
            continue
        for axis in range(3):
            yield frame[:, [(axis + 1) % 3, (axis + 2) % 3, axis]]


def _make_right_handed(axes: Points) -> Points:
    turned = axes.copy()
    if np.linalg.det(turned) < 0:
        turned[:, 0] = -turned[:, 0]
    return np.asarray(turned)


def _canonicalize(kind: str, rotation: Points, center: Points, size: Points, scale: float) -> Piece:
    """Create the equivalent shape with the smallest rotation and rounded numbers."""
    if kind == "sphere":
        rotation = np.eye(3)
    elif kind == "box":
        rotation, size = _find_canonical_box_axes(rotation, size)
    else:
        rotation = _compute_minimal_rotation(rotation[:, 2])
    digits = max(0, _DIGITS - int(np.ceil(np.log10(scale)))) - 1
    lengths = tuple(float(np.round(length, digits)) for length in size)
    return make_primitive(kind, lengths, rotation, np.round(center, digits))


def _find_canonical_box_axes(rotation: Points, size: Points) -> tuple[Points, Points]:
    best, found = -np.inf, (rotation, size)
    for order in ((0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)):
        axes = rotation[:, list(order)]
        axes = axes * np.where(np.diag(axes) < 0, -1.0, 1.0)
        if np.linalg.det(axes) > 0 and np.trace(axes) > best:
            best, found = float(np.trace(axes)), (axes, size[list(order)])
    axes, size = found
    turn = float(np.arccos(np.clip((np.trace(axes) - 1) / 2, -1, 1)))
    return (np.eye(3) if turn < _UPRIGHT else axes), size


def _compute_minimal_rotation(axis: Points) -> Points:
    """Return the smallest rotation from z to an axis; the sign of the axis does not matter."""
    z = axis / np.linalg.norm(axis)
    nearest = int(np.argmax(np.abs(z)))
    if np.linalg.norm(np.delete(z, nearest)) < _UPRIGHT:
        z = np.eye(3)[nearest] * np.sign(z[nearest])
    if z[2] < 0 or (z[2] == 0 and z[int(np.argmax(np.abs(z)))] < 0):
        z = -z
    x, y, c = z
    if c > 1 - 1e-12:
        return np.eye(3)
    return np.array(
        [
            [1 - x * x / (1 + c), -x * y / (1 + c), x],
            [-x * y / (1 + c), 1 - y * y / (1 + c), y],
            [-x, -y, c],
        ]
    )
