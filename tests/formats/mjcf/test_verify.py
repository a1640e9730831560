"""The proof: it holds for what was exported, and finds what was changed afterwards."""

import re

import pytest

from urdftool.compare.check import Check
from urdftool.formats.common.directory import write_directory
from urdftool.formats.mjcf import read
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.write import write as write_mjcf
from urdftool.model.load import load
from urdftool.report.exports import format_check_table

from .goldens import FOLDER, GOLDENS
from .robots import joint, link, robot

pytest.importorskip("mujoco")

from urdftool.formats.mjcf.verify import verify


def verified(name, folder, options, change=lambda text: text):
    robot = load(FOLDER / f"{name}.urdf")
    written = write_mjcf(robot, options)
    written.files[written.main] = change(written.files[written.main].decode()).encode()
    write_directory(folder / "m", written.files, main=written.main)
    again = write_mjcf(robot, options)
    return verify(robot, written, folder / "m" / written.main, again, options)


ADDED = {"actuators", "contact pairs", "configurations", "limits"}
"""Rows of what an export adds to a URDF."""


def is_of_stops(check):
    """Whether a row says nothing but that stops follow from the gains of added servos."""
    return check.verdict == "announced" and all(
        text.startswith("stiffness of stops added") for text in check.announced
    )


@pytest.mark.parametrize("name", GOLDENS)
@pytest.mark.parametrize("base", ["auto", "free"])
def test_small_robots_are_equal(name, base, tmp_path):
    options = Options(srdf=GOLDENS[name].srdf, base=base, actuators="position")
    checks = [one for one in verified(name, tmp_path, options) if not is_of_stops(one)]
    lossy = ("platform", "rover")  # friction by direction
    expected = {"equal", "announced"} if name in lossy else {"equal"}
    # gains are for the step of the model, 2 ms; at 5 ms, the rover on two wheels rolls by 26 mm
    steps = [check for check in checks if check.name == "runs"]
    assert {check.verdict for check in steps} <= {"equal", "announced"}
    others = [check for check in checks if check not in steps and check.name not in ADDED]
    verdicts = {check.verdict for check in others} - {"not compared", "none"}
    assert verdicts <= expected, format_check_table(checks)
    added = {check.name: check.announced for check in checks if check.name in ADDED}
    assert added["actuators"][0].startswith("added: ")
    assert added["configurations"] == ["added: 1 ('home')"]


def test_a_model_that_was_compiled_is_read_without_a_limit_of_memory(tmp_path, monkeypatch):
    limits = []
    call = read.call_with_limits

    def observe(*words, **named):
        limits.append(named["limits"])
        return call(*words, **named)

    monkeypatch.setattr(read, "call_with_limits", observe)
    verified(min(GOLDENS), tmp_path, Options())
    assert limits
    assert {one.memory for one in limits} == {None}


@pytest.mark.parametrize(
    ("old", "new", "failing"),
    [
        (r'pos="0 0\.02 0\.1"', 'pos="0 0.021 0.1"', "frames"),
        (r'mass="0\.05"', 'mass="0.0501"', "mass matrix"),
        (r'mass="0\.6"', 'mass="0.6000001"', "centroid"),
        (r'range="0 0\.04"', 'range="0 0.041"', "limits"),
        (r'polycoef="0\.01 -1 ', 'polycoef="0.01 1 ', "tree"),
        (r'"right_slide" joint2="left_slide"', '"left_slide" joint2="right_slide"', "tree"),
        (r'damping="0\.5"', 'damping="0.4"', "joint physics"),
        (r'class="collision" size="0\.04', 'class="collision" size="0.041', "collisions"),
        (r'rgba="0\.7', 'rgba="0.6', "materials"),
        (r'<body name="grasp_point"[^>]*/>', "", "frames"),
        (r'data="0\.1"', 'data="0.2"', "limits"),
    ],
)
def test_a_change_is_found(old, new, failing, tmp_path):
    def change(text):
        changed, count = re.subn(old, new, text)
        assert count
        return changed

    checks = verified("gripper", tmp_path, Options(), change)
    assert failing in [check.name for check in checks if check.verdict == "differs"]


LOCKED = robot(
    link("a"), link("b"), link("c"), link("d"),
    joint("turned", "a", "b", inside='<origin xyz="1 0 0" rpy="0.3 0 1"/>'
          '<axis xyz="1 1 0"/><limit lower="0.7" upper="0.7" effort="3" velocity="2"/>'),
    joint("slid", "b", "c", "prismatic", '<axis xyz="0 0 1"/><limit lower="-1" upper="-1"/>'),
    joint("moves", "c", "d"),
)  # fmt: skip


@pytest.mark.parametrize("keep", [False, True])
def test_locked_joints_are_equal(write, urdftool, keep):
    write("r.urdf", LOCKED)
    done = urdftool(
        *("export", "mjcf", "r.urdf", "-o", "out", "--verify", "--actuators", "none"),
        *["--keep-locked-joints"] * keep,
    )
    assert done.code == 0, done.out
    announced = [
        line.split("  ")[0] for line in done.out.splitlines() if line.endswith("announced")
    ]
    assert {*announced} <= ADDED


@pytest.mark.parametrize(
    ("old", "new", "failing"),
    [
        (r'(<body name="b" pos=")1', r"\g<1>1.001", "frames"),
        (r'<site name="turned"', '<site name="other"', "frames"),
        (r'(?s)<joint name="moves".*?/>(.*)<keyframe>.*</keyframe>', r"\1", "tree"),
    ],
)
def test_a_change_of_a_welded_joint_is_found(write, tmp_path, old, new, failing):
    robot = load(write("r.urdf", LOCKED))
    written = write_mjcf(robot, Options(actuators="none"))
    text, count = re.subn(old, new, written.files[written.main].decode())
    assert count
    text = re.sub(r"(?s)<keyframe>.*</keyframe>", "", text)  # has a value for each joint
    written.files[written.main] = text.encode()
    write_directory(tmp_path / "m", written.files, main=written.main)
    again = write_mjcf(robot, Options(actuators="none"))
    checks = verify(robot, written, tmp_path / "m" / written.main, again, Options(actuators="none"))
    assert failing in [check.name for check in checks if check.verdict == "differs"]


def test_a_table():
    equal, off = Check("a", "this", 1e-9, 1e-12), Check("b", "that", 1e-9)
    off.compare(1.0, "link 'x'")
    off.compare(float("nan"), "link 'y'", known=True)
    assert off.verdict == "differs"
    table = format_check_table([equal, off])
    assert "b: differs: link 'x'" in table
    assert "b: announced: link 'y'" in table


def test_without_mujoco_it_says_what_to_install(monkeypatch, urdftool, tmp_path):
    monkeypatch.setitem(__import__("sys").modules, "mujoco", None)
    result = urdftool("export", "mjcf", FOLDER / "arm.urdf", "-o", tmp_path / "out", "--verify")
    assert result.code == 2
    assert "pip install 'urdftool[mujoco]'" in result.err
    assert not (tmp_path / "out").exists()


def test_a_temple_is_equal_as_far_as_single_precision_goes(urdftool, write):
    trimesh = pytest.importorskip("trimesh")
    temple = trimesh.creation.icosphere(3, 60.0)
    temple.apply_transform(trimesh.transformations.rotation_matrix(1.0, (1, 2, 3), (3, 1, 2)))
    write("temple.obj", trimesh.exchange.obj.export_obj(temple, digits=9))
    shapes = "".join(
        f'<{kind}><origin rpy="1.5 0.2 0.3"/><geometry><mesh filename="temple.obj"/></geometry>'
        f"</{kind}>"
        for kind in ("visual", "collision")
    )
    path = write("r.urdf", f'<robot name="r"><link name="a">{shapes}</link></robot>')
    done = urdftool("export", "mjcf", path, "-o", "out", "--verify")
    assert done.code == 0, done.out
