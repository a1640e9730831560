"""Visual and collision side by side: what was there to the left, what touches to the right."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..errors import UrdftoolError
from ..meshes.mesh import Points
from ..model.elements import Robot
from ..model.kinematics import link_poses
from ..model.pose import IDENTITY, Pose, pose_of
from .check import shape_pieces
from .compute import Result, Task
from .links import LinkPlan
from .piece import Piece
from .raster import png, render, view_axes
from .surface import read_surface

SIZE = (640, 560)
"""Width and height of either half in pixels."""

_GREY = (0.72, 0.74, 0.78)
_VIEW = (np.radians(-50.0), np.radians(25.0))
_MARGIN = 1.12

# light enough to be told apart when they are shaded
_COLORS = np.array(
    [
        (0.90, 0.45, 0.30),
        (0.35, 0.62, 0.86),
        (0.52, 0.77, 0.42),
        (0.93, 0.76, 0.32),
        (0.65, 0.50, 0.82),
        (0.36, 0.77, 0.75),
        (0.90, 0.55, 0.70),
        (0.62, 0.60, 0.45),
    ]
)

Colored = list[tuple[Points, tuple[float, ...]]]


def mesh_picture(task: Task, result: Result) -> bytes:
    """A PNG of one mesh and its pieces."""
    surface = read_surface(task.path, task.scale)
    left: Colored = [(surface.corners, _GREY)]
    right: Colored = [(p.corners, _color(n)) for n, p in enumerate(result.pieces)]
    return side_by_side(left, right)


def robot_picture(robot: Robot, plans: Sequence[LinkPlan], results: Mapping[Task, Result]) -> bytes:
    """A PNG of a robot at the zero of its joints: its visuals, and its new collisions."""
    poses = link_poses(robot)
    planned = {item.index: item for item in plans}
    left: Colored = []
    right: Colored = []
    for index, link in enumerate(robot.links):
        pose = poses.get(link.name, IDENTITY)
        for visual in link.visuals:
            left += [(_placed(p, pose), _GREY) for p in _readable(robot, visual)]
        pieces: list[Piece] = []
        item = planned.get(index)
        kept = [n for n in range(len(link.collisions)) if not item or n not in item.replaced]
        for number in kept:
            pieces += _readable(robot, link.collisions[number])
        for use in item.uses if item else ():
            if use.task is None:
                pieces += _readable(robot, use.shape)
                continue
            at = pose_of(use.shape.origin)
            rotation, xyz = np.array(at.rotation), np.array(at.translation)
            pieces += [piece.posed(rotation, xyz) for piece in results[use.task].pieces]
        first = len(right)
        right += [(_placed(p, pose), _color(first + n)) for n, p in enumerate(pieces)]
    if not left and not right:
        raise UrdftoolError("the robot has nothing that could be drawn")
    return side_by_side(left, right)


def side_by_side(left: Colored, right: Colored) -> bytes:
    """Two groups of triangles from the same place, as a PNG."""
    axes = view_axes(*_VIEW)
    points = np.concatenate([corners.reshape(-1, 3) for corners, _ in left + right]) @ axes.T
    low, high = points.min(axis=0), points.max(axis=0)
    width, height = SIZE
    pixel = _MARGIN * max((high[0] - low[0]) / width, (high[1] - low[1]) / height, 1e-12)
    middle = (low + high) / 2
    window = (float(middle[0]), float(middle[1]), float(pixel))
    halves = []
    for group in (left, right):
        if not group:
            halves.append(np.ones((height, width, 3)))
            continue
        corners = np.concatenate([corners for corners, _ in group])
        colors = np.concatenate([np.tile(color, (len(corners), 1)) for corners, color in group])
        halves.append(render(corners, colors, axes, window, SIZE))
    line = np.full((height, 2, 3), 0.8)
    return png(np.concatenate([halves[0], line, halves[1]], axis=1))


def _placed(piece: Piece, pose: Pose) -> Points:
    return np.asarray(piece.corners @ np.array(pose.rotation).T + np.array(pose.translation))


def _readable(robot: Robot, shape: object) -> list[Piece]:
    """A shape's pieces; nothing where its mesh cannot be read, which was said before."""
    try:
        return shape_pieces(robot, shape)  # type: ignore[arg-type]
    except UrdftoolError:
        return []


def _color(number: int) -> tuple[float, ...]:
    return tuple(_COLORS[number % len(_COLORS)])
