"""An actuator file sets in SDF what SDF has a place for, and the rest is reported."""

import pytest
from lxml import etree

ROBOT = """<robot name="r">
  <link name="a"><inertial><mass value="1"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <link name="b"><inertial><mass value="1"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <joint name="knee" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="9" velocity="2"/><dynamics friction="0.5"/></joint>
</robot>
"""
FILE = """[joints."kn*"]
kp = 50
damping = 0.25
force-range = [-3, 5]
"""


@pytest.fixture
def made(urdftool, write, tmp_path):
    path, config = write("r.urdf", ROBOT), write("motors.toml", FILE)
    words = ("export", "sdf", path, "-o", "r.sdf", "--verify", "--format", "json")
    result = urdftool(*words, "--actuator-config", config)
    assert result.code == 0, result.out
    return result, etree.parse(str(tmp_path / "r.sdf"))


def test_damping_friction_and_effort_are_written_and_verified(made):
    _, tree = made
    assert float(tree.findtext(".//axis/dynamics/damping")) == 0.25
    assert float(tree.findtext(".//axis/dynamics/friction")) == 0.5
    assert float(tree.findtext(".//axis/limit/effort")) == 5
    assert float(tree.findtext(".//axis/limit/velocity")) == 2


def test_what_sdf_has_no_place_for_is_reported(made):
    result, _ = made
    assert "kp of joint 'knee' cannot be expressed in SDF" in result.out
    assert "force range of joint 'knee' is -3 to 5; SDF gets 5 both ways" in result.out


def test_a_joint_that_is_not_there_is_an_error(urdftool, write):
    path = write("r.urdf", ROBOT)
    config = write("motors.toml", '[joints."elbow"]\ndamping = 1\n')
    result = urdftool("export", "sdf", path, "-o", "-", "--actuator-config", config)
    assert result.code == 2
    assert "elbow" in result.err
