"""Folders: what is found in them, and what is said where nothing is."""

import pytest

from urdftool.lint.discover import find_descriptions

ROBOT = '<robot name="r"><link name="l"/></robot>'
PART = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="l"/></robot>'


def test_folders_are_searched_for_two_endings(write, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("a.urdf", "b.urdf.xacro", "c.xacro", ".hidden/d.urdf", "in/e.urdf"):
        write(name, ROBOT)
    assert find_descriptions(["."]) == ["a.urdf", "b.urdf.xacro", "in/e.urdf"]
    assert find_descriptions(["c.xacro", "a.urdf", "."])[:2] == ["c.xacro", "a.urdf"]


@pytest.mark.parametrize("command", ["lint", "collision --check", "simulate --fleet"])
def test_a_robot_that_is_xacro_alone_is_to_be_named(
    write, urdftool, tmp_path, monkeypatch, command
):
    monkeypatch.chdir(tmp_path)
    write("urdf/base.xacro", PART)
    done = urdftool(*command.split(), "urdf")
    assert done.code == 2
    assert "no .urdf or .urdf.xacro below urdf\n" in done.err
    write("urdf/robot.xacro", ROBOT)
    done = urdftool(*command.split(), "urdf")
    if command == "lint":
        assert "checked 1 robot (1 variant)" in done.err
        return
    assert done.code == 2
    assert "give urdf/robot.xacro itself if it is a robot" in done.err
