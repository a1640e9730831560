"""Every command that writes a file, on a small robot with a mesh and a texture."""

from __future__ import annotations

import shutil
import subprocess
import sys

from tests.conftest import FIXTURES, ROOT

ROBOT = """<?xml version="1.0"?>
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <material name="m"><texture filename="quadrants.png"/></material>
  <link name="base">
    <inertial><mass value="1"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
    <visual><geometry><mesh filename="cube.obj"/></geometry><material name="m"/></visual>
    <collision><geometry><mesh filename="sphere.stl" scale="0.1 0.1 0.1"/></geometry></collision>
  </link>
  <link name="arm">
    <visual><geometry><mesh filename="two_cubes.stl"/></geometry></visual>
  </link>
  <joint name="j" type="revolute"><parent link="base"/><child link="arm"/>
    <origin xyz="0 0 1"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="9" velocity="1"/></joint>
</robot>
"""
FILES = ("cube.obj", "cube.mtl", "sphere.stl", "two_cubes.stl", "quadrants.png")

WRITERS = {
    "expand": ("expand r.xacro -o", "a.urdf"),
    "depfile": ("expand r.xacro -o other.urdf --depfile", "a.d"),
    "source-map": ("expand r.xacro -o other.urdf --source-map", "a.json"),
    "findings": ("lint r.xacro --exit-zero --format html --output-file", "a.html"),
    "baseline": ("lint r.xacro --exit-zero --write-baseline", "a.json"),
    "shape": ("inertia box --mass 1 --size 1 1 1 -o", "a.xml"),
    "macros": ("inertia macros -o", "a.xacro"),
    "inertia-mesh": ("inertia mesh cube.obj --mass 1 -o", "a.xml"),
    "inertia-robot": ("inertia robot r.xacro --write --density 9 -o", "a.xacro"),
    "collision": ("collision r.xacro --method hull -j 1 --no-cache -o", "a.urdf"),
    "collision-picture": (
        "collision r.xacro --method hull -j 1 --no-cache -o other.urdf --picture",
        "a.png",
    ),
    "collision-mesh": ("collision mesh cube.obj --method hull --no-cache -o", "a.obj"),
    "mesh-picture": ("collision mesh cube.obj --method hull --no-cache --picture", "a.png"),
    "graph-gv": ("graph r.xacro -o", "a.gv"),
    "graph-svg": ("graph r.xacro -o", "a.svg"),
    "graph-png": ("graph r.xacro --style detailed -o", "a.png"),
    "graph-json": ("graph r.xacro -o", "a.json"),
    "graph-mmd": ("graph r.xacro -o", "a.mmd"),
    "info": ("info r.xacro -o", "a.txt"),
    "diff": ("diff r.xacro r.urdf -o", "a.txt"),
    "sdf": ("export sdf r.xacro --force -o", "a.sdf"),
    "mjcf": ("export mjcf r.xacro --force -o", "a.xml"),
    "sdf-folder": ("export sdf r.xacro --force -o", "model"),
    "mjcf-folder": ("export mjcf r.xacro --force --scene -o", "model"),
    "picture": ("view r.xacro --size 64x48 --picture", "a.png"),
    "contact-sheet": ("view r.xacro --size 64x48 --contact-sheet", "a.png"),
    "plot": ("simulate r.urdf --duration 0.1 --engine mujoco --plot", "a.png"),
    "simulated-picture": ("simulate r.urdf --duration 0.1 --engine mujoco --picture", "a.png"),
    "video": ("simulate r.urdf --duration 0.1 --engine mujoco --video", "a.gif"),
    "junit": ("simulate r.urdf --duration 0.1 --engine mujoco --junit", "a.xml"),
}
"""The command up to the name of its output, and such a name."""

SLOW = ("collision", "simulate", "view", "mjcf", "graph")


def is_slow(name):
    return any(word in WRITERS[name][0] for word in SLOW)


def robot(folder):
    """Put the robot into a folder, twice: as xacro and as URDF."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("r.xacro", "r.urdf"):
        (folder / name).write_text(ROBOT)
    for name in FILES:
        shutil.copyfile(FIXTURES / "meshes" / name, folder / name)


def words(name, target):
    return [*WRITERS[name][0].split(), str(target)]


def process(command, folder, home, **options):
    """The command line in a process of its own, which is started in a folder."""
    import os

    environment = {**os.environ, "PYTHONPATH": str(ROOT), "HOME": str(home)}
    environment["XDG_CACHE_HOME"] = str(home)
    line = [sys.executable, "-m", "urdftool", *command]
    return subprocess.Popen(line, cwd=folder, env=environment, **options)


def contents(folder):
    """What lies in a folder, by name."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            found[str(path.relative_to(folder))] = path.read_bytes()
    return found
