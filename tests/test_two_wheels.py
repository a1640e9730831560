"""A beginner's robot with nine mistakes is led to one that drives by what the tool says alone."""

import shutil
from pathlib import Path

import pytest

from tests.conftest import FIXTURES

ROBOT = FIXTURES / "robots" / "two_wheels" / "two_wheels.urdf"
MISTAKES = {
    "shape-in-millimeters",
    "undefined-material",
    "placeholder-inertia",
    "odd-link-without-collision",
    "missing-limit",
    "unknown-parent-link",
    "collision-off-visual",
}
"""What is found at once; an axis and a missing drive show when these are fixed."""


@pytest.fixture
def robot(tmp_path, monkeypatch):
    """The robot as written, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    return Path(shutil.copy(ROBOT, tmp_path))


def rules(result):
    return {line.rpartition("[")[2].rstrip("]") for line in result.out.splitlines()}


def follow(robot, urdftool):
    """Apply the fixes, and by hand what the two findings that are left ask for."""
    urdftool("lint", "--target", "gz", "--fix", "--unsafe-fixes", robot.name)
    text = robot.read_text()
    text = text.replace('<origin xyz="0 0 0.03"/>\n', "", 1)
    material = '<material name="blue"><color rgba="0 0 1 1"/></material>'
    robot.write_text(text.replace('<material name="blue"/>', material, 1))


def test_lint_finds_what_can_be_seen_at_first(robot, urdftool):
    result = urdftool("lint", "--format", "concise", robot.name)
    assert rules(result) == MISTAKES
    assert "implausible-density" not in result.out


def test_fixes_leave_what_only_the_author_knows(robot, urdftool):
    urdftool("lint", "--target", "gz", "--fix", "--unsafe-fixes", robot.name)
    left = urdftool("lint", "--target", "gz", "--format", "concise", robot.name)
    assert rules(left) == {"undefined-material", "collision-off-visual"}


def test_nothing_is_left(robot, urdftool):
    follow(robot, urdftool)
    left = urdftool("lint", "--target", "gz", "--format", "concise", robot.name)
    assert left.out == ""
    text = robot.read_text()
    assert '<box size="0.3 0.2 0.08"/>' in text
    assert text.count('<axis xyz="0 1 0"/>') == 2
    assert "<wheel_separation>0.24</wheel_separation>" in text
    assert "<wheel_radius>0.05</wheel_radius>" in text


@pytest.mark.parametrize("engine", ["pybullet", "mujoco"])
def test_it_stands(robot, urdftool, engine):
    pytest.importorskip(engine)
    follow(robot, urdftool)
    result = urdftool("simulate", "--engine", engine, robot.name)
    assert result.out.startswith("two_wheels: stands\n"), result.err


def test_it_drives(robot, urdftool):
    """Both wheels at 4 rad/s and 0.05 m take it ahead with 0.2 m/s, as its plugin would."""
    mujoco = pytest.importorskip("mujoco")
    follow(robot, urdftool)
    result = urdftool("export", "mjcf", robot.name, "-o", "model", "--scene", "--verify")
    assert result.code == 0, result.out
    assert "free base" in result.err
    model = mujoco.MjModel.from_xml_path("model/scene.xml")
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for step in range(2000):
        data.ctrl[:] = min(4, step / 250)
        mujoco.mj_step(model, data)
    assert data.qvel[0] == pytest.approx(0.2, rel=0.02)
    assert abs(data.qpos[1]) < 0.01
    assert abs(data.qpos[2] - 0.03) < 0.001
