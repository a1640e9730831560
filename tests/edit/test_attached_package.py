"""A gripper of one package on an arm of another: all files, clean, standing, verified."""

import importlib.util
import shutil

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


def copy_packages(tmp_path, name):
    """Copy the packages, with the SRDF of the arm in ``config`` and a robot name in it."""
    for package in (ARM.parents[1], HAND.parents[1]):
        shutil.copytree(package, tmp_path / package.name)
    urdf = tmp_path / ARM.parents[1].name / "urdf"
    moved = urdf.parent / "config" / "moveit.srdf"
    moved.write_text((urdf / "arm.srdf").read_text().replace('name="arm"', f'name="{name}"', 1))
    (urdf / "arm.srdf").unlink()
    return urdf / "arm.urdf", tmp_path / HAND.parents[1].name / "urdf" / "hand.urdf"


def test_an_srdf_in_config_is_joined(urdftool, attached, tmp_path):
    out = tmp_path / "config" / "robot.urdf"
    result = urdftool("edit", "attach", *copy_packages(tmp_path, "arm"), *MOUNT, "-o", out)
    assert result.code == 0, result.err
    assert out.with_suffix(".srdf").read_text() == attached.with_suffix(".srdf").read_text()


def test_an_srdf_of_another_robot_is_named(urdftool, tmp_path):
    out = tmp_path / "other" / "robot.urdf"
    result = urdftool("edit", "attach", *copy_packages(tmp_path, "other"), *MOUNT, "-o", out)
    assert result.code == 0, result.err
    assert "no SRDF of robot 'arm' is next to it" in result.err
    assert "moveit.srdf has another robot name" in result.err
    assert '<group name="arm">' not in out.with_suffix(".srdf").read_text()
