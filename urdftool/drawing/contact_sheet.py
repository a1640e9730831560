"""Contact sheet: every joint at both limits, in one picture."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace

import numpy as np

from ..model.elements import Joint, Robot
from ..model.kinematics import compute_link_poses, find_movable_joints, get_limits
from .camera import Camera, View
from .picture import view_of
from .png_file import Image
from .points import compute_extent
from .raster import Indices
from .shapes import Shapes
from .text import Words, draw_text
from .visibility import Cloud, choose_best_camera, draw_through

TURN = math.pi / 2
"""Displacement of a joint without limits [rad]."""

_SLIDE = 0.25  # of the robot's size, for a prismatic joint without limits; chosen
_PAPER = (250, 250, 251)
"""Color of the page. Chosen, no source."""

_GREY, _FADED = np.array([0.80, 0.81, 0.82]), 0.82
_CHILD, _AFTER = np.array([0.95, 0.42, 0.10]), np.array([0.97, 0.68, 0.42])
_MARGIN, _GAP = 16, 6
"""Pixels around the page, and between two pictures. Chosen, no source."""

_HIGH = math.radians(55.0)  # elevation of the upper cameras
_FULL = 2 * math.pi - math.radians(2.0)  # limits this far apart show the same pose twice
_SHAPE = 1.35  # desired width over height of a sheet; chosen


@dataclass(frozen=True)
class Sweep:
    """A joint with the two positions at which it is drawn [rad or m].

    Attributes:
        joint: The joint.
        ends: Both positions.
        bounded: Whether these are its limits; if not, it has no limits or may turn fully.
        followers: Joints that mimic it, directly or not.
    """

    joint: Joint
    ends: tuple[float, float]
    bounded: bool
    followers: tuple[str, ...]


def list_sweeps(
    robot: Robot, *, slide: float = 0.1, shown: Collection[str] | None = None
) -> list[Sweep]:
    """List the joints that move independently, in the order of the file, with their mimic joints.

    A joint without limits, or with limits a full turn apart, moves 90° to either side.

    Args:
        robot: The robot.
        slide: Displacement of a prismatic joint without limits [m].
        shown: Links with triangles; joints that move none of them are skipped. None keeps all.
    """
    movable = find_movable_joints(robot)
    leaders = {
        name: joint.mimic.joint
        for name, joint in movable.items()
        if joint.mimic is not None and joint.mimic.joint in movable
    }
    sweeps = []
    for name, joint in movable.items():
        if name in leaders:
            continue
        lower, upper = get_limits(joint)
        bounded = math.isfinite(lower) and math.isfinite(upper)
        if joint.type != "prismatic" and upper - lower >= _FULL:
            bounded = False
        reach = slide if joint.type == "prismatic" else TURN
        ends = (lower, upper) if bounded else (-reach, reach)
        followers = tuple(other for other in leaders if _find_leader(other, leaders) == name)
        sweep = Sweep(joint, ends, bounded, followers)
        if shown is None or not _find_moved_links(robot, sweep).isdisjoint(shown):
            sweeps.append(sweep)
    return sweeps


def list_shown_links(shapes: Shapes) -> set[str]:
    """Return the links that have triangles."""
    return {shapes.links[row] for row in np.unique(shapes.link)}


def draw_contact_sheet(
    robot: Robot,
    shapes: Shapes,
    *,
    positions: Mapping[str, float] | None = None,
    camera: Camera | None = None,
    cell: tuple[int, int] | None = None,
    progress: Callable[[int, int, str], None] = lambda *_: None,
) -> Image:
    """Draw two pictures per joint, at its lower and its upper limit, with its name.

    The joint's child link has a strong color, its descendants a lighter one, the rest is gray.
    Moving links are visible through the rest. Both pictures of a joint have the same viewpoint.
    Joints that move no triangle are skipped.

    Other joints are at ``positions`` [rad or m], by default 0; a cell has a size in pixels.

    Returns:
        Pixels, shape (height, width, 3); a sheet with only a title if no joint moves.
    """
    given = dict(positions or {})
    corners, _, there = shapes.transform(compute_link_poses(robot, given))
    seen = corners[there].reshape(-1, 3)
    size = compute_extent(seen) if len(seen) else 1.0
    sweeps = list_sweeps(robot, slide=_SLIDE * size, shown=list_shown_links(shapes))
    left_out = len(list_sweeps(robot)) - len(sweeps)
    cloud = Cloud(shapes)
    layout = choose_layout(len(sweeps), cell)
    page = np.full((layout.height, layout.width, 3), 255, np.uint8)
    page[:] = _PAPER
    title = robot.name or "robot"
    count = (
        f"{len(sweeps)} joint{'' if len(sweeps) == 1 else 's'}" if sweeps else "no movable joints"
    )
    if left_out:
        count += f"; {left_out} more without geometry"
    words = [
        Words(
            f"{title}: {count}", (_MARGIN, _MARGIN), layout.width - 2 * _MARGIN, layout.letter + 4
        )
    ]
    for number, sweep in enumerate(sweeps):
        progress(number + 1, len(sweeps), sweep.joint.name)
        left, top = layout.place(number)
        words += _make_captions(sweep, left, top, layout)
        pair = _pair(robot, shapes, cloud, sweep, given, camera, layout.cell)
        for side, image in enumerate(pair):
            row, column = top + layout.caption, left + side * (layout.cell[0] + _GAP)
            page[row : row + layout.cell[1], column : column + layout.cell[0]] = image
    return draw_text(page, words)


@dataclass(frozen=True)
class Layout:
    """Layout of a sheet, in pixels."""

    columns: int
    rows: int
    cell: tuple[int, int]
    letter: int

    @property
    def caption(self) -> int:
        """Return the height of the text above the pictures of a joint."""
        return 2 * self.letter + 14

    @property
    def block(self) -> tuple[int, int]:
        """Return width and height of a joint's block, including the margin after it."""
        return 2 * self.cell[0] + _GAP + _MARGIN, self.cell[1] + self.caption + _MARGIN

    @property
    def head(self) -> int:
        """Return the height of the title."""
        return self.letter + 2 * _MARGIN

    @property
    def width(self) -> int:
        """Return the width of the sheet."""
        return self.columns * self.block[0] + _MARGIN

    @property
    def height(self) -> int:
        """Return the height of the sheet."""
        return self.head + self.rows * self.block[1] + _MARGIN // 2

    def place(self, number: int) -> tuple[int, int]:
        """Return column and row of a block's upper left corner; blocks fill columns first."""
        column, row = divmod(number, max(self.rows, 1))
        return _MARGIN + column * self.block[0], self.head + row * self.block[1]


def choose_layout(count: int, cell: tuple[int, int] | None = None) -> Layout:
    """Choose the number of columns that gives the sheet roughly the shape of a screen."""
    cell = cell or _choose_cell(count)
    letter = min(max(cell[1] // 16, 11), 22)
    best = Layout(1, max(count, 1), cell, letter)
    for columns in range(1, count + 1):
        made = Layout(columns, -(-count // columns), cell, letter)
        if _compute_deviation(made) < _compute_deviation(best):
            best = made
    return best


def _compute_deviation(layout: Layout) -> float:
    return abs(math.log(layout.width / layout.height / _SHAPE))


def _choose_cell(count: int) -> tuple[int, int]:
    """Choose the size of a picture, smaller for many joints."""
    if count <= 8:
        return 360, 300
    if count <= 24:
        return 300, 250
    return (228, 190) if count <= 200 else (120, 100)


def _find_leader(name: str, leaders: Mapping[str, str]) -> str | None:
    """Return the joint at the end of a chain of mimic joints; None for a cycle."""
    seen: set[str] = set()
    while name in leaders and name not in seen:
        seen.add(name)
        name = leaders[name]
    return None if name in leaders else name


def _pair(
    robot: Robot,
    shapes: Shapes,
    cloud: Cloud,
    sweep: Sweep,
    given: Mapping[str, float],
    camera: Camera | None,
    cell: tuple[int, int],
) -> list[Image]:
    """Draw a joint at both positions, from one viewpoint."""
    painted = _color_moved(robot, shapes, sweep)
    names = _find_moved_links(robot, sweep)
    moved = np.zeros(len(shapes), dtype=bool)
    moved[_find_rows(shapes, names)] = True
    free = {k: v for k, v in given.items() if k not in sweep.followers}
    at = [compute_link_poses(robot, {**free, sweep.joint.name: end}) for end in sweep.ends]
    both = []
    for poses in at:
        corners, _, there = shapes.transform(poses)
        both.append(corners[there])
    if camera is None:
        camera = choose_best_camera(cloud, at, names, _list_cameras())
    lowest = min((float(some[..., 2].min()) for some in both if len(some)), default=0.0)
    view: View = view_of(np.concatenate(both), camera, cell)
    return [draw_through(painted, poses, moved, view=view, ground=lowest) for poses in at]


def _list_cameras() -> list[Camera]:
    """Return the candidate viewpoints of a joint, the default first."""
    usual = Camera()
    around = [usual.azimuth + turn * math.pi / 4 for turn in (0, 2, -2, 4, 1, -1, 3, -3)]
    return [
        replace(usual, azimuth=azimuth, elevation=elevation)
        for elevation in (usual.elevation, _HIGH)
        for azimuth in around
    ]


def _find_moved_links(robot: Robot, sweep: Sweep) -> set[str]:
    """Return the links that a joint and its followers move."""
    moved: set[str] = set()
    for name in (sweep.joint.name, *sweep.followers):
        child = robot.joint[name].child
        moved |= {child, *robot.tree.list_descendants(child)}
    return moved


def _color_moved(robot: Robot, shapes: Shapes, sweep: Sweep) -> Shapes:
    """Color the shapes gray, except for the links that a joint moves."""
    own = shapes.colors[:, :3].mean(axis=1, keepdims=True)
    colors = shapes.colors.copy()
    colors[:, :3] = own * (1 - _FADED) + _GREY * _FADED
    for names, color in ((_find_moved_links(robot, sweep), _AFTER), ({sweep.joint.child}, _CHILD)):
        colors[_find_rows(shapes, names), :3] = color
    return shapes.with_colors(colors)


def _find_rows(shapes: Shapes, names: set[str]) -> Indices:
    selected = np.array([name in names for name in shapes.links], dtype=bool)
    return np.flatnonzero(selected[shapes.link]) if len(selected) else np.zeros(0, dtype=np.int64)


def _make_captions(sweep: Sweep, left: int, top: int, layout: Layout) -> list[Words]:
    joint, letter = sweep.joint, layout.letter
    kind = joint.type if sweep.bounded else f"{joint.type}, {_format_limits(joint)}"
    if sweep.followers:
        kind += f", {len(sweep.followers)} mimic{'s' if len(sweep.followers) == 1 else ''}"
    wide = 2 * layout.cell[0] + _GAP
    words = [Words(f"{joint.name}  ({kind})", (left, top), wide, letter)]
    for side, (name, end) in enumerate(zip(("lower", "upper"), sweep.ends, strict=True)):
        label = name if sweep.bounded else "shown"
        at = (left + side * (layout.cell[0] + _GAP), top + letter + 6)
        text = f"{label} {position_text(joint, end)}"
        words.append(Words(text, at, layout.cell[0], max(letter - 2, 10), (105, 110, 120)))
    return words


def _format_limits(joint: Joint) -> str:
    lower, upper = get_limits(joint)
    if not (math.isfinite(lower) and math.isfinite(upper)):
        return "no limits"
    return f"limits {math.degrees(lower):.4g}° to {math.degrees(upper):.4g}°"


def position_text(joint: Joint, value: float) -> str:
    """Format a position with its unit: degrees and radians, or meters."""
    if joint.type == "prismatic":
        return f"{value:.4g} m"
    return f"{math.degrees(value):.4g}° ({value:.4g} rad)"
