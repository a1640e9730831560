"""Cases of a rule that are off by default: when they are reported; a comment for one has a use."""

import pytest

from urdftool.api.lint import check
from urdftool.rules import get_all_rules

ROBOT = """<robot name="cart">
  <link name="hand">{comment}
    <inertial>
      <mass value="1"/>
      <inertia ixx="1e-3" ixy="0" ixz="0" iyy="2e-3" iyz="0" izz="2e-3"/>
    </inertial>
    <visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>
    <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
  </link>
  <link name="{name}">{light}</link>
  <link name="other">{light}</link>
  <joint name="slide" type="prismatic">
    <parent link="hand"/><child link="{name}"/><origin xyz="0 0 1"/>
    <limit lower="0" upper="0.04" effort="20" velocity="0.2"/>
  </joint>
  <joint name="move" type="prismatic">
    <parent link="hand"/><child link="other"/><origin xyz="0 1 0"/>
    <limit lower="0" upper="0.04" effort="20" velocity="0.2"/>
  </joint>
</robot>
"""
LIGHT = """
    <inertial>
      <mass value="0.01"/>
      <inertia ixx="1e-5" ixy="0" ixz="0" iyy="2e-5" iyz="0" izz="2e-5"/>
    </inertial>
    <visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>
"""
RULE = "missing-collision"


def _check(tmp_path, name="finger", comment="", **options):
    file = tmp_path / "cart.urdf"
    file.write_text(ROBOT.format(light=LIGHT, name=name, comment=comment))
    return list(check(file, **options))


@pytest.mark.parametrize(
    ("options", "reported"),
    [
        ({}, False),
        ({"select": ["collision"]}, False),
        ({"select": [RULE]}, True),
        ({"select": ["pedantic"]}, True),
        ({"targets": ["pybullet"]}, True),
    ],
)
def test_a_pedantic_case_is_reported_if_its_rule_is_named(tmp_path, options, reported):
    found = [f.name for f in _check(tmp_path, **options) if f.code == RULE]
    assert found == (["finger", "other"] if reported else [])


def test_a_wheel_is_reported_by_default(tmp_path):
    assert [f.name for f in _check(tmp_path, "wheel_1") if f.code == RULE] == ["wheel_1"]


def test_a_comment_for_a_pedantic_case_has_a_use(tmp_path):
    comment = f"<!-- urdftool-ignore-file[{RULE}] closed by the hand -->"
    assert [
        f.code for f in _check(tmp_path, comment=comment) if f.code == "unused-suppression"
    ] == []


def test_pedantic_selects_rules_that_are_off_by_default(tmp_path):
    off = {rule.name for rule in get_all_rules() if not rule.default}
    assert not off & {f.code for f in _check(tmp_path)}
    assert off & {f.code for f in _check(tmp_path, select=["pedantic"])}


def test_the_last_line_counts_what_is_off_by_default(tmp_path, urdftool):
    file = tmp_path / "cart.urdf"
    file.write_text(ROBOT.format(light=LIGHT, name="finger", comment=""))
    told = "2 findings left out, infos and mild cases; --extend-select pedantic shows them"
    assert told in urdftool("lint", file, "--no-cache").err
