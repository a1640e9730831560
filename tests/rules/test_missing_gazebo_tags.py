"""Who is told of missing Gazebo tags, and who is not."""

import re
from pathlib import Path

from urdftool.lint.run import check

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


def test_classic_wants_colours_and_friction():
    assert _found(CART, targets=["gazebo-classic"]) == [
        ("link", "chassis", "info"),
        ("link", "wheel", "warning"),
    ]


def test_new_gazebo_takes_the_colours_of_urdf():
    assert _found(CART, targets=["gz"]) == [("link", "wheel", "warning")]


def test_dependency_of_the_package_is_a_sign(tmp_path):
    (tmp_path / "package.xml").write_text(
        "<package><name>cart</name><exec_depend>ros_gz_sim</exec_depend></package>"
    )
    file = tmp_path / "urdf" / "cart.urdf"
    file.parent.mkdir()
    file.write_text(PLAIN)
    assert _found(file) == [("link", "wheel", "warning")]


def test_arm_that_rolls_on_nothing_needs_none():
    arm = FIXTURES / "zero-axis" / "good.urdf"
    assert _found(arm, targets=["gz"]) == []
