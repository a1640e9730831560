"""Sensors by the names of the target."""

import pytest

from urdftool.formats.sdf.sensor_types import SYSTEMS, TO_CLASSIC, TO_GZ

from .robots import CUBE, TWO, export, gazebo, inertial, joint, link, names, rules, tree

WELD = (link("a", inertial() + CUBE), joint("j", "a", "b", "fixed", origin="1 0 0"), link("b", ""))


def sensor(kind, inside="", name="s"):
    return f'<sensor name="{name}" type="{kind}">{inside}</sensor>'


def one(said, *parts, **choices):
    written = export(*(parts or (link("a"),)), gazebo("a", said), **choices)
    return written, next(tree(written).iter("sensor"))


@pytest.mark.parametrize(
    ("target", "kind", "other"),
    [("gz", k, v) for k, v in TO_GZ.items() if k != "multicamera"]
    + [("gazebo-classic", k, v) for k, v in TO_CLASSIC.items()],
)
def test_types(target, kind, other):
    written, made = one(sensor(kind), target=target)
    assert made.get("type") == (other.type or kind)
    assert "lossy-sensor" in rules(written)
    assert [x.severity.label for x in written.losses] == ["info" if other.type else "warning"]


def test_the_settings_of_a_laser_are_under_the_name_of_the_type():
    _, made = one(sensor("ray", "<ray><range><max>3</max></range></ray>"))
    assert made.findtext("lidar/range/max") == "3"
    _, made = one(
        sensor("gpu_lidar", "<lidar><range><max>3</max></range></lidar>"), target="gazebo-classic"
    )
    assert made.findtext("ray/range/max") == "3"


def test_a_multicamera_is_several_cameras():
    inside = '<camera name="left"/><camera name="right"/>'
    written = export(link("a"), gazebo("a", sensor("multicamera", inside)))
    assert names(tree(written).find("link"), "sensor") == ["s_left", "s_right"]


def test_the_pose_of_a_sensor_on_a_frame():
    said = gazebo("b", sensor("imu", "<pose>0 1 0 0 0 0</pose>"))
    pose = next(tree(export(*WELD, said)).iter("sensor")).find("pose")
    assert (pose.get("relative_to"), pose.text) == ("b", "0 1 0 0 0 0")
    pose = next(tree(export(*WELD, said, target="gazebo-classic")).iter("sensor")).find("pose")
    assert pose.text == "1 1 0 0 0 0"


def test_sensors_of_one_name_in_one_link():
    said = gazebo("a", sensor("imu") + sensor("camera"))
    written = export(link("a"), said)
    assert names(tree(written).find("link"), "sensor") == ["s", "s_2"]
    assert rules(written) == ["lossy-name"]


PLUGIN = '<plugin name="p" filename="lib{}.so">{}</plugin>'


@pytest.mark.parametrize(
    ("version", "path"), [("1.12", "frame_id"), ("1.11", "camera/optical_frame_id")]
)
def test_a_camera_plugin_becomes_the_sensor(version, path):
    inside = (
        "<cameraName>arm/cam</cameraName><imageTopicName>image</imageTopicName>"
        "<frameName>optical</frameName>"
    )
    plugin = PLUGIN.format("gazebo_ros_camera", inside + "<updateRate>15</updateRate>")
    written, made = one(sensor("camera", f"<camera/>{plugin}"), version=version)
    assert made.find("plugin") is None
    assert made.findtext("topic") == "arm/cam/image"
    assert made.findtext("update_rate") == "15"
    assert made.findtext(path) == "optical"
    assert rules(written) == ["lossy-plugin"]


def test_a_laser_plugin_of_ros_2():
    inside = (
        "<ros><namespace>/bot</namespace><remapping>~/out:=scan</remapping></ros>"
        "<frame_name>l</frame_name>"
    )
    said = sensor("ray", "<ray/>" + PLUGIN.format("gazebo_ros_ray_sensor", inside))
    written, made = one(said)
    assert made.findtext("topic") == "/bot/scan"
    assert "lossy-frame-id" in rules(written)
    _, made = one(said, version="1.12")
    assert made.findtext("frame_id") == "l"


def test_a_depth_camera_with_colours():
    _, made = one(sensor("depth", PLUGIN.format("gazebo_ros_openni_kinect", "")))
    assert made.get("type") == "rgbd_camera"


def test_noise_of_an_imu_is_of_each_axis():
    inside = (
        "<imu><noise><type>gaussian</type><rate><mean>0</mean><stddev>0.1</stddev></rate>"
        "</noise></imu>"
    )
    written, made = one(sensor("imu", inside))
    for axis in "xyz":
        noise = made.find(f"imu/angular_velocity/{axis}/noise")
        assert (noise.get("type"), noise.findtext("stddev")) == ("gaussian", "0.1")
    assert made.find("imu/noise") is None
    assert rules(written) == []


@pytest.mark.parametrize(
    "name", ["a_collision", "b_fixed_joint_lump__a_collision", "a::a_collision"]
)
def test_a_contact_sensor_names_a_collision_that_is_there(name):
    said = sensor("contact", f"<contact><collision>{name}</collision></contact>")
    written, made = one(said, link("a", inertial() + CUBE))
    assert made.findtext("contact/collision") == "a_collision"
    assert rules(written) == []


def test_a_contact_sensor_of_nothing_is_said():
    said = sensor("contact", "<contact><collision>nothing</collision></contact>")
    assert rules(one(said, link("a", inertial() + CUBE))[0]) == ["lossy-contact-sensor"]


@pytest.mark.parametrize("kind", SYSTEMS)
def test_a_world_has_the_systems_of_its_sensors(kind):
    on = "j" if kind == "force_torque" else "a"
    written = export(*TWO, gazebo(on, sensor(kind)), world=True)
    word = SYSTEMS[kind][0]
    assert f"gz-sim-{word}-system" in written.files["world.sdf"].decode()
    assert "plugin" not in written.files["model.sdf"].decode()
    old = export(*TWO, gazebo(on, sensor(kind)), world=True, version="1.9").files["world.sdf"]
    assert f"ignition-gazebo-{word}-system" in old.decode()


def test_a_world_of_classic_includes_ground_and_sun():
    world = export(link("a"), world=True, target="gazebo-classic").files["world.sdf"].decode()
    assert "model://ground_plane" in world
    assert "model://sun" in world
