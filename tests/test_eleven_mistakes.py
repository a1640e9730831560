"""A student's package with eleven mistakes is led to a robot that drives by what lint prints."""

import shutil
from pathlib import Path

import pytest

from tests.conftest import FIXTURES

PACKAGE = FIXTURES / "robots" / "student_bot"
FIX = ("--fix", "--unsafe-fixes", "--no-cache", "student_bot")
BY_HAND = [
    # rounds of: what lint prints, and what the reader then writes, before the fixes
    [("did you mean 'student_bot'?", "find studentbot", "find student_bot")],
    [
        ("'0.1.5', which is not a number", '"0 0.1.5 0"', '"0 0.15 0"'),
        ("link name 'caster' is used twice", '<link name="caster"/>', ""),
        ("remove one <mimic>", '<mimic joint="lidar_joint"/>', ""),
    ],
    [
        ("its inertia fits 3.3 kg", '"2500"', '"2.5"'),
        ("or extend those of 'lidar_joint'", '<limit lower="0"', '<limit lower="-0.5"'),
    ],
]
FIXED = [
    "is 'Chassis.stl' on disk",
    "has 90 in its rpy, apparently degrees",
    "lower limit 0.5 of joint 'mast_joint' is above its upper limit -0.5",
    "upper limit 90 of joint 'lidar_joint' looks like degrees",
    "has type 'ray', which new Gazebo does not support",
    "'libgazebo_ros_ray_sensor.so', which new Gazebo cannot load",
]


def lint(urdftool, *options):
    return urdftool("lint", "--format", "concise", "--no-cache", *options, "student_bot")


def follow(urdftool):
    """Do what is printed until nothing is left; give all that was printed."""
    path = Path("student_bot/urdf/student_bot.urdf.xacro")
    printed = []
    for edits in BY_HAND:
        out = lint(urdftool).out
        printed.append(out)
        text = path.read_text("utf-8")
        for words, old, new in edits:
            assert words in out
            assert old in text
            text = text.replace(old, new, 1)
        path.write_text(text, "utf-8")
        if edits is not BY_HAND[0]:  # after it, the robot is checked for the first time
            urdftool("lint", *FIX)
    return "".join(printed)


def test_a_package_with_eleven_mistakes_is_led_to_a_robot_that_drives(
    tmp_path, monkeypatch, urdftool
):
    mujoco = pytest.importorskip("mujoco")
    shutil.copytree(PACKAGE, tmp_path / "student_bot")
    monkeypatch.chdir(tmp_path)
    printed = follow(urdftool)
    assert [words for words in FIXED if words not in printed] == []
    left = lint(urdftool, "--fail-on", "warning")
    assert left.code == 0, left.out
    robot = "student_bot/urdf/student_bot.urdf.xacro"
    result = urdftool("export", "mjcf", robot, "-o", "model", "--scene")
    assert result.code == 0, result.err
    model = mujoco.MjModel.from_xml_path("model/scene.xml")
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    wheels = [n for n in range(model.nu) if "wheel" in model.actuator(n).name]
    assert len(wheels) == 2
    for step in range(2000):
        data.ctrl[wheels] = min(4, step / 250)
        mujoco.mj_step(model, data)
    assert data.qvel[0] == pytest.approx(0.2, rel=0.02)  # 4 rad/s with a radius of 0.05 m
    assert abs(data.qpos[1]) < 0.01
