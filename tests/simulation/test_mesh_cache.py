"""Meshes of a robot are read once, and errors are met by who asks."""

from __future__ import annotations

import shutil
from unittest import mock

import numpy as np
import pytest

from tests.conftest import FIXTURES
from urdftool.errors import UrdftoolError
from urdftool.model.load import load
from urdftool.simulation import mesh_cache
from urdftool.simulation.prepare import prepare
from urdftool.simulation.settings import Settings

TWO = """\
<robot name="two">
  <link name="a">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <visual><geometry><mesh filename="cube.stl" scale="2 2 2"/></geometry></visual>
    <collision><geometry><mesh filename="cube.stl" scale="2 2 2"/></geometry></collision>
    <collision>
      <origin xyz="1 0 0"/>
      <geometry><mesh filename="cube.stl" scale="2 2 2"/></geometry>
    </collision>
  </link>
</robot>
"""


@pytest.fixture
def robot(tmp_path):
    shutil.copy(FIXTURES / "meshes" / "cube.stl", tmp_path)
    (tmp_path / "two.urdf").write_text(TWO)
    return load(tmp_path / "two.urdf")


def test_a_mesh_is_read_once_for_all_trials(robot):
    with mock.patch.object(mesh_cache, "load_named", wraps=mesh_cache.load_named) as read:
        one, other = (prepare(robot, Settings(height=height)) for height in (0.0, 1.0))
    assert read.call_count == 1
    assert [len(shape.pieces[0]) for body in one.bodies for shape in body.shapes] == [8, 8]
    assert one.size == other.size


def test_another_robot_is_read_anew(robot, tmp_path):
    geometry = robot.link["a"].visuals[0].geometry
    points = mesh_cache.get_outermost_points(robot, geometry)
    assert np.ptp(points, axis=0) == pytest.approx([2, 2, 2])
    (tmp_path / "two.urdf").write_text(TWO.replace('"2 2 2"', '"3 3 3"'))
    again = load(tmp_path / "two.urdf")
    points = mesh_cache.get_outermost_points(again, again.link["a"].visuals[0].geometry)
    assert np.ptp(points, axis=0) == pytest.approx([3, 3, 3])


def test_a_missing_mesh_is_said_to_who_needs_it(robot, tmp_path):
    (tmp_path / "cube.stl").unlink()
    geometry = robot.link["a"].visuals[0].geometry
    assert mesh_cache.get_outermost_points(robot, geometry) is None
    with pytest.raises(UrdftoolError, match=r"cube\.stl"):
        prepare(robot, Settings())
