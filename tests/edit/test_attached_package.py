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


FLAG = "<gazebo><self_collide>{}</self_collide></gazebo></robot>"


@pytest.mark.parametrize("of_arm", [True, False])
def test_a_setting_of_the_whole_robot_is_declared(urdftool, write, tmp_path, of_arm):
    texts = [path.read_text() for path in (ARM, HAND)]
    index = 0 if of_arm else 1
    texts[index] = texts[index].replace("</robot>", FLAG.format(1))
    paths = [write(f"{number}/robot.urdf", text) for number, text in enumerate(texts)]
    out = tmp_path / "out" / "robot.urdf"
    result = urdftool("edit", "attach", *paths, *MOUNT, "-o", out)
    assert result.code == 0, result.err
    line = texts[index].count("\n", 0, texts[index].index("self_collide")) + 1
    note = "warning: setting self_collide of this robot is now one of the other, too"
    assert f"{paths[index]}:{line}:" in result.err
    assert note in result.err
    maps = [out.with_suffix(".map"), out.with_suffix(".2.map")]
    assert "setting self_collide true\n" in maps[1 - index].read_text()
    for path, name in zip(paths, maps, strict=True):
        assert urdftool("verify", path, out, "--map", name).code == 0
    out.write_text(out.read_text().replace("<self_collide>1", "<self_collide>0"))
    assert urdftool("verify", paths[1 - index], out, "--map", maps[1 - index]).code == 1


def test_settings_that_differ_are_an_error(urdftool, write, tmp_path):
    pairs = zip("10", (ARM, HAND), strict=True)
    paths = [
        write(f"{flag}/robot.urdf", path.read_text().replace("</robot>", FLAG.format(flag)))
        for flag, path in pairs
    ]
    result = urdftool("edit", "attach", *paths, *MOUNT, "-o", tmp_path / "no.urdf")
    assert result.code == 2
    assert "setting self_collide of the whole robot has another value" in result.err
    assert not (tmp_path / "no.urdf").exists()


def test_a_mesh_of_another_package_is_named_by_it(urdftool, tmp_path):
    arm, hand = copy_packages(tmp_path, "arm")
    mesh = (
        '<collision><geometry><mesh filename="../meshes/palm.obj"/></geometry></collision></link>'
    )
    hand.write_text(hand.read_text().replace("</link>", mesh, 1))
    path = hand.parents[1] / "meshes" / "palm.obj"
    path.parent.mkdir()
    path.write_text(
        "v 0 0 0\nv 0.1 0 0\nv 0 0.2 0\nv 0 0 0.3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
    )
    for folder, expected in (
        (arm.parent, "package://hand_description/meshes/palm.obj"),
        (arm.parents[1], "package://hand_description/meshes/palm.obj"),
        (hand.parents[1] / "new", "../meshes/palm.obj"),
        (tmp_path / "a" / "b" / "out", "../../../hand_description/meshes/palm.obj"),
    ):
        out = folder / "robot.urdf"
        result = urdftool("edit", "attach", arm, hand, *MOUNT, "-o", out)
        assert result.code == 0, result.err
        assert f'filename="{expected}"' in out.read_text()
        assert expected.startswith("package:") or (folder / expected).exists()
