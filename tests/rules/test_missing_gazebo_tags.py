"""Who is told of missing Gazebo tags, and who is not."""

import re
from pathlib import Path

import pytest

from urdftool.api.lint import check

FIXTURES = Path(__file__).parents[2] / "fixtures" / "rules"
CART = FIXTURES / "missing-gazebo-tags" / "bad.urdf"
PLAIN = re.sub(r"  <gazebo>.*?</gazebo>\n", "", CART.read_text(), flags=re.DOTALL)


def _found(path, **options):
    found = check(path, select=["missing-gazebo-tags"], **options)
    return [(f.kind, f.name, f.severity.label) for f in found]


def test_robot_without_a_simulator_gets_none(tmp_path):
    file = tmp_path / "cart.urdf"
    file.write_text(PLAIN)
    assert _found(file) == []


def test_robot_for_another_simulator_gets_none(tmp_path):
    file = tmp_path / "cart.urdf"
    file.write_text(PLAIN)
    assert _found(file, targets=["mujoco"]) == []


@pytest.mark.parametrize("target", ["gazebo-classic", "gz"])
def test_only_a_caster_needs_a_block(target):
    assert _found(CART, targets=[target]) == [("link", "caster", "warning")]


def test_dependency_of_the_package_is_a_sign(tmp_path):
    (tmp_path / "package.xml").write_text(
        "<package><name>cart</name><exec_depend>ros_gz_sim</exec_depend></package>"
    )
    file = tmp_path / "urdf" / "cart.urdf"
    file.parent.mkdir()
    file.write_text(PLAIN)
    assert _found(file) == [("link", "caster", "warning")]


def test_arm_that_rolls_on_nothing_needs_none():
    arm = FIXTURES / "zero-axis" / "good.urdf"
    assert _found(arm, targets=["gz"]) == []


LUMPED = """<robot name="arm">
  <link name="base"/>
  <link name="arm">
    <visual><geometry><box size="0.1 0.1 0.1"/></geometry>
      <material name="red"><color rgba="1 0 0 1"/></material></visual>
  </link>
  <link name="{name}">
    <visual><geometry><box size="{size} {size} {size}"/></geometry>
      <material name="blue"><color rgba="0 0 1 1"/></material></visual>
  </link>
  <joint name="swing" type="continuous"><parent link="base"/><child link="arm"/></joint>
  <joint name="mount" type="{kind}"><parent link="arm"/><child link="{name}"/></joint>
  <gazebo reference="arm"><material>Gazebo/Red</material></gazebo>
  {block}
</robot>
"""


@pytest.mark.parametrize(
    ("name", "size", "kind", "count"),
    [
        ("camera", 0.1, "fixed", 1),
        ("camera", 0.01, "fixed", 0),
        ("arm_camera", 0.1, "fixed", 0),
        ("armcamera", 0.1, "fixed", 0),
        ("left_arm_camera", 0.1, "fixed", 1),
        ("arm_camera", 0.1, "continuous", 1),
    ],
)
@pytest.mark.parametrize("has_block", [False, True])
def test_a_link_that_shows_its_color_is_not_counted(tmp_path, has_block, name, size, kind, count):
    block = f'<gazebo reference="{name}"><selfCollide>true</selfCollide></gazebo>' * has_block
    file = tmp_path / "arm.urdf"
    file.write_text(LUMPED.format(name=name, size=size, kind=kind, block=block))
    found = check(file, select=["missing-gazebo-material"], targets=["gazebo-classic"])
    assert [finding.name for finding in found] == [name] * count
