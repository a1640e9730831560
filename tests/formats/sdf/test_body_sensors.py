"""Plugins that sense a link or joint they name, without a sensor around them."""

import pytest

from .robots import TWO, WELDED, export, gazebo, inertial, joint, link, named, rules, tree

IMU = (
    '<plugin name="imu" filename="libgazebo_ros_imu.so"><robotNamespace>/bot</robotNamespace>'
    "<topicName>imu/data</topicName><bodyName>{}</bodyName><updateRate>50.0</updateRate>"
    "<gaussianNoise>0.01</gaussianNoise><xyzOffset>0.1 0 0</xyzOffset>"
    "<rpyOffset>0 0 1</rpyOffset><serviceName>imu/service</serviceName></plugin>"
)
AXES = [f"{kind}/{axis}" for kind in ("angular_velocity", "linear_acceleration") for axis in "xyz"]


@pytest.mark.parametrize(
    "block",
    [
        f"<gazebo>{IMU.format('b')}</gazebo>",
        gazebo("b", IMU.format("b")),
        gazebo("a", IMU.format("b")),
        gazebo("b", IMU.replace("<bodyName>{}</bodyName>", "")),
        gazebo("j", IMU.format("b")),
    ],
)
def test_an_imu_plugin_is_a_sensor_of_the_link_it_names(block):
    model = tree(export(*TWO, block))
    made = named(model, "link", "b").find("sensor")
    assert [made.get("name"), made.get("type")] == ["imu", "imu"]
    assert made.findtext("pose") == "0.1 0 0 0 0 1"
    assert made.findtext("update_rate") == "50.0"
    assert made.findtext("topic") == "/bot/imu/data"
    assert [made.findtext(f"imu/{axis}/noise/stddev") for axis in AXES] == ["0.01"] * 6
    assert model.find(".//plugin") is None


def test_a_world_has_the_system_for_it():
    written = export(*TWO, f"<gazebo>{IMU.format('b')}</gazebo>", world=True)
    assert b"gz-sim-imu-system" in written.files["world.sdf"]


def test_on_a_link_that_became_a_frame_it_is_where_it_was():
    model = tree(export(*WELDED, f"<gazebo>{IMU.format('b')}</gazebo>", fixed_joints="lump"))
    pose = named(model, "link", "a").find("sensor/pose")
    assert [pose.get("relative_to"), pose.text] == ["b", "0.1 0 0 0 0 1"]


@pytest.mark.parametrize("name", ["", "c"])
def test_one_that_names_no_link_stays_with_a_word(name):
    written = export(*TWO, f"<gazebo>{IMU.format(name)}</gazebo>")
    assert tree(written).find("plugin").get("filename") == "libgazebo_ros_imu.so"
    assert rules(written) == ["lossy-plugin"]
    assert "names no link or joint" in written.losses[0].message


def test_classic_keeps_the_plugin():
    model = tree(export(*TWO, f"<gazebo>{IMU.format('b')}</gazebo>", target="gazebo-classic"))
    assert model.find("plugin") is not None
    assert model.find("link/sensor") is None


def test_noise_and_offset_for_each_axis():
    said = (
        '<gazebo><plugin name="h" filename="libhector_gazebo_ros_imu.so"><bodyName>a</bodyName>'
        "<rateGaussianNoise>1 2 3</rateGaussianNoise><accelOffset>0.5</accelOffset>"
        "<accelDrift>0.2</accelDrift></plugin></gazebo>"
    )
    written = export(link("a"), said)
    imu = tree(written).find("link/sensor/imu")
    noises = [imu.findtext(f"angular_velocity/{axis}/noise/stddev") for axis in "xyz"]
    assert noises == ["1", "2", "3"]
    assert imu.findtext("linear_acceleration/y/noise/mean") == "0.5"
    assert imu.findtext("linear_acceleration/y/noise/stddev") == "0"
    assert any("it has no accelDrift" in loss.message for loss in written.losses)


@pytest.mark.parametrize(
    ("filename", "type_"),
    [("hector_gazebo_ros_gps", "navsat"), ("hector_gazebo_ros_magnetic", "magnetometer")],
)
def test_others_of_a_link(filename, type_):
    said = (
        f'<gazebo><plugin name="p" filename="lib{filename}.so"><bodyName>a</bodyName>'
        "<gaussianNoise>0.3</gaussianNoise></plugin></gazebo>"
    )
    written = export(link("a"), said)
    made = tree(written).find("link/sensor")
    assert made.get("type") == type_
    found = made.findtext("navsat/position_sensing/horizontal/noise/stddev")
    assert found == ("0.3" if type_ == "navsat" else None)
    assert (found is None) == any(
        "it has no gaussianNoise" in loss.message for loss in written.losses
    )


@pytest.mark.parametrize("kind", ["revolute", "fixed"])
def test_a_force_torque_plugin_is_a_sensor_of_its_joint(kind):
    said = (
        '<gazebo><plugin name="ft" filename="libgazebo_ros_ft_sensor.so">'
        "<jointName>j</jointName><updateRate>100</updateRate></plugin></gazebo>"
    )
    model = tree(export(link("a"), joint("j", "a", "b", kind), link("b"), said))
    made = model.find("joint/sensor")
    assert [made.get("type"), made.findtext("update_rate")] == ["force_torque", "100"]


def test_a_sensor_has_a_name_of_its_own():
    said = gazebo("a", '<sensor name="imu" type="imu"/>') + f"<gazebo>{IMU.format('a')}</gazebo>"
    names = [e.get("name") for e in tree(export(link("a", inertial()), said)).iter("sensor")]
    assert names == ["imu", "imu_2"]
