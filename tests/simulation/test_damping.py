"""How much a joint moves bounds its damping: as the engine says, and where it does not say it."""

import numpy as np
import pytest

from tests.simulation.robots import inertial
from urdftool.api.simulate import run_trials as simulate
from urdftool.model.load import load
from urdftool.simulation.engines.pybullet.urdf import write_folder
from urdftool.simulation.engines.pybullet.world import PyBulletWorld, import_pybullet
from urdftool.simulation.prepare import prepare
from urdftool.simulation.settings import Settings

pytest.importorskip("pybullet")

CHAIN = """<robot name="r"><link name="world"/>
 <joint name="a" type="continuous"><parent link="world"/><child link="one"/><axis xyz="1 0 0"/>
 </joint><link name="one">{one}</link>
 <joint name="b" type="prismatic"><parent link="one"/><child link="two"/>
  <origin xyz="0 0 1.5" rpy="0.3 0.5 0.7"/><axis xyz="0 0.6 0.8"/><dynamics damping="1"/>
  <limit lower="-1" upper="1" effort="9" velocity="1"/></joint><link name="two">{two}</link>
 <joint name="c" type="revolute"><parent link="two"/><child link="three"/>
  <origin xyz="0.3 -0.4 0.2"/><axis xyz="0.6 0 0.8"/><dynamics damping="1"/>
  <limit lower="-1" upper="1" effort="9" velocity="1"/></joint><link name="three">{two}</link>
</robot>"""
TURNED = (
    '<inertial><origin xyz="0 -1.5 0.2" rpy="0.1 0.2 0.3"/><mass value="{mass}"/>'
    '<inertia ixx="2" ixy="0" ixz="0" iyy="3" iyz="0" izz="4"/></inertial>'
)


@pytest.fixture
def chain(write):
    def make(mass):
        text = CHAIN.format(one=inertial(1, 0.1, 0.1, 0.1), two=TURNED.format(mass=mass))
        return load(write("r.urdf", text))

    return make


def test_what_a_joint_moves_is_what_the_engine_says(chain, tmp_path):
    settings = Settings(pose={"a": 0.4, "b": 0.2, "c": -0.7})
    bodies = prepare(chain(5), settings)
    write_folder(bodies, tmp_path)
    p = import_pybullet()
    motors = PyBulletWorld(p, bodies, settings, tmp_path).motors
    try:
        assert motors._compute_added_inertias() == pytest.approx(motors._get_inertias(), rel=1e-6)
    finally:
        p.disconnect()


HEAVY = """<robot name="r"><link name="world"/>
 <joint name="a" type="continuous"><parent link="world"/><child link="one"/><axis xyz="1 0 0"/>
  <dynamics damping="1"/></joint>
 <link name="one"><inertial><mass value="100"/><origin rpy="1 3 4" xyz="0 -1.5 0"/>
  <inertia ixx="2" ixy="0" ixz="0" iyy="3" iyz="0" izz="4"/></inertial></link>
 <joint name="b" type="continuous"><parent link="one"/><child link="two"/><axis xyz="0 1 0"/>
  <origin rpy="-1.5707963 0 -1.5707963" xyz="0 -3 0"/></joint>
 <link name="two"><inertial><mass value="200"/><origin rpy="2 -3 -1.5707963" xyz="0.2 0.4 1"/>
  <inertia ixx="5" ixy="0" ixz="0" iyy="6" iyz="0" izz="7"/></inertial></link></robot>"""


def test_rounding_in_a_heavy_link_kills_no_engine(write):
    robot = load(write("r.urdf", HEAVY))
    (run,) = simulate(robot, Settings(duration=0.1))
    assert np.isfinite(run.recording.poses).all()
