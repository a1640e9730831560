"""Which folders a package must install, beside those of meshes."""

import pytest

from urdftool import check

ROBOT = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  {include}<link name="base"/></robot>"""
CMAKE = """cmake_minimum_required(VERSION 3.8)
project(arm)
install(DIRECTORY {folders} DESTINATION share/${{PROJECT_NAME}})
ament_package()
"""
INCLUDE = '<xacro:include filename="$(find arm)/urdf/part.xacro"/>'


@pytest.mark.parametrize(
    ("include", "srdf", "folders", "count"),
    [
        (INCLUDE, False, "meshes", 1),
        (INCLUDE, False, "meshes urdf", 0),
        (f"<!-- {INCLUDE} -->", False, "meshes", 0),
        ("", False, "meshes", 0),
        ("", True, "meshes", 1),
        ("", True, "urdf", 0),
    ],
)
def test_a_folder_that_the_description_names_is_installed(
    write, monkeypatch, tmp_path, include, srdf, folders, count
):
    monkeypatch.chdir(tmp_path)
    write("package.xml", "<package format='3'><name>arm</name></package>")
    write("CMakeLists.txt", CMAKE.format(folders=folders))
    write("urdf/part.xacro", '<robot name="part"/>')
    write("urdf/arm.urdf.xacro", ROBOT.format(include=include))
    if srdf:
        write("urdf/arm.srdf", '<robot name="arm"/>')
    rule = "directory-not-installed"
    found = check("urdf/arm.urdf.xacro", select=(rule,), targets=("ros2",))
    assert [finding.data["folder"] for finding in found] == ["urdf"] * count
