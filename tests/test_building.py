"""The Makefile and the CMakeLists.txt of docs/building.md, run as they stand there."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import ROOT, XACRO

PAGE = (ROOT / "docs" / "building.md").read_text("utf-8")


def block(language):
    (text,) = re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)
    return text


def run(*words):
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    return subprocess.run(
        words, capture_output=True, text=True, env={**os.environ, "PATH": path}, check=False
    )


@pytest.fixture
def package(xacro_file, write):
    """A package with a robot that includes a file and reads another."""
    xacro_file(
        "urdf/my_robot.urdf.xacro",
        '<xacro:include filename="part.xacro"/>'
        '<xacro:property name="c" value="${xacro.load_yaml(\'size.yaml\')}"/>'
        '<link name="base"/><xacro:part name="${c[\'name\']}"/>',
    )
    part = '<xacro:macro name="part" params="name"><link name="{}${{name}}"/></xacro:macro>'
    xacro_file("urdf/part.xacro", part.format(""))
    write("urdf/size.yaml", "name: arm\n")
    write("meshes/readme.txt", "")
    return lambda prefix: xacro_file("urdf/part.xacro", part.format(prefix))


def later(path):
    """Make a file younger than what was made of it, whatever the clock of the file system."""
    stamp = os.stat(path).st_mtime + 5
    os.utime(path, (stamp, stamp))


def test_make_expands_again_what_changed(package, write):
    write("Makefile", block("make"))
    made = Path("build/urdf/my_robot.urdf")
    done = run("make")
    assert done.returncode == 0, done.stderr
    assert 'name="arm"' in made.read_text()
    assert "Nothing to be done" in run("make").stdout

    package("left_")
    later("urdf/part.xacro")
    assert run("make").returncode == 0
    assert 'name="left_arm"' in made.read_text()

    write("urdf/size.yaml", "name: leg\n")
    later("urdf/size.yaml")
    later("urdf/size.yaml")
    assert run("make").returncode == 0
    assert 'name="left_leg"' in made.read_text()

    write("urdf/part.xacro", "<robot>")
    for _ in range(3):
        later("urdf/part.xacro")
    before = made.read_text()
    assert run("make").returncode == 2
    assert made.read_text() == before
    assert run("make", "lint").returncode == 2


AMENT = """macro(ament_package)
  install(FILES package.xml DESTINATION share/${PROJECT_NAME} OPTIONAL)
endmacro()
"""


@pytest.mark.program("cmake")
def test_cmake_expands_installs_and_tests(package, write):
    write("CMakeLists.txt", block("cmake"))
    write("stub/ament_cmakeConfig.cmake", AMENT)
    stub = f"-Dament_cmake_DIR={Path('stub').absolute()}"
    made = Path("build/urdf/my_robot.urdf")
    done = run("cmake", "-S", ".", "-B", "build", "-G", "Unix Makefiles", stub)
    assert done.returncode == 0, done.stderr
    done = run("cmake", "--build", "build")
    assert done.returncode == 0, done.stderr
    assert 'name="arm"' in made.read_text()
    before = made.stat().st_mtime_ns
    assert run("cmake", "--build", "build").returncode == 0
    assert made.stat().st_mtime_ns == before

    write("urdf/size.yaml", "name: leg\n")
    later("urdf/size.yaml")
    assert run("cmake", "--build", "build").returncode == 0
    assert 'name="leg"' in made.read_text()

    done = run("cmake", "--install", "build", "--prefix", "there")
    assert Path("there/share/my_robot_description/urdf/my_robot.urdf").exists(), done.stderr
    assert run("ctest", "--test-dir", "build").returncode == 8  # the links are not joined
    assert "<testsuites" in Path("build/urdftool_lint.xml").read_text()
    write("urdf/my_robot.urdf.xacro", XACRO.format('<link name="a"/>'))
    done = run("ctest", "--test-dir", "build")
    assert done.returncode == 0, done.stdout
