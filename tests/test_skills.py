"""The recipes for coding agents: their commands are run, one after the other, in a new folder."""

import json
import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.conftest import FIXTURES, ROOT
from urdftool import cli, expand
from urdftool.report.schemas import find_schemas

SKILL = (ROOT / "skills/urdftool/SKILL.md").read_text("utf-8")
RECIPES = {
    title: block.splitlines()
    for title, block in re.findall(r"## Recipe: (.*?)\n.*?```sh\n(.*?)```", SKILL, re.DOTALL)
}
ARM = FIXTURES / "robots/demo_arm/urdf"
CAD = FIXTURES / "cad_arm"
WHO = ("-c", "user.name=nobody", "-c", "user.email=nobody@example.org", "-c", "tag.gpgsign=false")


def git(folder, *words):
    subprocess.run(["git", *WHO, *words], cwd=folder, check=True)


def put_wheels(folder):
    """A robot with mistakes of a beginner."""
    shutil.copy(FIXTURES / "robots/two_wheels/two_wheels.urdf", folder / "robot.urdf.xacro")


def put_meshes(folder):
    for path in (CAD / "meshes").iterdir():
        shutil.copy(path, folder)
    shutil.copy(CAD / "meshes/base.stl", folder / "part.stl")
    text = (CAD / "urdf/cad_arm.urdf").read_text()
    (folder / "robot.urdf").write_text(re.sub(r"package://cad_arm/meshes/", "", text))


def put_package(folder):
    shutil.copytree(CAD, folder / "robot")
    (folder / "robot/urdf/cad_arm.urdf").rename(folder / "robot/urdf/robot.urdf")


def put_arm(folder):
    (folder / "robot.urdf.xacro").write_text(expand(ARM / "arm_sound.urdf.xacro"))


def put_change(folder):
    put_arm(folder)
    git(folder, "init", "-qb", "main")
    git(folder, "add", ".")
    git(folder, "commit", "-qm", "robot")
    path = folder / "robot.urdf.xacro"
    path.write_text(path.read_text().replace('upper="2.4"', 'upper="2.0"'))


FOLDERS = {
    "a new robot": put_wheels,
    "inertia from meshes": put_meshes,
    "from CAD to MuJoCo": put_package,
    "MoveIt without ROS": put_arm,
    "review of a change": put_change,
}
NEEDS = {"from CAD to MuJoCo": "mujoco", "MoveIt without ROS": "fcl", "a new robot": "pybullet"}


def run(line, folder):
    words = line.split()
    assert words[0] == "urdftool"
    variables = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-m", *words], cwd=folder, env=variables, capture_output=True, text=True
    )
    assert done.returncode in (0, 1), f"{line}: {done.stderr}"
    assert "Traceback" not in done.stderr
    table = json.loads(done.stdout) if "--format json" in line else None
    return done.returncode, table


def test_there_is_a_folder_for_each_recipe():
    assert set(RECIPES) == set(FOLDERS)


@pytest.mark.slow
@pytest.mark.parametrize("title", FOLDERS)
def test_recipe(title, tmp_path):
    library = NEEDS.get(title, "numpy")
    if find_spec(library) is None:
        pytest.skip(f"it needs {library}")
    FOLDERS[title](tmp_path)
    results = [run(line, tmp_path) for line in RECIPES[title]]
    CHECKS[title](results, tmp_path)


def check_new_robot(results, folder):
    before, _, after = (table for _, table in results[:3])
    assert len(after["findings"]) < len(before["findings"])
    assert after["fixes"]["applied"]
    assert (folder / "robot.png").stat().st_size > 1000


def check_inertia(results, folder):
    mesh, before, _, after = (table for _, table in results)
    assert mesh["mass"] > 0
    assert len(before["links"]) == 3
    assert not [one for one in after["findings"] if one["rule"] == "missing-inertial"]


def check_mujoco(results, folder):
    assert list((folder / "mujoco").glob("*.xml"))
    assert results[-1][0] == 0, results[-1][1]


def check_moveit(results, folder):
    assert results[0][1]["pairs"]
    assert list((folder / "robot_moveit_config/config").glob("*.srdf"))


def check_change(results, folder):
    _, differences, *_ = (table for _, table in results)
    assert [code for code, _ in results][1:] == [1, 0, 0]
    assert "upper" in json.dumps(differences["changes"])


CHECKS = {
    "a new robot": check_new_robot,
    "inertia from meshes": check_inertia,
    "from CAD to MuJoCo": check_mujoco,
    "MoveIt without ROS": check_moveit,
    "review of a change": check_change,
}


def list_commands(text):
    """The command lines in the text, in blocks and in spans of code."""
    lines = [line for line in text.splitlines() if line.startswith("urdftool ")]
    return [*lines, *re.findall(r"`(urdftool [a-z][^`]*)`", text)]


@pytest.mark.parametrize("path", ["skills/urdftool/SKILL.md", "docs/agents.md"])
def test_commands_and_options_exist(path):
    lines = list_commands((ROOT / path).read_text("utf-8"))
    assert len(lines) > 5
    for line in lines:
        words = line.split()
        command = cli.main.get_command(None, words[1])
        assert command is not None or words[1] == "COMMAND", line
        if command is None:
            continue
        for word in words[2:]:
            if hasattr(command, "commands") or not word.startswith("-"):
                inner = command.get_command(None, word) if hasattr(command, "get_command") else None
                command = inner or command
                continue
            known = {name for one in command.params for name in (*one.opts, *one.secondary_opts)}
            assert word in known, line


def test_the_skill_has_the_header_that_agents_read():
    head = re.match(r"---\nname: ([a-z-]+)\ndescription: (.+)\n---\n", SKILL)
    assert head is not None
    assert head[1] == Path("skills/urdftool").name
    assert len(head[2]) < 1024
    assert find_schemas()
