"""A gripper of one package on an arm of another: all files, clean, standing, verified."""

import importlib.util

import pytest

from tests.conftest import ROOT

ARM = ROOT / "fixtures" / "edit" / "arm_description" / "urdf" / "arm.urdf"
HAND = ROOT / "fixtures" / "edit" / "hand_description" / "urdf" / "hand.urdf"
MOUNT = ("--to", "tool0", "--prefix", "g_", "--xyz", "0", "0", "0.01")
FILES = {
    *("robot.urdf", "robot.srdf", "robot.map", "robot.2.map"),
    *("arm_controllers.yaml", "hand_controllers.yaml"),
}


@pytest.fixture
def attached(urdftool, tmp_path):
    out = tmp_path / "out" / "robot.urdf"
    result = urdftool("edit", "attach", ARM, HAND, *MOUNT, "-o", out)
    assert result.code == 0, result.err
    return out


def test_all_files_are_written(attached):
    assert {path.name for path in attached.parent.iterdir()} == FILES
    controllers = attached.with_name("hand_controllers.yaml").read_text()
    assert "joints: [g_left, g_right]" in controllers
    semantics = attached.with_suffix(".srdf").read_text()
    assert '<joint name="g_left" value="0.02"/>' in semantics
    assert '<chain base_link="base" tip_link="tool0"/>' in semantics


def test_lint_finds_nothing(urdftool, attached):
    result = urdftool("lint", attached)
    assert result.code == 0, result.out
    said = result.out + result.err
    assert "no findings" in said
    assert "moveit" in said, "the SRDF next to it was not read"


@pytest.mark.parametrize(("source", "map_name"), [(ARM, "robot.map"), (HAND, "robot.2.map")])
def test_it_is_verified(urdftool, attached, source, map_name):
    result = urdftool("verify", source, attached, "--map", attached.with_name(map_name))
    assert result.code == 0, result.out


@pytest.mark.parametrize("engine", ["pybullet", "mujoco"])
def test_it_stands(urdftool, attached, engine):
    if importlib.util.find_spec(engine) is None:
        pytest.skip(f"{engine} is not installed")
    result = urdftool("simulate", attached, "--fixed-base", "--engine", engine)
    assert result.code == 0, result.out
    assert "arm: stands" in result.out
