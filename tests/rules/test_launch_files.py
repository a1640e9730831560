"""Launch files of a package: which imports are dependencies, and files that cannot be read."""

import pytest

MANIFEST = """<package format="3"><name>arm</name><depend>rclpy</depend>
<export><build_type>ament_cmake</build_type></export></package>"""
ROBOT = '<robot name="r"><link name="l"/></robot>'
RULE = "undeclared-launch-dependency"


@pytest.fixture
def find(write, urdftool):
    """Write a launch file; gives the packages that are reported."""

    def found(text, name="launch/show.launch.py"):
        write("src/arm/package.xml", MANIFEST)
        write("src/arm/urdf/arm.urdf", ROBOT)
        write(f"src/arm/{name}", text)
        done = urdftool("lint", "src/arm/urdf/arm.urdf", "--select", RULE)
        assert done.code in (0, 1), done.err
        return [line.split("'")[1] for line in done.out.splitlines() if "imports" in line]

    return found


@pytest.mark.parametrize(
    ("text", "packages"),
    [
        ("import xacro", ["xacro"]),
        ("import os, xacro.cli as x; from nav2_common.launch import Y", ["xacro", "nav2_common"]),
        ("def f():\n  import xacro", ["xacro"]),
        ("import xacro\nimport xacro", ["xacro"]),
        ("# arm.urdf\nimport xacro", ["xacro"]),
        ("# other.urdf\nimport xacro", []),
        ("import os, yaml, numpy, rclpy, arm.tools, launch_ros", []),
        ("from . import xacro", []),
        ("try:\n  import xacro\nexcept (ImportError, OSError):\n  pass", []),
        ("try:\n  import xacro\nexcept:\n  pass", []),
        ("try:\n  import xacro\nexcept OSError:\n  pass", ["xacro"]),
        ("import xacro\nfor", []),
        (b"\xff\xfe\x00import xacro", []),
        ("import xacro\n" + "(" * 5000, []),
        ("import xacro\n" + "#" * (1 << 20), []),
    ],
)
def test_imports_that_are_packages_of_ros_are_dependencies(find, text, packages):
    assert find(text) == packages


def test_a_python_package_of_the_workspace_is_a_dependency(find, write):
    assert find("import tools") == []
    write("src/tools/package.xml", "<package><name>tools</name></package>")
    write("src/tools/tools/__init__.py", "")
    assert find("import tools") == ["tools"]


def test_a_launch_file_of_ros_1_is_not_read(find):
    assert find("import xacro", "launch/show.launch") == []
