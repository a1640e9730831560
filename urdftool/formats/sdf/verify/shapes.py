"""Comparison of visuals and collisions by geometry and pose, independent of their link."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ....compare.check import Check
from .dynamics import compute_poses
from .mechanism import Array, Mechanism, Shape, invert_pose
from .source import get_base

if TYPE_CHECKING:
    from .compare import Pair

PLACES = 1e-9
COLORS = 1e-6
SIZES = 1e-9


def compare_shapes(pair: Pair, kind: str, configurations: Sequence[Mapping[str, float]]) -> Check:
    """Compare all visuals or collisions by geometry and pose in the root's frame."""
    source: list[Shape] = getattr(pair.source, kind)
    check = Check(kind, f"{len(source)} shapes, sizes, meshes, places", PLACES)
    made: list[Shape] = getattr(pair.made, kind)
    here = _get_places(pair, pair.source, source, configurations, renamed=False)
    there = _get_places(pair, pair.made, made, configurations, renamed=True)
    left = list(range(len(made)))
    for index, shape in enumerate(source):
        nearest = _get_nearest(shape, here[index], made, there, left)
        excused = shape.link in pair.excuses.shapes
        if nearest is None:
            text = f"{shape.link}: {_format_shape(shape)} is missing"
            (check.announced if excused else check.differing).append(text)
            continue
        left.remove(nearest)
        off = float(np.abs(here[index] - there[nearest]).max())
        check.compare(
            off, f"{shape.link}: {_format_shape(shape)} is at another pose", known=excused
        )
    for index in left:
        members = [n for n, (body, _) in pair.made.frames.items() if body == made[index].body]
        excused = any(pair.link(name) in members for name in pair.excuses.shapes)
        text = f"{made[index].body}: {_format_shape(made[index])} is not in the source"
        (check.announced if excused else check.differing).append(text)
    return check


def compare_colors(pair: Pair) -> Check:
    """Compare the color and texture of each visual with a URDF material."""
    colored = sum(s.rgba is not None or s.picture is not None for s in pair.source.visuals)
    check = Check("colours", f"{colored} visuals, textures", COLORS)
    here = _get_places(pair, pair.source, pair.source.visuals, [{}], renamed=False)
    there = _get_places(pair, pair.made, pair.made.visuals, [{}], renamed=True)
    left = list(range(len(pair.made.visuals)))
    told_last = sorted(enumerate(pair.source.visuals), key=lambda pair: pair[1].rgba is None)
    for index, shape in told_last:
        nearest = _get_nearest(shape, here[index], pair.made.visuals, there, left)
        if nearest is None:
            continue
        left.remove(nearest)
        known = shape.link in pair.excuses.colors
        if shape.picture != pair.made.visuals[nearest].picture:
            check.compare(1.0, f"{shape.link}: has another texture", known=known)
        if shape.rgba is None:
            continue
        found = pair.made.visuals[nearest].rgba
        off = 1.0 if found is None else float(np.abs(np.subtract(found, shape.rgba)).max())
        text = f"{shape.link}: is {found}, not {shape.rgba}"
        check.compare(off, text, known=known)
    return check


def get_matched(pair: Pair, kind: str) -> list[tuple[Shape, Shape]]:
    """Return each visual or collision with the nearest one in the file."""
    source: list[Shape] = getattr(pair.source, kind)
    made: list[Shape] = getattr(pair.made, kind)
    here = _get_places(pair, pair.source, source, [{}], renamed=False)
    there = _get_places(pair, pair.made, made, [{}], renamed=True)
    left, found = list(range(len(made))), []
    for index, shape in enumerate(source):
        nearest = _get_nearest(shape, here[index], made, there, left)
        if nearest is not None:
            left.remove(nearest)
            found.append((shape, made[nearest]))
    return found


def _get_places(
    pair: Pair,
    robot: Mechanism,
    shapes: Sequence[Shape],
    configurations: Sequence[Mapping[str, float]],
    *,
    renamed: bool,
) -> list[Array]:
    """Return the poses of each shape in the root's frame, for all configurations."""
    order = robot.sort_joints()
    rows: list[list[Array]] = [[] for _ in shapes]
    for q in configurations:
        if renamed:
            q = {pair.get_joint(name): value for name, value in q.items()}
        placed = compute_poses(robot, q, order)
        base = np.eye(4)
        root = get_base(pair.robot)
        if renamed and root is not None:
            body, inside = robot.frames.get(pair.link(root), ("world", np.eye(4)))
            base = invert_pose(placed[body] @ inside)
        for row, shape in zip(rows, shapes, strict=True):
            row.append(base @ placed[shape.body] @ shape.pose)
    return [np.array(row) for row in rows]


def _get_nearest(
    shape: Shape,
    place: Array,
    others: Sequence[Shape],
    places: Sequence[Array],
    left: Sequence[int],
) -> int | None:
    alike = [i for i in left if _is_equal_shape(shape, others[i])]

    def distance(i: int) -> tuple[float, bool]:
        """Return the distance, and whether the color differs, which breaks ties."""
        return max(float(np.abs(places[i] - place).max()), PLACES), others[i].rgba != shape.rgba

    return min(alike, key=distance, default=None)


def _is_equal_shape(one: Shape, two: Shape) -> bool:
    if len(one.what) != len(two.what):
        return False
    for a, b in zip(one.what, two.what, strict=True):
        if isinstance(a, str) or isinstance(b, str):
            if a != b or a in ("missing", "unknown"):
                return False
        elif abs(a - b) > SIZES * max(abs(a), 1e-30):
            return False
    return True


def _format_shape(shape: Shape) -> str:
    sizes = " ".join(f"{part:.6g}" for part in shape.what[1:] if not isinstance(part, str))
    return f"{shape.what[0]} {sizes}".rstrip()
