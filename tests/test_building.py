"""The Makefile and the CMakeLists.txt of docs/building.md, run as they stand there.

There is no ROS: ``AMENT`` stands in for the two macros of ament that the CMake functions meet.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import junitparser
import pytest
import yaml

from tests.conftest import ROOT, XACRO

PAGE = (ROOT / "docs" / "building.md").read_text("utf-8")


def block(language):
    (text,) = re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)
    return text


FIRST = []
"""Folders that come first in PATH."""


def run(*words):
    path = os.pathsep.join([*FIRST, str(Path(sys.executable).parent), os.environ["PATH"]])
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
set(AMENT_TEST_RESULTS_DIR "${CMAKE_BINARY_DIR}/test_results")
set(AMENT_RUNNER "${CMAKE_CURRENT_LIST_DIR}/run_test.py")
function(ament_add_test name)
  set(words OUTPUT_FILE RESULT_FILE TIMEOUT WORKING_DIRECTORY)
  cmake_parse_arguments(ARG "" "${words}" "COMMAND" ${ARGN})
  if(ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "${ARG_UNPARSED_ARGUMENTS}")
  endif()
  add_test(NAME "${name}"
    COMMAND python3 "${AMENT_RUNNER}" "${ARG_RESULT_FILE}" "${ARG_OUTPUT_FILE}" ${ARG_COMMAND}
    WORKING_DIRECTORY "${ARG_WORKING_DIRECTORY}")
  set_tests_properties("${name}" PROPERTIES TIMEOUT ${ARG_TIMEOUT})
endfunction()
"""
RUNNER = """# as ament's run_test.py: the test must replace the result file; failures in it count
import pathlib, subprocess, sys, xml.etree.ElementTree as tree
result, output, *command = sys.argv[1:]
for path in (result, output):
    pathlib.Path(path).parent.mkdir(parents=True, exist_ok=True)
pathlib.Path(result).write_text('<testsuite errors="1" failures="0"/>')
done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
pathlib.Path(output).write_bytes(done.stdout)
sys.stdout.buffer.write(done.stdout)
root = tree.parse(result).getroot()
counted = int(root.get("errors", 0)) + int(root.get("failures", 0))
sys.exit(1 if counted else done.returncode)
"""
SOUND = '<link name="a"/>'


@pytest.fixture
def cmake(package, write, urdftool):
    """A package with a CMakeLists.txt; gives a function that configures its build folder."""
    write("stub/ament_cmakeConfig.cmake", AMENT)
    write("stub/run_test.py", RUNNER)
    write("CMakeLists.txt", block("cmake"))
    found = f"-Durdftool_DIR={urdftool('cmake-dir').out.strip()}"

    def configure(text=None, *words, generator="Unix Makefiles"):
        if text is not None:
            write(
                "CMakeLists.txt", f"cmake_minimum_required(VERSION 3.20)\nproject(p NONE)\n{text}"
            )
        stub = f"-Dament_cmake_DIR={Path('stub').absolute()}"
        return run("cmake", "-S", ".", "-B", "build", "-G", generator, *(words or (stub, found)))

    return configure


def build():
    done = run("cmake", "--build", "build")
    assert done.returncode == 0, done.stdout + done.stderr
    return done


@pytest.mark.program("cmake")
@pytest.mark.parametrize("generator", ["Unix Makefiles", "Ninja"])
def test_cmake_expands_again_what_changed_and_installs(cmake, write, generator):
    if generator == "Ninja" and not shutil.which("ninja"):
        pytest.skip("requires ninja")
    made = Path("build/urdf/my_robot.urdf")
    done = cmake(generator=generator)
    assert done.returncode == 0, done.stderr
    build()
    assert 'name="arm"' in made.read_text()
    before = made.stat().st_mtime_ns
    build()
    assert made.stat().st_mtime_ns == before

    write("urdf/size.yaml", "name: leg\n")
    later("urdf/size.yaml")
    build()
    assert 'name="leg"' in made.read_text()
    done = run("cmake", "--install", "build", "--prefix", "there")
    assert Path("there/share/my_robot_description/urdf/my_robot.urdf").exists(), done.stderr


@pytest.mark.program("cmake")
@pytest.mark.parametrize("ament", [True, False])
def test_the_test_of_cmake_prints_findings_and_writes_junit(cmake, write, ament):
    results = Path("build/urdftool_lint.xml")
    if ament:
        results = Path("build/test_results/my_robot_description/urdftool_lint.xunit.xml")
    text = block("cmake")
    without = "".join(line for line in text.splitlines(True) if "ament" not in line)
    write("CMakeLists.txt", text if ament else without)
    assert cmake().returncode == 0
    build()
    done = run("ctest", "--test-dir", "build", "--output-on-failure")
    assert done.returncode == 8  # the links are not joined
    assert "urdf/my_robot.urdf.xacro:2:" in done.stdout
    suites = junitparser.JUnitXml.fromfile(str(results))
    assert "urdf/my_robot.urdf.xacro" in [suite.name for suite in suites]
    assert suites.failures + suites.errors > 0

    write("urdf/my_robot.urdf.xacro", XACRO.format(SOUND))
    done = run("ctest", "--test-dir", "build")
    assert done.returncode == 0, done.stdout
    assert junitparser.JUnitXml.fromfile(str(results)).failures == 0


ONE = "find_package(urdftool REQUIRED)\nurdftool_expand({})"
WRONG = {
    ONE.format("a.xacro"): "a.xacro' does not exist",
    ONE.format("urdf"): "urdf' does not exist",
    ONE.format("urdf/part.xacro INTO a.urdf"): "urdftool_expand: unknown argument",
    ONE.format("urdf/part.xacro PACKAGES share"): "'share' of PACKAGES is not NAME=DIR",
    ONE.format("urdf/part.xacro OUTPUT"): "urdftool_expand: OUTPUT requires a value",
    "find_package(urdftool 99 REQUIRED)": "version: 0",
}


@pytest.mark.program("cmake")
def test_a_wrong_call_stops_cmake_with_a_message(cmake):
    for text, message in WRONG.items():
        done = cmake(text)
        assert done.returncode == 1
        assert message in " ".join(done.stderr.split())


@pytest.mark.program("cmake")
def test_variants_of_a_robot_are_several_outputs(cmake, write):
    text = '<xacro:arg name="p" default=""/><xacro:include filename="$(find other)/part.xacro"/>'
    write("a.xacro", XACRO.format(text + '<xacro:part name="$(arg p)base"/>'))
    shutil.copytree("urdf", "parts of others")
    call = 'urdftool_expand(a.xacro OUTPUT "{0}/a b.urdf" ARGUMENTS p:={0}_ PACKAGES {1})'
    call = call.replace("{1}", '"other=parts of others"')
    calls = [call.format(prefix) for prefix in ("l", "r")]
    assert cmake("\n".join(["find_package(urdftool 0.1 REQUIRED)", *calls])).returncode == 0
    build()
    for prefix in ("l", "r"):
        assert f'name="{prefix}_base"' in Path(f"build/{prefix}/a b.urdf").read_text()


@pytest.mark.program("cmake")
def test_an_expansion_that_fails_stops_the_build_and_leaves_no_file(cmake, write):
    write("urdf/part.xacro", "<robot>")
    assert cmake().returncode == 0
    done = run("cmake", "--build", "build")
    assert done.returncode != 0
    assert "part.xacro" in done.stdout + done.stderr
    assert not Path("build/urdf/my_robot.urdf").exists()


@pytest.mark.program("cmake")
def test_cmake_finds_the_functions_next_to_the_program_in_path(cmake, urdftool, monkeypatch):
    folder = Path(urdftool("cmake-dir").out.strip())
    shutil.copytree(folder, "prefix/share/urdftool/cmake")
    Path("prefix/bin").mkdir()
    program = Path("prefix/bin/urdftool")
    program.write_text(f"#!{sys.executable}\nfrom urdftool.cli import run\nrun()\n")
    program.chmod(0o755)
    monkeypatch.setattr(sys.modules[__name__], "FIRST", [str(program.parent.absolute())])
    done = cmake("find_package(urdftool REQUIRED)\nmessage(STATUS ${URDFTOOL_EXECUTABLE})", "-DA=1")
    assert done.returncode == 0, done.stderr
    assert str(program.absolute()) in done.stdout


def test_a_build_folder_inside_a_package_is_not_checked(write, urdftool):
    robot = '<robot name="r"><link name="l"/></robot>'
    write("arm/CMakeLists.txt", "")
    write("arm/CMakeCache.txt", "")  # built in its own folder
    for name in ("arm/a.urdf", "arm/build/a.urdf"):
        write(name, robot)
    write("arm/build/CMakeCache.txt", "")
    assert "checked 1 robot " in urdftool("lint", ".").err
    assert "checked 1 robot " in urdftool("lint", "arm/build").err


def test_lint_writes_junit_in_addition(write, urdftool):
    write("a.urdf", '<robot name="r"><link name="l"/><link name="m"/></robot>')
    done = urdftool("lint", "a.urdf", "--junit", "deep/a.xml")
    assert done.out == urdftool("lint", "a.urdf").out
    assert Path("deep/a.xml").read_text() == urdftool("lint", "a.urdf", "--format", "junit").out
    assert urdftool("lint", "a.urdf", "--junit", "a.urdf").code == 2


def test_rosdep_reads_the_name_of_the_package():
    rules = yaml.safe_load((ROOT / "packaging/rosdep.yaml").read_text("utf-8"))
    (name,) = rules
    assert f"<test_depend>{name}</test_depend>" in block("xml")
    assert all(rule == {"pip": {"packages": ["urdftool"]}} for rule in rules[name].values())
