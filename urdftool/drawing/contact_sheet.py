"""Every joint at both its limits, as one picture to look over."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace

import numpy as np

from ..model.elements import Joint, Robot
from ..model.kinematics import limits_of, link_poses, movable_joints, with_mimics
from .camera import Camera, View
from .lettering import Words, lettered
from .picture import view_of
from .png_file import Image
from .points import extent
from .raster import Indices
from .shapes import Shapes
from .visibility import Cloud, best_camera, draw_through

TURN = math.pi / 2
"""How far a joint without limits is turned [rad]."""

_SLIDE = 0.25  # of the robot's size, for a slider without limits
_PAPER = (250, 250, 251)
_GREY, _FADED = np.array([0.80, 0.81, 0.82]), 0.82
_CHILD, _AFTER = np.array([0.95, 0.42, 0.10]), np.array([0.97, 0.68, 0.42])
_MARGIN, _GAP = 16, 6
_HIGH = math.radians(55.0)  # how high a camera stands that looks down
_FULL = 2 * math.pi - math.radians(2.0)  # limits as far apart show a joint twice in one place
_SHAPE = 1.35  # width over height that a sheet is to have


@dataclass(frozen=True)
class Sweep:
    """A joint with the positions at which it is shown [rad, m].

    Attributes:
        joint: It.
        ends: Both positions.
        bounded: Whether these are its limits; otherwise it has none, or may turn all around.
        followers: Joints that mimic it.
    """

    joint: Joint
    ends: tuple[float, float]
    bounded: bool
    followers: tuple[str, ...]


def sweeps_of(
    robot: Robot, *, slide: float = 0.1, shown: Collection[str] | None = None
) -> list[Sweep]:
    """The joints that move on their own, in the order of the file; what mimics follows.

    A joint without limits, or with limits a full turn apart, is turned by 90° to either side.

    Args:
        robot: The robot.
        slide: How far a prismatic joint without limits is moved [m].
        shown: Links with triangles; joints that move none of them are left out. None keeps all.
    """
    movable = movable_joints(robot)
    leaders = {
        name: joint.mimic.joint
        for name, joint in movable.items()
        if joint.mimic is not None and joint.mimic.joint in movable
    }
    sweeps = []
    for name, joint in movable.items():
        if name in leaders:
            continue
        lower, upper = limits_of(joint)
        bounded = math.isfinite(lower) and math.isfinite(upper)
        if joint.type != "prismatic" and upper - lower >= _FULL:
            bounded = False
        reach = slide if joint.type == "prismatic" else TURN
        ends = (lower, upper) if bounded else (-reach, reach)
        followers = tuple(other for other in leaders if _leader(other, leaders) == name)
        sweep = Sweep(joint, ends, bounded, followers)
        if shown is None or not _moved(robot, sweep).isdisjoint(shown):
            sweeps.append(sweep)
    return sweeps


def shown_links(shapes: Shapes) -> set[str]:
    """The links that have triangles."""
    return {shapes.links[row] for row in np.unique(shapes.link)}


def contact_sheet(
    robot: Robot,
    shapes: Shapes,
    *,
    positions: Mapping[str, float] | None = None,
    camera: Camera | None = None,
    cell: tuple[int, int] | None = None,
    progress: Callable[[int, int, str], None] = lambda *_: None,
) -> Image:
    """Two pictures a joint, at its lower and its upper limit, side by side, with its name.

    The link that it moves is drawn in a strong color, its descendants in a lighter one, the rest in
    gray; where the rest hides them, they shine through it. Both pictures of a joint are taken from
    one place. Joints that move no triangle are left out.

    Args:
        robot: The robot.
        shapes: Its shapes.
        positions: Where the other joints are [rad, m]; at zero without it. Mimics follow.
        camera: Where the pictures are taken from; without it, from where most of the links is
            visible that the joint moves.
        cell: Width and height of one picture in pixels; by the number of joints without it.
        progress: Told of each joint before it is drawn: its number, how many, its name.

    Returns:
        Rows of pixels, shape (height, width, 3); for a robot whose joints do not move, a blank
        sheet that says so.
    """
    given = dict(positions or {})
    corners, _, there = shapes.posed(link_poses(robot, with_mimics(robot, given)))
    seen = corners[there].reshape(-1, 3)
    size = extent(seen) if len(seen) else 1.0
    sweeps = sweeps_of(robot, slide=_SLIDE * size, shown=shown_links(shapes))
    left_out = len(sweeps_of(robot)) - len(sweeps)
    cloud = Cloud(shapes)
    layout = layout_of(len(sweeps), cell)
    page = np.full((layout.height, layout.width, 3), 255, np.uint8)
    page[:] = _PAPER
    title = robot.name or "robot"
    count = f"{len(sweeps)} joint{'' if len(sweeps) == 1 else 's'}" if sweeps else "no joint moves"
    if left_out:
        count += f"; {left_out} more move{'s' if left_out == 1 else ''} no shape"
    words = [
        Words(
            f"{title}: {count}", (_MARGIN, _MARGIN), layout.width - 2 * _MARGIN, layout.letter + 4
        )
    ]
    for number, sweep in enumerate(sweeps):
        progress(number + 1, len(sweeps), sweep.joint.name)
        left, top = layout.place(number)
        words += _captions(sweep, left, top, layout)
        pair = _pair(robot, shapes, cloud, sweep, given, camera, layout.cell)
        for side, image in enumerate(pair):
            row, column = top + layout.caption, left + side * (layout.cell[0] + _GAP)
            page[row : row + layout.cell[1], column : column + layout.cell[0]] = image
    return lettered(page, words)


@dataclass(frozen=True)
class Layout:
    """Where things are on a sheet, in pixels.

    Attributes:
        columns: Joints side by side.
        rows: Joints one below the other.
        cell: Width and height of one picture.
        letter: Height of letters.
    """

    columns: int
    rows: int
    cell: tuple[int, int]
    letter: int

    @property
    def caption(self) -> int:
        """Height of the words over the pictures of a joint."""
        return 2 * self.letter + 14

    @property
    def block(self) -> tuple[int, int]:
        """Width and height of a joint's part, with the space after it."""
        return 2 * self.cell[0] + _GAP + _MARGIN, self.cell[1] + self.caption + _MARGIN

    @property
    def head(self) -> int:
        """Height of the title."""
        return self.letter + 2 * _MARGIN

    @property
    def width(self) -> int:
        """Of the sheet."""
        return self.columns * self.block[0] + _MARGIN

    @property
    def height(self) -> int:
        """Of the sheet."""
        return self.head + self.rows * self.block[1] + _MARGIN // 2

    def place(self, number: int) -> tuple[int, int]:
        """Column and row of the upper left corner of a joint's part; joints go down a column."""
        column, row = divmod(number, max(self.rows, 1))
        return _MARGIN + column * self.block[0], self.head + row * self.block[1]


def layout_of(count: int, cell: tuple[int, int] | None = None) -> Layout:
    """As many columns as make the sheet about as wide as a screen.

    Args:
        count: Number of joints.
        cell: Width and height of one picture in pixels; smaller for many joints without it.
    """
    cell = cell or _cell(count)
    letter = min(max(cell[1] // 16, 11), 22)
    best = Layout(1, max(count, 1), cell, letter)
    for columns in range(1, count + 1):
        made = Layout(columns, -(-count // columns), cell, letter)
        if _off(made) < _off(best):
            best = made
    return best


def _off(layout: Layout) -> float:
    return abs(math.log(layout.width / layout.height / _SHAPE))


def _cell(count: int) -> tuple[int, int]:
    """Smaller pictures for many joints."""
    if count <= 8:
        return 360, 300
    if count <= 24:
        return 300, 250
    return (228, 190) if count <= 200 else (120, 100)


def _leader(name: str, leaders: Mapping[str, str]) -> str | None:
    """The joint at the end of a chain of mimics; None for a loop of them."""
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
    """A joint at both ends, from one place."""
    painted = _painted(robot, shapes, sweep)
    names = _moved(robot, sweep)
    moved = np.zeros(len(shapes), dtype=bool)
    moved[_rows(shapes, names)] = True
    free = {k: v for k, v in given.items() if k not in sweep.followers}
    at = [
        link_poses(robot, with_mimics(robot, {**free, sweep.joint.name: end})) for end in sweep.ends
    ]
    both = []
    for poses in at:
        corners, _, there = shapes.posed(poses)
        both.append(corners[there])
    if camera is None:
        camera = best_camera(cloud, at, names, _cameras())
    lowest = min((float(some[..., 2].min()) for some in both if len(some)), default=0.0)
    view: View = view_of(np.concatenate(both), camera, cell)
    return [draw_through(painted, poses, moved, view=view, ground=lowest) for poses in at]


def _cameras() -> list[Camera]:
    """The sides from which a joint may be shown, the usual one first."""
    usual = Camera()
    around = [usual.azimuth + turn * math.pi / 4 for turn in (0, 2, -2, 4, 1, -1, 3, -3)]
    return [
        replace(usual, azimuth=azimuth, elevation=elevation)
        for elevation in (usual.elevation, _HIGH)
        for azimuth in around
    ]


def _moved(robot: Robot, sweep: Sweep) -> set[str]:
    """The links that a joint and its followers move."""
    moved: set[str] = set()
    for name in (sweep.joint.name, *sweep.followers):
        child = robot.joint[name].child
        moved |= {child, *robot.tree.descendants(child)}
    return moved


def _painted(robot: Robot, shapes: Shapes, sweep: Sweep) -> Shapes:
    """The shapes in grey, but for the links that a joint moves."""
    own = shapes.colors[:, :3].mean(axis=1, keepdims=True)
    colors = shapes.colors.copy()
    colors[:, :3] = own * (1 - _FADED) + _GREY * _FADED
    for names, color in ((_moved(robot, sweep), _AFTER), ({sweep.joint.child}, _CHILD)):
        colors[_rows(shapes, names), :3] = color
    return shapes.painted(colors)


def _rows(shapes: Shapes, names: set[str]) -> Indices:
    wanted = np.array([name in names for name in shapes.links], dtype=bool)
    return np.flatnonzero(wanted[shapes.link]) if len(wanted) else np.zeros(0, dtype=np.int64)


def _captions(sweep: Sweep, left: int, top: int, layout: Layout) -> list[Words]:
    joint, letter = sweep.joint, layout.letter
    kind = joint.type if sweep.bounded else f"{joint.type}, {_unbounded(joint)}"
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


def _unbounded(joint: Joint) -> str:
    lower, upper = limits_of(joint)
    if not (math.isfinite(lower) and math.isfinite(upper)):
        return "no limits"
    return f"limits {math.degrees(lower):.4g}° to {math.degrees(upper):.4g}°"


def position_text(joint: Joint, value: float) -> str:
    """A position with its unit: degrees and radians, or metres."""
    if joint.type == "prismatic":
        return f"{value:.4g} m"
    return f"{math.degrees(value):.4g}° ({value:.4g} rad)"
