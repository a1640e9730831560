"""How deep meshes are in each other: cubes in closed form, and what is found out sooner."""

from __future__ import annotations

import math
import shutil

import numpy as np
import pytest

from tests.conftest import FIXTURES
from urdftool.model.elements import Box, Collision, Sphere
from urdftool.model.load import load
from urdftool.model.pose import Pose
from urdftool.simulation.overlap import (
    Surface,
    _compute_nearest_squared,
    _measure_inside,
    _sort_distinct,
    measure_penetration_depth,
    tessellate_primitive_triangles,
)
from urdftool.simulation.prepare import prepare
from urdftool.simulation.settings import Settings
from urdftool.simulation.state import StateSnapshot

TWO = """\
<robot name="two">
  <link name="a">{inertial}<collision><geometry>{mesh}</geometry></collision></link>
  <joint name="j" type="revolute">
    <parent link="a"/><child link="b"/><origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <link name="b">{inertial}<collision><geometry>{mesh}</geometry></collision></link>
</robot>
"""
INERTIAL = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
)


@pytest.fixture
def depth(tmp_path):
    """How deep two cubes of 1 m are in each other, of which one is moved and turned."""
    shutil.copy(FIXTURES / "meshes" / "cube.stl", tmp_path)
    mesh = '<mesh filename="cube.stl"/>'

    def found(xyz, rpy="0 0 0", least=0.0):
        path = tmp_path / "two.urdf"
        path.write_text(TWO.format(inertial=INERTIAL, mesh=mesh, xyz=xyz, rpy=rpy))
        robot = load(path)
        bodies = prepare(robot, Settings())
        poses = np.array([[0, 0, 0, 0, 0, 0, 1], [*map(float, xyz.split()), *turned(rpy)]])
        return measure_penetration_depth(robot, StateSnapshot(bodies, poses), "a", "b", least)

    return found


def turned(rpy):
    yaw = float(rpy.split()[2])
    return 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)


@pytest.mark.parametrize("into", [0.05, 0.2])
def test_a_cube_in_a_cube(depth, into):
    """The deepest corner of one is as far from the faces of the other as it is in it."""
    assert depth(f"{1 - into} {1 - into} {1 - into}") == pytest.approx(into, rel=0.1)


def test_cubes_apart(depth):
    assert depth("1.01 0 0") == 0.0


@pytest.mark.parametrize("least", [0.01, 0.05, 0.12])
def test_what_is_deep_enough_is_found_as_deep(depth, least):
    place = "0.8 0.8 0.8", "0 0 0.3"
    assert depth(*place, least) == depth(*place) > least


@pytest.mark.parametrize("shift", [(0.5, 0.1, 0.2), (0.3, -0.4, 0.5)])
def test_it_is_the_deepest_of_all_points_that_are_inside(shift):
    """A fine ball in a box, whose inside needs no winding numbers."""
    ball = tessellate_primitive_triangles(Collision(None, None, None, Sphere(None, 0.5)))
    box = tessellate_primitive_triangles(Collision(None, None, None, Box(None, (1.0, 1.0, 1.0))))
    one, other = Surface(ball), Surface(box)
    points = one.points + shift
    points = points[(np.abs(points) < 0.5).all(axis=1)]
    wanted = math.sqrt(_compute_nearest_squared(points, other.points).max())
    assert _measure_inside(one, other, Pose(translation=shift), 0.0) == pytest.approx(wanted)


def test_what_is_not_deep_enough_is_nothing(depth):
    assert 0 < depth("0.95 0.95 0.95") < 0.1
    assert depth("0.95 0.95 0.95", least=0.1) == 0.0


def test_the_nearest_is_that_of_all_pairs():
    chance = np.random.default_rng(0)
    points, others = chance.random((200, 3)) + 5, chance.random((300, 3)) + 5
    wanted = ((points[:, None] - others) ** 2).sum(axis=2).min(axis=1)
    assert _compute_nearest_squared(points, others) == pytest.approx(wanted, abs=1e-12)


def test_distinct_points_are_those_of_numpy():
    points = np.random.default_rng(0).integers(0, 4, (200, 3)).astype(float)
    assert _sort_distinct(points).tolist() == np.unique(points, axis=0).tolist()
