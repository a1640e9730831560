"""What is found out while an engine is waited for, and that it is what would be found later."""

from __future__ import annotations

import shutil
import threading
from unittest import mock

import pytest

from tests.conftest import FIXTURES
from urdftool.api.simulate import run_trials as simulate
from urdftool.model.load import load
from urdftool.simulation import mesh_cache
from urdftool.simulation.checks import interpenetration
from urdftool.simulation.checks.interpenetration import precompute_overlaps
from urdftool.simulation.run import prefetch
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge

pytest.importorskip("pybullet")

INSIDE = """\
<robot name="inside">
  <link name="base">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <visual><geometry><mesh filename="package://meshes/cube.stl"/></geometry></visual>
    <collision><geometry><mesh filename="package://meshes/cube.stl"/></geometry></collision>
  </link>
  <joint name="neck" type="fixed">
    <parent link="base"/><child link="post"/><origin xyz="0 0 1"/>
  </joint>
  <link name="post">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><geometry><box size="0.1 0.1 1"/></geometry></collision>
  </link>
  <joint name="turn" type="revolute">
    <parent link="post"/><child link="arm"/><origin xyz="0 0 0.5"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="10" velocity="1"/>
  </joint>
  <link name="arm">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <visual><origin xyz="0 0 0.5"/><geometry><box size="0.2 0.2 1"/></geometry></visual>
    <collision><origin xyz="0 0 -0.5"/><geometry><box size="0.2 0.2 1"/></geometry></collision>
  </link>
</robot>
"""


@pytest.fixture
def robot(tmp_path):
    path = tmp_path / "inside.urdf"
    shutil.copy(FIXTURES / "meshes" / "cube.stl", tmp_path)
    path.write_text(INSIDE.replace("package://meshes/", ""))
    return load(path)


def test_the_verdict_is_the_same_whether_one_looked_before(robot):
    settings = Settings(duration=0.3)
    (looked,) = simulate(robot, settings, precompute=precompute_overlaps)
    (plain,) = simulate(robot, settings)
    assert looked.known
    assert not plain.known
    with mock.patch.object(
        interpenetration, "explain_misplaced_collision", side_effect=AssertionError("looked again")
    ):
        found = judge(robot, looked).faults
    wanted = judge(robot, plain).faults
    assert [str(fault) for fault in found] == [str(fault) for fault in wanted]
    assert any(fault.code == "interpenetration" and fault.is_warning for fault in found)


def test_what_is_seen_is_read(robot):
    with prefetch(robot, lambda _: None):
        pass
    with mock.patch.object(mesh_cache, "read_convex_points", side_effect=AssertionError):
        assert len(mesh_cache.get_outermost_points(robot, robot.links[0].visuals[0].geometry)) == 8


def test_what_fails_is_left_to_who_asks(robot):
    def fail(_):
        raise ValueError

    with prefetch(robot, fail) as tell:
        tell(1)


def test_a_system_without_threads_does_it_later(robot):
    no_more = mock.patch.object(threading.Thread, "start", side_effect=RuntimeError)
    with no_more, prefetch(robot, print) as tell:
        tell(1)


def test_nothing_waits_where_the_engine_dies(robot):
    before = threading.active_count()
    with pytest.raises(RuntimeError), prefetch(robot, print):
        raise RuntimeError
    for thread in threading.enumerate():
        if thread.daemon and thread is not threading.current_thread():
            thread.join(5)
    assert threading.active_count() == before
