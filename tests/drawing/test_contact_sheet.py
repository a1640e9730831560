"""Every joint at both its limits."""

import math

import numpy as np
import pytest

from urdftool.drawing.camera import Camera
from urdftool.drawing.contact_sheet import (
    choose_layout,
    draw_contact_sheet,
    list_shown_links,
    list_sweeps,
    position_text,
)
from urdftool.drawing.shapes import read_robot_shapes
from urdftool.drawing.text import Words, draw_text, replace_undrawable

from .robots import BOX, joint, link, read, visual

SMALL = visual(BOX.format("0.2 0.2 0.2"), "0.2 0.4 0.9 1")


def mimic(name, multiplier=1.0):
    return f'<mimic joint="{name}" multiplier="{multiplier}"/>'


def chain(folder, *joints):
    links = [link(f"l{n}", SMALL) for n in range(len(joints) + 1)]
    made = [
        joint(name, f"l{n}", f"l{n + 1}", kind, rest, xyz="0 0.3 0")
        for n, (name, kind, rest) in enumerate(joints)
    ]
    return read(folder, *links, *made)


def orange(image):
    image = image.astype(int)
    return (image[..., 0] > image[..., 2] + 80) & (image[..., 0] > 120)


def test_each_joint_has_both_its_ends(tmp_path):
    robot = chain(
        tmp_path,
        ("turn", "revolute", ""),
        ("wheel", "continuous", ""),
        ("slide", "prismatic", '<limit lower="-0.1" upper="0.4" effort="1" velocity="1"/>'),
        ("free", "prismatic", ""),
        ("stiff", "fixed", ""),
        ("follows", "revolute", mimic("turn", -2)),
        ("drift", "floating", ""),
    )
    sweeps = {sweep.joint.name: sweep for sweep in list_sweeps(robot, slide=0.2)}
    assert {name: sweep.ends for name, sweep in sweeps.items()} == {
        "turn": (-1, 2),
        "wheel": (-math.pi / 2, math.pi / 2),
        "slide": (-0.1, 0.4),
        "free": (-0.2, 0.2),
    }
    assert sweeps["turn"].bounded
    assert not sweeps["wheel"].bounded
    assert sweeps["turn"].followers == ("follows",)


def test_a_sheet_has_two_cells_a_joint(tmp_path):
    robot = chain(tmp_path, *((f"j{n}", "revolute", "") for n in range(5)))
    image = draw_contact_sheet(robot, read_robot_shapes(robot), cell=(96, 80))
    layout = choose_layout(5, (96, 80))
    assert image.shape == (layout.height, layout.width, 3)
    cells = []
    for number in range(5):
        left, top = layout.place(number)
        for side in (0, 1):
            column = left + side * (96 + 6)
            cell = image[top + layout.caption :][:80, column : column + 96]
            assert cell.shape == (80, 96, 3)
            assert orange(cell).sum() > 10
            cells.append(cell.tobytes())
    assert len(set(cells)) == 10
    # and no further one
    blocks = layout.columns * layout.rows
    for number in range(5, blocks):
        left, top = layout.place(number)
        rest = image[top : top + 80, left : left + 96]
        assert np.ptp(rest.reshape(-1, 3), axis=0).max() == 0


def test_what_mimics_moves_along(tmp_path):
    """The follower is marked, and is where its own kinematics say, in both cells."""
    links = [link("a", SMALL), link("b"), link("c", SMALL)]
    leader = joint("lead", "a", "b", axis="1 0 0")
    follower = joint("follow", "b", "c", "revolute", mimic("lead", -1), "0 1 0", "1 0 0")
    robot = read(tmp_path, *links, leader, follower)
    (sweep,) = list_sweeps(robot)
    assert sweep.followers == ("follow",)
    camera = Camera(0.0, 0.0)  # from the front: y to the right, z up
    image = draw_contact_sheet(robot, read_robot_shapes(robot), camera=camera, cell=(300, 300))
    layout = choose_layout(1, (300, 300))
    left, top = layout.place(0)
    corners = []
    for side in (0, 1):
        column = left + side * 306
        cell = image[top + layout.caption :][:300, column : column + 300]
        rows, columns = np.nonzero(orange(cell))
        corners.append((columns.min(), columns.max(), rows.mean()))
    # lead at -1 and 2 carries the box down and up; the follower turns it back upright
    assert corners[0][2] > corners[1][2] + 30
    widths = [last - first + 1 for first, last, _ in corners]
    assert widths[0] == pytest.approx(widths[1], abs=2)  # a tilted box would be wider


def test_a_loop_of_mimics_has_no_row(tmp_path):
    robot = chain(
        tmp_path,
        ("p", "revolute", mimic("q")),
        ("q", "revolute", mimic("p")),
        ("r", "revolute", ""),
    )
    assert [sweep.joint.name for sweep in list_sweeps(robot)] == ["r"]


@pytest.mark.parametrize("count", [1, 2, 7, 50, 130])
def test_a_sheet_grows_both_ways(count):
    layout = choose_layout(count, (200, 160))
    assert layout.columns * layout.rows >= count > (layout.columns - 1) * layout.rows
    if count > 4:
        assert 0.8 < layout.width / layout.height < 2.2
    places = {layout.place(n) for n in range(count)}
    assert len(places) == count
    assert max(left for left, _ in places) + layout.block[0] <= layout.width
    assert max(top for _, top in places) + layout.block[1] <= layout.height + 16


def test_names_of_any_kind_are_written(tmp_path):
    names = ["é" * 300, "関節", "a\tb", "\u202e", "<b>%s{}", "🤖", "x" * 5000]
    page = np.full((300, 200, 3), 255, np.uint8)
    lines = [Words(name, (4, 4 + 30 * n), 150, 14) for n, name in enumerate(names)]
    image = draw_text(page, lines)
    assert image.shape == page.shape
    assert (image[:, :154] != 255).any()
    assert (image[:, 160:] == 255).all()  # none is longer than it may be
    assert replace_undrawable("Gelenk é\n") == "Gelenk e·"


def test_positions_have_their_unit(tmp_path):
    robot = chain(tmp_path, ("t", "revolute", ""), ("s", "prismatic", ""))
    turn, slide = robot.joints
    assert position_text(turn, math.pi / 2) == "90° (1.571 rad)"
    assert position_text(slide, -0.05) == "-0.05 m"


def test_limits_of_any_size_are_drawn(tmp_path):
    limits = '<limit lower="-1e12" upper="1e300" effort="1" velocity="1"/>'
    robot = chain(tmp_path, ("s", "prismatic", limits), ("j", "revolute", ""))
    assert draw_contact_sheet(robot, read_robot_shapes(robot), cell=(64, 48)).ndim == 3


def test_no_joint_and_no_shape(tmp_path):
    still = read(tmp_path, link("a", SMALL))
    assert draw_contact_sheet(still, read_robot_shapes(still)).ndim == 3
    empty = read(tmp_path, link("a"), link("b"), joint("j", "a", "b"))
    assert draw_contact_sheet(empty, read_robot_shapes(empty), cell=(64, 48)).ndim == 3


def _cells(image, count, cell):
    layout = choose_layout(count, cell)
    for number in range(count):
        left, top = layout.place(number)
        for side in (0, 1):
            column = left + side * (cell[0] + 6)
            yield image[top + layout.caption :][: cell[1], column : column + cell[0]]


def test_limits_a_full_turn_apart_show_the_joint_at_90_degrees(tmp_path):
    most = {"all_around": 6.2832, "half": 3.14159, "less": 3.0}
    joints = [
        joint(name, "a", name).replace('lower="-1" upper="2"', f'lower="-{end}" upper="{end}"')
        for name, end in most.items()
    ]
    robot = read(tmp_path, link("a", SMALL), *(link(name, SMALL) for name in most), *joints)
    ends = {sweep.joint.name: sweep.ends for sweep in list_sweeps(robot)}
    right = math.pi / 2
    assert ends == {"all_around": (-right, right), "half": (-right, right), "less": (-3.0, 3.0)}


def test_a_joint_that_moves_no_shape_has_no_row(tmp_path):
    links = [link("a", SMALL), link("b", SMALL), link("c")]
    joints = joint("one", "a", "b", "continuous", ""), joint("two", "b", "c", "continuous", "")
    robot = read(tmp_path, *links, *joints)
    shapes = read_robot_shapes(robot)
    sweeps = list_sweeps(robot, shown=list_shown_links(shapes))
    assert [sweep.joint.name for sweep in sweeps] == ["one"]
    layout = choose_layout(1, (96, 80))
    assert draw_contact_sheet(robot, shapes, cell=(96, 80)).shape[:2] == (
        layout.height,
        layout.width,
    )


def test_what_is_hidden_shines_through(tmp_path):
    """A wheel inside a box, which no side shows."""
    links = [
        link("base", visual(BOX.format("1 1 1"), "0.5 0.5 0.5 1")),
        link("wheel", visual(BOX.format("0.5 0.5 0.5"), "0.5 0.5 0.5 1")),
    ]
    robot = read(tmp_path, *links, joint("turn", "base", "wheel", "continuous", ""))
    image = draw_contact_sheet(robot, read_robot_shapes(robot), cell=(120, 100))
    for cell in _cells(image, 1, (120, 100)):
        red, blue = cell[..., 0].astype(int), cell[..., 2].astype(int)
        assert (red > blue + 40).sum() > 300


def test_the_side_is_taken_that_shows_what_moves(tmp_path):
    """A flap behind a wall, seen from behind."""
    links = [
        link("wall", visual(BOX.format("0.1 2 2"), "0.5 0.5 0.5 1")),
        link("flap", visual(BOX.format("0.05 0.6 0.6"), "0.5 0.5 0.5 1")),
    ]
    swing = joint("swing", "wall", "flap", "continuous", "", "-0.3 0 0", "1 0 0")
    robot = read(tmp_path, *links, swing)
    image = draw_contact_sheet(robot, read_robot_shapes(robot), cell=(120, 100))
    for cell in _cells(image, 1, (120, 100)):
        red, blue = cell[..., 0].astype(int), cell[..., 2].astype(int)
        assert (red > blue + 140).sum() > 300  # more than shines through a wall
