"""How severe a finding is, and what it says, by what readers do: asked where installed."""

import shutil
import subprocess

import pytest

from urdftool.api.lint import check
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

INERTIAL = """<inertial><mass value="1"/>
  <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>"""
TWO = """<?xml version="1.0"?>
<robot name="r">
  <link name="a">{first}</link>
  <link name="b">{second}</link>
  <joint name="{name}" type="{kind}">
    <parent link="a"/><child link="b"/><origin {origin}/>
  </joint>
  {more}
</robot>
"""


def _two(**parts):
    plain = {"first": INERTIAL, "second": INERTIAL, "name": "j", "kind": "fixed", "more": ""}
    return TWO.format(**{**plain, "origin": "", **parts})


def _found(tmp_path, text, rule, *targets):
    path = tmp_path / "r.urdf"
    path.write_text(text)
    settings = Settings(select=(rule,), targets=frozenset(targets))
    return check_file(path, Options(settings)).findings


def _levels(tmp_path, text, rule, *targets):
    return [finding.severity.label for finding in _found(tmp_path, text, rule, *targets)]


def test_a_spherical_joint_is_a_remark_for_those_who_load_it(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    text = _two(kind="spherical")
    assert mujoco.MjModel.from_xml_string(text).njnt == 1
    assert _levels(tmp_path, text, "unknown-joint-type", "mujoco") == ["info"]
    assert _levels(tmp_path, text, "unknown-joint-type", "mujoco", "ros2") == ["error"]
    assert _levels(tmp_path, text, "unknown-joint-type") == ["error"]
    ball = _two(kind="ball")
    with pytest.raises(ValueError, match="joint type"):
        mujoco.MjModel.from_xml_string(ball)
    assert _levels(tmp_path, ball, "unknown-joint-type", "mujoco") == ["error"]


def test_a_name_shared_with_a_joint_that_is_merged_is_a_warning(tmp_path):
    levels = {}
    for kind in ("fixed", "continuous"):
        text = _two(name="b", kind=kind)
        levels[kind] = _levels(tmp_path, text, "link-joint-name-clash", "gz")
        assert _levels(tmp_path, text, "link-joint-name-clash") == ["info"]
        if shutil.which("ign"):
            path = tmp_path / "clash.urdf"
            path.write_text(text)
            done = subprocess.run(["ign", "sdf", "-k", path], capture_output=True, check=False)
            assert (done.returncode == 0) == (kind == "fixed")
    assert levels == {"fixed": ["warning"], "continuous": ["error"]}


def test_an_srdf_of_another_name_is_used_and_so_a_warning(tmp_path):
    (tmp_path / "r.srdf").write_text('<robot name="other"/>')
    assert _levels(tmp_path, _two(), "srdf-robot-name", "moveit") == ["warning"]


@pytest.mark.parametrize(
    ("rpy", "angle"),
    [
        ("0 0 0", "120°, and looks 90° away from"),
        ("0 1.5708 0", "90° about"),
        ("-1.5708 0 0", "90° from"),
    ],
)
def test_an_optical_frame_is_turned_by_the_angle_that_is_said(tmp_path, rpy, angle):
    text = _two(origin=f'rpy="{rpy}"').replace('"a"', '"eye"').replace('"b"', '"eye_optical"')
    (finding,) = _found(tmp_path, text, "optical-frame-orientation")
    assert f"is rotated by {angle} the viewing direction" in finding.message


@pytest.mark.parametrize(
    ("roll", "angle", "level", "by_default"),
    [("-2.0044", 24.8, "info", 0), ("1.1372", 155.2, "warning", 1), ("-0.4", 67.1, "warning", 1)],
)
def test_a_camera_may_be_tilted_in_its_frame(tmp_path, roll, angle, level, by_default):
    text = _two(origin=f'rpy="{roll} 0 -1.5708"').replace('"a"', '"eye"')
    path, rule = tmp_path / "tilted.urdf", "optical-frame-orientation"
    path.write_text(text.replace('"b"', '"eye_optical"'))
    (finding,) = check(path, select=[rule])
    assert finding.severity.label == level
    assert finding.data["tilt"] == pytest.approx(angle, abs=0.1)
    assert len([one for one in check(path) if one.code == rule]) == by_default


@pytest.mark.parametrize("state", ["position", "velocity"])
def test_a_wheel_is_right_with_either_state(tmp_path, state):
    control = f"""<ros2_control name="c" type="system"><joint name="j">
      <command_interface name="velocity"/><state_interface name="{state}"/>
    </joint></ros2_control>"""
    wheel = _two(kind="continuous", more=control)
    assert _levels(tmp_path, wheel, "command-without-state", "ros2") == []
    arm = _two(kind="revolute", more=control)
    expected = [] if state == "velocity" else ["info"]
    assert _levels(tmp_path, arm, "command-without-state", "ros2") == expected


@pytest.mark.parametrize(
    ("joint", "other", "targets", "level"),
    [
        ("fixed", INERTIAL, (), "info"),
        ("fixed", INERTIAL, ("gz",), "info"),
        ("fixed", INERTIAL, ("pybullet",), "error"),
        ("continuous", INERTIAL, (), "warning"),
        ("continuous", INERTIAL, ("gz",), "error"),
        ("continuous", INERTIAL, ("mujoco",), "error"),
        ("fixed", "", (), "warning"),
        ("fixed", "", ("gz",), "error"),
    ],
)
def test_a_missing_inertial_matters_by_the_body_it_belongs_to(
    tmp_path, joint, other, targets, level
):
    shape = "<collision><geometry><box size='0.1 0.1 0.1'/></geometry></collision>"
    text = _two(first=other, second=shape, kind=joint)
    levels = _levels(tmp_path, text, "missing-inertial", *targets)
    assert levels == [level]
    upside_down = _two(first=shape, second=other, kind=joint)
    if joint == "fixed":
        assert _levels(tmp_path, upside_down, "missing-inertial", *targets) == [level]


def test_pybullet_gives_a_kilogram_also_to_a_link_that_is_fixed(tmp_path):
    """What ``missing-inertial`` says, and that a mass of 0 is kept."""
    bullet = pytest.importorskip("pybullet")
    shape = "<collision><geometry><box size='0.1 0.1 0.1'/></geometry></collision>"
    zero = "<inertial><mass value='0'/><inertia ixx='0' ixy='0' ixz='0' iyy='0' iyz='0' izz='0'/>"
    masses = {}
    client = bullet.connect(bullet.DIRECT)
    try:
        for name, second in (("none", shape), ("zero", f"{zero}</inertial>{shape}")):
            path = tmp_path / f"{name}.urdf"
            path.write_text(_two(second=second))
            body = bullet.loadURDF(str(path), physicsClientId=client)
            masses[name] = bullet.getDynamicsInfo(body, 0, physicsClientId=client)[0]
    finally:
        bullet.disconnect(client)
    assert masses == {"none": 1.0, "zero": 0.0}


def test_swapped_limits_are_none_to_mujoco_and_pybullet(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    limit = '<limit lower="1" upper="-1" effort="1" velocity="1"/>'
    text = _two(kind="revolute").replace("<origin ", f"{limit}<origin ")
    assert not mujoco.MjModel.from_xml_string(text).jnt_limited[0]
    (finding,) = _found(tmp_path, text, "lower-above-upper", "pybullet")
    assert finding.severity.label == "info"
    assert finding.data == {"lower": 1, "upper": -1}
    assert _levels(tmp_path, text, "lower-above-upper", "ros2") == ["error"]
    (finding,) = _found(tmp_path, text.replace('"1" upper', '"2.4" upper'), "lower-above-upper")
    assert (finding.data["lower"], finding.severity.label) == (2.4, "error")
