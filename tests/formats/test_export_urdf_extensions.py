"""Actuators, sensors, excluded contacts and keyframes in an export to URDF."""

import json
import math
import re

import pytest

import urdftool as api
from urdftool.formats.registry import format_named
from urdftool.formats.urdf.checks import check_output
from urdftool.formats.urdf.options import Options
from urdftool.model.pose import Pose, make_pose, rotation_from_rpy

mujoco = pytest.mark.library("mujoco")

MJCF = """
<mujoco model="arm">
  <worldbody>
    <body name="base">
      <geom name="b" size="0.1"/>
      <body name="upper" pos="0 0 0.3">
        <joint name="pan" axis="0 0 1" range="-90 90"/>
        <geom name="u" size="0.1"/>
        <site name="seat" pos="0 0 0.1" euler="0 90 0"/>
        <body name="lower" pos="0 0 0.3">
          <joint name="tilt" axis="0 1 0"/>
          <geom name="l" size="0.1"/>
          <camera name="eye" pos="0 0 0.1" xyaxes="0 -1 0 0 0 1" fovy="60" resolution="640 480"/>
          <body name="hand" pos="0 0 0.2">
            <joint name="grip" type="slide" axis="1 0 0"/>
            <geom name="h" size="0.05"/>
            <site name="palm"/>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
  <contact><exclude body1="base" body2="lower"/></contact>
  <actuator>
    <position name="servo" joint="pan" kp="30" kv="2" gear="-2" ctrlrange="-1 3"/>
    <velocity name="wheel" joint="tilt" kv="4"/>
    <motor name="force" joint="grip" gear="3" ctrlrange="-2 2" forcerange="-1 1.5"/>
    <motor name="again" joint="grip"/>
    <general name="law" joint="pan" biastype="affine" biasprm="1 2 3"/>
  </actuator>
  <sensor>
    <gyro name="gyro" site="seat"/>
    <accelerometer name="acc" site="seat"/>
    <force name="pull" site="palm"/>
    <torque name="turn" site="palm"/>
    <jointactuatorfrc name="load" joint="tilt"/>
    <rangefinder name="beam" site="palm"/>
  </sensor>
  <keyframe><key name="home" qpos="0.5 -0.5 0.1"/></keyframe>
</mujoco>
"""


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    path = tmp_path_factory.mktemp("source") / "arm.xml"
    path.write_text(MJCF)
    return format_named("mjcf").read(path).robot


@pytest.fixture
def exported(urdftool, write, tmp_path):
    result = urdftool(
        *("export", "urdf", write("arm.xml", MJCF), "-o", tmp_path / "arm", "--verify"),
        *("--format", "json"),
    )
    assert result.code == 0, result.err
    return json.loads(result.out), api.load(tmp_path / "arm" / "arm.urdf")


@mujoco
def test_actuators_become_interfaces_of_ros2_control(exported):
    report, robot = exported
    (block,) = robot.ros2_controls
    assert (block.type, block.plugin) == ("system", "mock_components/GenericSystem")
    pan, tilt, grip = block.joints
    (position,) = pan.command_interfaces
    values = {name: float(value) for name, value in position.params.items()}
    assert (position.name, values) == ("position", {"min": -1.5, "max": 0.5, "kp": 120, "kv": 8})
    assert [(i.name, i.params) for i in tilt.command_interfaces] == [("velocity", {"kv": "4"})]
    (effort,) = grip.command_interfaces
    assert (effort.name, effort.params) == ("effort", {"min": "-3", "max": "4.5"})
    assert [i.name for i in tilt.state_interfaces] == ["position", "velocity", "effort"]
    lost = [f["message"] for f in report["findings"] if f["rule"] == "lossy-actuator"]
    assert [("'law'" in text, "'again'" in text) for text in lost] == [(True, False), (False, True)]
    verdicts = {check["check"]: check["verdict"] for check in report["checks"]}
    assert verdicts["actuators"] == "announced"


@mujoco
def test_sensors_become_sensors_of_gazebo(exported):
    report, robot = exported
    sensors = {s.name: (b.reference, s) for b in robot.gazebo for s in b.sensors}
    found = {name: (reference, s.type) for name, (reference, s) in sensors.items()}
    assert found == {
        "eye": ("lower", "camera"),
        "gyro_acc": ("upper", "imu"),
        "pull_turn": ("grip", "force_torque"),
    }
    camera = sensors["eye"][1].element.find_child("camera")
    across = 2 * math.atan(math.tan(math.radians(30)) * 640 / 480)
    assert float(camera.find_child("horizontal_fov").text) == pytest.approx(across)
    assert camera.find_child("optical_frame_id").text == "eye_optical_frame"
    # the camera of MJCF looks along −z: −x of the link here, to the right is −y, up is z
    x, y, z, *rpy = map(float, sensors["eye"][1].element.find_child("pose").text.split())
    looks = Pose(rotation_from_rpy(rpy), (x, y, z)).transform((1.0, 0.0, 0.0))
    assert looks == pytest.approx((1.0, 0.0, 0.1))
    optical = make_pose(robot.joint["eye_optical_frame_fixed"].origin)
    assert optical.transform((0.0, 0.0, 1.0)) == pytest.approx(looks)
    assert optical.transform((0.0, 1.0, 0.0)) == pytest.approx((0.0, 0.0, -0.9))
    lost = [f["message"] for f in report["findings"] if f["rule"] == "lossy-sensor"]
    assert lost == ["rangefinder sensor is dropped, since it has no counterpart in Gazebo: 'beam'"]


@mujoco
def test_excluded_contacts_and_keyframes_become_an_srdf(exported, tmp_path):
    root = exported[1].xml
    assert root.tag == "robot"
    from urdftool.source.description import read_description

    srdf = read_description(tmp_path / "arm" / "arm.srdf").document.root
    pairs = [(e.get("link1"), e.get("link2"), e.get("reason")) for e in srdf.children[-4:]]
    assert pairs == [
        ("base", "lower", "User"),
        ("base", "upper", "Adjacent"),
        ("upper", "lower", "Adjacent"),
        ("lower", "hand", "Adjacent"),
    ]
    state = srdf.find_child("group_state")
    joints = {joint.get("name"): float(joint.get("value")) for joint in state.children}
    assert (state.get("name"), joints) == ("home", {"pan": 0.5, "tilt": -0.5, "grip": 0.1})
    assert srdf.find_child("virtual_joint").get("type") == "fixed"


@mujoco
def test_what_is_not_written_is_announced(urdftool, write):
    path = write("arm.xml", MJCF)
    result = urdftool("export", "urdf", path, "--hardware", "none", "--frames", "none")
    assert result.code == 0, result.err
    assert "ros2_control" not in result.out
    for text in (
        "as requested: 'servo'",
        "excluded contacts are dropped",
        "requires <ros2_control>",
    ):
        assert text in result.err
    assert urdftool("export", "urdf", path, "-o", "x", "--strict").code == 2


@mujoco
@pytest.mark.parametrize(
    ("file", "old", "new", "row"),
    [
        ("arm.urdf", b'"kp">120', b'"kp">60', "actuators"),
        ("arm.urdf", b'"max">0.5', b'"max">0.6', "actuators"),
        ("arm.urdf", b'<command_interface name="velocity"', b'<x name="velocity"', "actuators"),
        ("arm.urdf", b'type="imu"', b'type="altimeter"', "sensors"),
        ("arm.urdf", b"<horizontal_fov>1.", b"<horizontal_fov>1.1", "sensors"),
        ("arm.urdf", b'<gazebo reference="grip">', b'<gazebo reference="tilt">', "sensors"),
        ("arm.srdf", b'link2="lower" reason="User"', b'link2="hand" reason="User"', "srdf"),
        ("arm.srdf", b'value="0.5"', b'value="0.4"', "srdf"),
    ],
)
def test_a_changed_extension_differs(source, file, old, new, row):
    robot = source
    written = format_named("urdf").write(robot, Options())
    assert old in written.files[file]
    written.files[file] = written.files[file].replace(old, new)
    if file == "arm.urdf" and row == "actuators":  # a changed interface of a closing tag
        written.files[file] = _close(written.files[file])
    checks = check_output(robot, Options(), written, None)
    assert [check.name for check in checks if check.verdict == "differs"] == [row]


def _close(text):
    start = text.find(b'<x name="velocity"')
    if start < 0:
        return text
    end = text.find(b"</command_interface>", start)
    return text[:end] + b"</x>" + text[end + len(b"</command_interface>") :]


SDF = """
<sdf version="1.7"><model name="m">
  <link name="a">
    <sensor name="lidar" type="gpu_lidar"><pose>0 0 1 0 0 0.5</pose><update_rate>10</update_rate>
      <topic>scan</topic></sensor>
    <sensor name="bump" type="contact"><contact><collision>c</collision></contact></sensor>
    <sensor name="eye" type="camera"><pose>1 0 0 0 0 0</pose><camera><pose>0 2 0 0 0 0</pose>
      <horizontal_fov>1</horizontal_fov><image><width>320</width><height>240</height></image>
      </camera></sensor>
  </link>
  <link name="b"/>
  <joint name="j" type="fixed"><parent>a</parent><child>b</child>
    <sensor name="load" type="force_torque"/></joint>
</model></sdf>
"""


def test_sensors_of_sdf_are_copied(urdftool, write, tmp_path):
    path = write("m.sdf", SDF)
    out = tmp_path / "m.urdf"
    result = urdftool("export", "urdf", path, "-o", out, "--verify", "--format", "json")
    assert result.code == 0, result.err
    report, robot = json.loads(result.out), api.load(out)
    blocks = {s.name: (b, s) for b in robot.gazebo for s in b.sensors}
    lidar = blocks["lidar"][1].element
    assert {e.tag: e.text for e in lidar.children} == {
        "pose": "0 0 1 0 0 0.5", "update_rate": "10", "topic": "scan"
    }  # fmt: skip
    assert blocks["eye"][1].element.find_child("pose").text == "1 2 0 0 0 0"
    assert blocks["eye"][1].element.find_child("camera").find_child("pose") is None
    block, load = blocks["load"]
    assert (block.reference, load.type) == ("j", "force_torque")
    assert block.get_value("preserveFixedJoint") == "true"
    assert {f["rule"] for f in report["findings"]} == {"lossy-sensor", "lossy-optical-frame"}
    assert not (tmp_path / "m.srdf").exists()


OTHER = (
    '<robot name="r" xmlns:drake="http://drake.mit.edu"><link name="a"/>'
    '<mujoco><compiler meshdir="m"/></mujoco><drake:collision_filter_group name="g"/></robot>'
)


@pytest.mark.parametrize(
    ("target", "tags"), [("urdf", ["mujoco"]), ("sdf", ["mujoco", "drake:collision_filter_group"])]
)
def test_elements_of_other_programs_are_copied_or_named(urdftool, write, tmp_path, target, tags):
    path = write("other.urdf", OTHER)
    result = urdftool("export", target, path, "-o", str(tmp_path / "out"), "--force")
    lines = [line for line in result.err.splitlines() if "[lossy-other-element]" in line]
    assert [line.partition("<")[2].partition(">")[0] for line in lines] == tags


def test_names_of_collisions_let_gazebo_apply_their_friction(tmp_path, urdftool):
    """Libsdformat applies a block to collisions whose name begins with that of the link."""
    path = tmp_path / "m.sdf"
    path.write_text(
        '<sdf version="1.9"><model name="m"><link name="a"><inertial><mass>1</mass></inertial>'
        '<collision name="hull"><geometry><box><size>1 1 1</size></box></geometry><surface>'
        "<friction><ode><mu>0.3</mu></ode></friction></surface></collision></link></model></sdf>",
        "utf-8",
    )
    out = tmp_path / "m.urdf"
    result = urdftool("export", "urdf", path, "-o", out, "--verify", "--strict", "-v")
    assert result.code == 0, result.err
    assert "collision 'hull' is named 'a_hull'" in result.err
    assert '<collision name="a_hull">' in out.read_text("utf-8")


def test_names_of_collisions_stay_apart(tmp_path, urdftool):
    path = tmp_path / "m.sdf"
    shape = (
        '<collision name="{}"><geometry><box><size>1 1 1</size></box></geometry><surface>'
        "<friction><ode><mu>0.3</mu></ode></friction></surface></collision>"
    )
    path.write_text(
        '<sdf version="1.9"><model name="m"><link name="a"><inertial><mass>1</mass></inertial>'
        f"{shape.format('hull')}{shape.format('a_hull')}</link></model></sdf>",
        "utf-8",
    )
    out = tmp_path / "m.urdf"
    assert urdftool("export", "urdf", path, "-o", out).code == 0
    names = re.findall(r'<collision name="(\w+)"', out.read_text("utf-8"))
    assert len(set(names)) == 2
    assert all(name.startswith("a_hull") for name in names)
