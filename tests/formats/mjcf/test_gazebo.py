"""What ``<gazebo>`` says: friction, weight, colours, sensors, lights; the rest is said."""

import math

import pytest

from urdftool.formats.mjcf.options import Options
from urdftool.formats.registry import format_named
from urdftool.model.load import load
from urdftool.refusal import Refused

from .robots import BOX, INERTIAL, export, find, joint, link, robot, rules, tree

SHAPES = f"{INERTIAL}<visual>{BOX}</visual><collision name='a_c'>{BOX}</collision>"


def gazebo(inside, reference="a"):
    return f'<gazebo reference="{reference}">{inside}</gazebo>'


def exported(write, *blocks):
    return export(write("r.urdf", robot(link("a", SHAPES), *blocks)))


def geom(model, kind):
    return next(g for g in model.iter("geom") if g.get("class") == kind)


def test_friction(write):
    model = tree(exported(write, gazebo("<mu1>0.4</mu1><mu2>0.4</mu2>")))
    assert geom(model, "collision").get("friction") == "0.4 0.005 0.0001"


def test_unequal_friction_is_said(write):
    assert "lossy-friction" in rules(exported(write, gazebo("<mu1>0.4</mu1><mu2>0.2</mu2>")))


@pytest.mark.parametrize(
    "text",
    ["<turnGravityOff>true</turnGravityOff>", "<gravity>0</gravity>", "<gravity>false</gravity>"],
)
def test_weightless(write, text):
    assert find(tree(exported(write, gazebo(text))), "body", "a").get("gravcomp") == "1"


def test_colour_of_gazebo_where_urdf_has_none(write):
    model = tree(exported(write, gazebo("<material>Gazebo/Red</material>")))
    assert geom(model, "visual").get("rgba") == "1 0 0 1"


@pytest.mark.parametrize("text", ["<mu1>${mu}</mu1>", "<mu1/>", "<kp>1e6.0</kp>"])
def test_numbers_that_are_none(write, text):
    with pytest.raises(Refused) as caught:
        exported(write, gazebo(text))
    assert caught.value.findings[0].code == "bad-extension-number"


@pytest.mark.parametrize("keyword", ["kp", "maxVel", "dampingFactor", "selfCollide", "laserRetro"])
def test_what_is_not_carried_is_said(write, keyword):
    written = exported(write, gazebo(f"<{keyword}>1</{keyword}>"))
    assert any(f"<{keyword}>" in loss.message for loss in written.losses)


def test_a_reference_to_nothing_is_said(write):
    path = write("r.urdf", robot(link("a", SHAPES), gazebo("<mu1>1</mu1>", "ghost")))
    assert "dangling-reference" in rules(format_named("mjcf").write(load(path), Options()))


def test_camera_looks_along_x(write):
    sensor = (
        '<sensor name="eye" type="camera"><pose>1 2 3 0 0 0</pose><camera>'
        "<horizontal_fov>1.5707963267948966</horizontal_fov>"
        "<image><width>640</width><height>640</height></image></camera></sensor>"
    )
    camera = find(tree(exported(write, gazebo(sensor))), "camera", "eye")
    assert camera.get("pos") == "1 2 3"
    assert camera.get("quat") == "1 1 -1 -1"
    assert float(camera.get("fovy")) == pytest.approx(90)


def test_imu_is_a_site_with_three_sensors(write):
    model = tree(exported(write, gazebo('<sensor name="imu" type="imu"/>')))
    assert find(model, "site", "imu") is not None
    assert [element.tag for element in model.find("sensor")] == [
        "accelerometer",
        "gyro",
        "framequat",
    ]


def test_force_torque_of_a_joint_is_at_its_child(write):
    text = robot(
        link("a"), link("b"), joint("j", "a", "b"),
        gazebo('<sensor name="ft" type="force_torque"/>', "j"),
    )  # fmt: skip
    model = tree(export(write("r.urdf", text)))
    assert find(model, "site", "ft").getparent().get("name") == "b"
    assert [element.tag for element in model.find("sensor")] == ["force", "torque"]


@pytest.mark.parametrize(("samples", "count"), [(5, 5), (640, 0)])
def test_rays(write, samples, count):
    sensor = (
        f'<sensor name="scan" type="ray"><ray><scan><horizontal><samples>{samples}</samples>'
        "<min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan></ray></sensor>"
    )
    written = exported(write, gazebo(sensor))
    assert len(list(tree(written).iter("rangefinder"))) == count
    assert ("lossy-sensor" in rules(written)) == (count == 0)


def test_unknown_sensor_is_said(write):
    assert "lossy-sensor" in rules(exported(write, gazebo('<sensor name="s" type="rfid"/>')))


def test_spot_light(write):
    light = (
        '<light name="lamp" type="spot"><pose>0 0 1 0 0 0</pose><direction>1 0 0</direction>'
        f"<spot><outer_angle>{math.pi / 2}</outer_angle></spot></light>"
    )
    element = find(tree(exported(write, gazebo(light))), "light", "lamp")
    assert element.get("dir") == "1 0 0"
    assert float(element.get("cutoff")) == pytest.approx(45)


def test_plugins_are_noted(write):
    block = '<gazebo><plugin name="p" filename="libx.so"/></gazebo>'
    assert "lossy-plugin" in rules(exported(write, block))
