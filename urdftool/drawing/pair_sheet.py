"""Sheet of poses: one picture for each pair of links that touch."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..model.elements import Robot
from ..model.kinematics import compute_link_poses
from ..model.pair_pose import PairPose
from .camera import Camera
from .picture import view_of
from .png_file import Image
from .shapes import Shapes
from .text import Words, draw_text
from .visibility import Cloud, choose_best_camera, draw_through

MOST = 12
"""Pairs of a sheet. Chosen, no source: more of them are not legible."""

CELL = (560, 460)
"""Width and height of a picture [pixels]. Chosen, no source."""

_PAPER, _SOFT = (250, 250, 251), (105, 110, 120)
"""Colors of the page and of positions, 0 … 255. Chosen, no source."""

_GRAY, _FADED = np.array([0.80, 0.81, 0.82]), 0.82
_ONE, _OTHER = np.array([0.85, 0.30, 0.10]), np.array([0.12, 0.40, 0.72])
_MARGIN, _LETTER, _LINES = 16, 16, 3
"""Margin and letters [pixels], and most lines of positions. Chosen, no source."""

_PER_LINE = 3  # joint positions in a line of a caption; chosen, no source


@dataclass(frozen=True)
class _Grid:
    """Places of the pictures in pixels."""

    columns: int
    rows: int
    cell: tuple[int, int]
    lines: int

    @property
    def caption(self) -> int:
        """Return the height of the text above a picture."""
        return (self.lines + 1) * (_LETTER + 4) + 8

    @property
    def size(self) -> tuple[int, int]:
        """Return width and height of the sheet."""
        width, height = self.place(self.columns * self.rows - 1)
        return width + self.cell[0] + _MARGIN, height + self.caption + self.cell[1] + _MARGIN

    def place(self, number: int) -> tuple[int, int]:
        """Return column and row of the upper left corner of a caption."""
        row, column = divmod(number, self.columns)
        left = _MARGIN + column * (self.cell[0] + _MARGIN)
        return left, 2 * _MARGIN + _LETTER + row * (self.cell[1] + self.caption + _MARGIN)


def draw_pair_sheet(
    robot: Robot,
    shapes: Shapes,
    pairs: Sequence[PairPose],
    *,
    title: str,
    cell: tuple[int, int] = CELL,
    progress: Callable[[int, int, str], None] = lambda *_: None,
) -> Image:
    """Draw each pair of links at the pose at which they touch.

    One link is red, the other blue, the rest gray; both are visible through the rest. The joints
    that do not move the pair are at 0.

    Only the first ``MOST`` pairs are drawn, each in a cell of pixels.

    Returns:
        Pixels, shape (height, width, 3).
    """
    shown = pairs[:MOST]
    columns = max(1, math.ceil(math.sqrt(len(shown))))
    captions = [_list_lines(robot, pair) for pair in shown]
    lines = max(map(len, captions), default=0)
    grid = _Grid(columns, max(1, math.ceil(len(shown) / columns)), cell, lines)
    width, height = grid.size
    page = np.full((height, width, 3), _PAPER, np.uint8)
    words = [Words(title, (_MARGIN, _MARGIN), width - 2 * _MARGIN, _LETTER + 2)]
    cloud = Cloud(shapes)
    for number, pair in enumerate(shown):
        progress(number + 1, len(shown), pair.title)
        left, top = grid.place(number)
        words += _make_caption([pair.title, *captions[number]], left, top, cell[0])
        top += grid.caption
        page[top : top + cell[1], left : left + cell[0]] = _draw(robot, shapes, cloud, pair, cell)
    return draw_text(page, words)


def _draw(
    robot: Robot, shapes: Shapes, cloud: Cloud, pair: PairPose, cell: tuple[int, int]
) -> Image:
    poses = compute_link_poses(robot, dict(pair.positions))
    names = {pair.link1, pair.link2}
    chosen = np.isin(shapes.link, [row for row, name in enumerate(shapes.links) if name in names])
    corners, _, there = shapes.transform(poses)
    seen = corners[there]
    camera = choose_best_camera(cloud, [poses], names, _list_cameras())
    lowest = float(seen[..., 2].min()) if len(seen) else 0.0
    view = view_of(seen, camera, cell)
    return draw_through(_color(shapes, pair), poses, chosen, view=view, ground=lowest)


def _list_cameras() -> list[Camera]:
    """Return the candidate viewpoints, the default first."""
    usual = Camera()
    around = [usual.azimuth + turn * math.pi / 4 for turn in (0, 2, -2, 4, 1, -1, 3, -3)]
    return [replace(usual, azimuth=azimuth) for azimuth in around]


def _color(shapes: Shapes, pair: PairPose) -> Shapes:
    own = shapes.colors[:, :3].mean(axis=1, keepdims=True)
    colors = shapes.colors.copy()
    colors[:, :3] = own * (1 - _FADED) + _GRAY * _FADED
    tones: Mapping[str, np.ndarray] = {pair.link1: _ONE, pair.link2: _OTHER}
    for row, name in enumerate(shapes.links):
        if name in tones:
            colors[shapes.link == row, :3] = tones[name]
    return shapes.with_colors(colors)


def _list_lines(robot: Robot, pair: PairPose) -> list[str]:
    """List the lines of joint positions; those after the last line are left out."""
    texts = [
        f"{name} {value:.4f} {'m' if robot.joint[name].type == 'prismatic' else 'rad'}"
        for name, value in pair.positions.items()
    ]
    lines = [", ".join(texts[at : at + _PER_LINE]) for at in range(0, len(texts), _PER_LINE)]
    if len(lines) > _LINES:
        lines[_LINES - 1] += " …"
    return lines[:_LINES]


def _make_caption(lines: Sequence[str], left: int, top: int, width: int) -> list[Words]:
    title, *others = lines
    words = [Words(title, (left, top), width, _LETTER)]
    for number, line in enumerate(others, 1):
        words.append(Words(line, (left, top + number * (_LETTER + 4)), width, _LETTER - 3, _SOFT))
    return words
