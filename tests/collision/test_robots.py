"""Whole robots with new collisions: engines load them, and lint finds nothing new."""

from importlib.util import find_spec
from pathlib import Path

import pytest

from measure.benchmarks.collision_auto import make
from tests.conftest import FIXTURES

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_spec("pybullet") is None, reason="PyBullet has no wheel here"),
]

OURS = (
    "mira_description/urdf/mira_only_daes.urdf",
    "my_robot/urdf/mobile_manipulator.urdf.xacro",
    "ros2_arm/urdf/robot2_sound.urdf.xacro",
    "demo_arm/urdf/arm_sound.urdf.xacro",
)
THEIRS = ("a1/a1.urdf", "husky/husky.urdf", "kuka_iiwa/model.urdf")


def looked_at(path, folder):
    options = ["--max-error", "0.02", "--replace-primitives", "--no-cache"]
    made = make(path, [], folder, options)
    assert (made.bullet, made.mujoco, made.new) == ("loads", "loads", {})
    missed = [part for part in made.parts if not part["within"]]
    assert made.stderr.count("not within 2.00%") == len(missed)
    return made


@pytest.mark.parametrize("name", OURS)
def test_our_robots(name, tmp_path):
    made = looked_at(FIXTURES / "robots" / name, tmp_path)
    for part in made.parts:
        assert part["measures"]["error"] <= 0.02, part["mesh"]


@pytest.mark.parametrize("name", THEIRS)
def test_robots_of_pybullet(name, tmp_path):
    data = pytest.importorskip("pybullet_data")
    made = looked_at(Path(data.getDataPath()) / name, tmp_path)
    assert made.parts
