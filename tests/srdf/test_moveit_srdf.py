"""``urdftool srdf --moveit`` on a package that has an SRDF: what enters, and what stays."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

pytest.importorskip("fcl")

from .small_robots import ARM, FINGERS, prefix_lines, write_urdf

SRDF = Path("moveit_config/config/robot.srdf")
FOLDED = "j1: base > l1 revolute xyz=0,0,0.01\nj2: l1 > l2 revolute xyz=0,0,0.01"


@pytest.fixture
def make(write, urdftool):
    """Write a robot in a package, and make or complete its MoveIt package."""

    def maker(lines):
        write("description/package.xml", '<package format="3"><name>description</name></package>')
        path = write("description/robot.urdf", write_urdf(lines, bare=["tool0"]))
        return urdftool("srdf", path, "--moveit", "moveit_config")

    return maker


def edit(path: Path, *changes: tuple[str, str]) -> None:
    text = path.read_text("utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text, "utf-8")


def find_new_lines(before: str, after: str) -> list[str]:
    """Return the lines that were inserted; the others must be the same, in the same order."""
    rest = iter(before.splitlines())
    expected = next(rest, None)
    new = []
    for line in after.splitlines():
        if line == expected:
            expected = next(rest, None)
        else:
            new.append(line.strip())
    assert expected is None, f"changed: {expected}"
    return new


def test_groups_and_pairs_that_lack_enter(make) -> None:
    make(ARM)
    edit(SRDF, ("  <group ", "  <!-- by hand -->\n  <group "), ('="arm"', '="mine"'))
    edit(SRDF.parent / "kinematics.yaml", ("arm:", "mine:"))
    own = re.search('.*link1="l1" link2="l3".*\n', SRDF.read_text())[0]
    edit(SRDF, (own, '  <disable_collisions link1="l1" link2="l3" reason="User"/>\n'))
    before = SRDF.read_text()
    result = make(ARM + FINGERS)
    assert result.code == 0, result.err
    after = SRDF.read_text()
    new = find_new_lines(before, after)
    assert '<group name="gripper">' in new
    assert '<passive_joint name="right"/>' in new
    assert any(line.startswith('<end_effector name="gripper"') for line in new)
    assert not any('name="arm"' in line or 'group="arm"' in line for line in new)
    assert any('link1="palm" link2="left_tip" reason="Adjacent"' in line for line in new)
    assert "robot.srdf: added group 'gripper'" in result.err
    assert "robot.srdf: added: 'palm' and 'left_tip'" in result.err
    assert "gripper_controller" in (SRDF.parent / "moveit_controllers.yaml").read_text()
    assert make(ARM + FINGERS).code == 0
    assert SRDF.read_text() == after


def test_pair_of_a_link_that_vanished(make) -> None:
    make(ARM.replace("tool: l3", "j4: l3 > l4 revolute\ntool: l4"))
    result = make(ARM)
    assert "removed: 'l3' and 'l4', because a link of it does not exist" in result.err
    assert not re.search('link.="l4"', SRDF.read_text())


def test_pair_that_a_comment_keeps_gives_an_exit_code(make) -> None:
    make(FOLDED)
    line = '  <disable_collisions link1="base" link2="l2" reason="Never"/> <!-- mine -->\n'
    edit(SRDF, ("</robot>", line + "</robot>"))
    result = make(FOLDED)
    assert result.code == 1
    assert "kept: 'base' and 'l2', because a comment is on its line; it can touch" in result.err
    assert line in SRDF.read_text()


def test_no_group_enters_beside_expressions(make) -> None:
    make(ARM)
    name = SRDF.with_suffix(".srdf.xacro")
    SRDF.rename(name)
    head = '<robot xmlns:xacro="http://ros.org/wiki/xacro" name="robot">\n'
    edit(
        name,
        ('<robot name="robot">\n', head + '  <xacro:property name="t" value="tool0"/>\n'),
        ('tip_link="tool0"', 'tip_link="${t}"'),
    )
    result = make(ARM + FINGERS)
    assert result.code == 1
    assert "not added: group 'gripper', because the file has expressions" in result.err
    assert '<group name="gripper">' not in name.read_text()


def test_srdf_of_another_robot(make) -> None:
    make(ARM)
    before = SRDF.read_bytes()
    result = make(prefix_lines(ARM, "x_"))
    assert result.code == 2
    assert "the SRDF is of another robot" in result.err
    assert SRDF.read_bytes() == before
