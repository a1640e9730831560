"""Pictures of visual geometry (left) next to collision geometry (right)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..drawing.camera import Camera
from ..drawing.picture import draw, view_of
from ..drawing.png_file import encode_png
from ..drawing.shapes import Shapes, make_bare_shapes, read_robot_shapes
from ..drawing.text import Words, draw_text
from ..errors import UrdftoolError
from ..model.elements import Robot
from ..model.kinematics import compute_link_poses
from ..model.pose import IDENTITY, Pose, make_pose
from .check import convert_shape
from .compute import Result, Task
from .links import LinkPlan
from .piece import Piece
from .surface import read_surface

SIZE = (640, 560)
"""Width and height of each half in pixels. Chosen, no source."""

_MARGIN = 14  # pixels
_LETTERS = 18  # height of letters [pixels]
_GREY = (0.72, 0.74, 0.78, 1.0)
"""Color of the surface. Chosen, no source."""

_CAMERA = Camera(np.radians(-50.0), np.radians(25.0))

# light enough to be distinguished when shaded
_COLORS = (
    (0.90, 0.45, 0.30),
    (0.35, 0.62, 0.86),
    (0.52, 0.77, 0.42),
    (0.93, 0.76, 0.32),
    (0.65, 0.50, 0.82),
    (0.36, 0.77, 0.75),
    (0.90, 0.55, 0.70),
    (0.62, 0.60, 0.45),
)
"""Colors of the pieces, in turn. Chosen, no source."""


def draw_mesh(task: Task, result: Result) -> bytes:
    """Draw one mesh and its pieces as a PNG file."""
    surface = read_surface(task.path, task.scale, task.gltf_up)
    left = make_bare_shapes([(surface.vertices, surface.faces, _GREY)])
    label = _label(result.pieces, [result.error])
    return draw_side_by_side(left, {"": IDENTITY}, _color(result.pieces), right_label=label)


def draw_robot(robot: Robot, plans: Sequence[LinkPlan], results: Mapping[Task, Result]) -> bytes:
    """Draw a robot's visuals and its new collisions, at the zero pose, as a PNG file.

    Raises:
        UrdftoolError: It has neither.
    """
    poses = compute_link_poses(robot)
    poses = {link.name: poses.get(link.name, IDENTITY) for link in robot.links}
    planned = {item.index: item for item in plans}
    right: list[Piece] = []
    for index, link in enumerate(robot.links):
        pieces: list[Piece] = []
        item = planned.get(index)
        kept = [n for n in range(len(link.collisions)) if not item or n not in item.replaced]
        for number in kept:
            pieces += _read_pieces(robot, link.collisions[number])
        for use in item.uses if item else ():
            if use.task is None:
                pieces += _read_pieces(robot, use.shape)
                continue
            at = make_pose(use.shape.origin)
            rotation, xyz = np.array(at.rotation), np.array(at.translation)
            pieces += [piece.transform(rotation, xyz) for piece in results[use.task].pieces]
        at = poses[link.name]
        rotation, xyz = np.array(at.rotation), np.array(at.translation)
        right += [piece.transform(rotation, xyz) for piece in pieces]
    errors = [found.error for found in results.values()]
    visuals = read_robot_shapes(robot)
    if not len(visuals) and not right:
        raise UrdftoolError("the robot has nothing that could be drawn")
    return draw_side_by_side(visuals, poses, _color(right), right_label=_label(right, errors))


def draw_side_by_side(
    left: Shapes, poses: Mapping[str, Pose], right: Shapes, *, right_label: str
) -> bytes:
    """Draw posed shapes and unposed ones from the same viewpoint, as a PNG file with labels."""
    there = [left.transform(poses), right.transform({"": IDENTITY})]
    view = view_of(np.concatenate([corners[seen] for corners, _, seen in there]), _CAMERA, SIZE)
    halves = [
        draw(left, poses, camera=view, ground=False),
        draw(right, {"": IDENTITY}, camera=view, ground=False),
    ]
    line = np.full((SIZE[1], 2, 3), 204, np.uint8)
    image = np.concatenate([halves[0], line, halves[1]], axis=1)
    left_label = f"visual geometry: {len(left):,} triangles"
    width = SIZE[0] - 2 * _MARGIN
    labels = [
        Words(left_label, (_MARGIN, _MARGIN), width, _LETTERS),
        Words(right_label, (SIZE[0] + 2 + _MARGIN, _MARGIN), width, _LETTERS),
    ]
    return encode_png(draw_text(image, labels))


def _label(pieces: Sequence[Piece], errors: Sequence[float]) -> str:
    """Describe collision geometry by the number of its pieces and the largest error, if known."""
    number = f"collision geometry: {len(pieces)} piece{'' if len(pieces) == 1 else 's'}"
    if not errors:
        return number
    return f"{number}, {'largest ' if len(errors) > 1 else ''}error {max(errors):.1%}"


def _color(pieces: Sequence[Piece]) -> Shapes:
    """Color pieces differently."""
    return make_bare_shapes(
        (piece.vertices, piece.faces, (*_COLORS[number % len(_COLORS)], 1.0))
        for number, piece in enumerate(pieces)
    )


def _read_pieces(robot: Robot, shape: object) -> list[Piece]:
    """Return a shape's pieces; empty if its mesh cannot be read, which is reported elsewhere."""
    try:
        return convert_shape(robot, shape)  # type: ignore[arg-type]
    except UrdftoolError:
        return []
