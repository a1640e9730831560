"""Sensors, actuators, contact pairs and plugins of two files of one format."""

import pytest

import urdftool as api
from tests.cases import list_cases
from urdftool.compare.compare import compare_robots

LIMB = '<geom type="sphere" size="0.1"/>'
MJCF = f"""<mujoco model="m"><worldbody><body name="a">{LIMB}<body name="b"><joint name="j"/>{LIMB}
<site name="s"/></body></body></worldbody>
<contact><exclude body1="a" body2="b"/></contact>
<actuator><position name="servo" joint="j" kp="10"/></actuator>
<sensor><gyro name="g" site="s"/></sensor>
<keyframe><key name="home" qpos="0.1"/></keyframe></mujoco>"""
CHANGES = {
    "contact pairs": ('<exclude body1="a" body2="b"/>', ""),
    "actuators": ('kp="10"', 'kp="11"'),
    "sensors": ("<gyro", "<accelerometer"),
    "configurations": ('qpos="0.1"', 'qpos="0.2"'),
}
URDF = """<robot name="r"><link name="a"/><gazebo><plugin name="p" filename="x.so"><rate>{}</rate>
</plugin></gazebo></robot>"""


def compare(tmp_path, one, two, suffix):
    paths = []
    for name, text in (("one", one), ("two", two)):
        paths.append(tmp_path / f"{name}{suffix}")
        paths[-1].write_text(text)
    return compare_robots(*map(api.load, paths))


@pytest.mark.library("mujoco")
@pytest.mark.parametrize("row", list_cases(CHANGES, 2))
def test_a_change_is_named_in_its_row(tmp_path, row):
    assert compare(tmp_path, MJCF, MJCF, ".xml").is_equal
    comparison = compare(tmp_path, MJCF, MJCF.replace(*CHANGES[row]), ".xml")
    assert {difference.row for difference in comparison.differences} == {row}


def test_the_parameter_of_a_plugin(tmp_path):
    comparison = compare(tmp_path, URDF.format(10), URDF.format(20), ".urdf")
    (difference,) = comparison.differences
    assert (difference.row, difference.values) == ("simulator data", ("10", "20"))


SENSORS = """<robot name="r"><link name="a"/><gazebo reference="a"><sensor name="imu" type="imu">
<update_rate>50</update_rate><plugin name="p" filename="libx.so"><ns k="v">text</ns></plugin>
</sensor></gazebo><ros2_control name="s" type="sensor"><hardware><plugin>a/B</plugin></hardware>
<sensor name="ft"><state_interface name="force.x"/></sensor></ros2_control></robot>"""
SENSOR_OF_SDF = """<sdf version="1.9"><model name="r"><link name="a"><sensor name="imu" type="imu">
<update_rate>50</update_rate><plugin name="p" filename="libx.so"><ns k="v">text</ns></plugin>
</sensor></link></model></sdf>"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("libx.so", "liby.so"),
        ('name="p"', 'name="q"'),
        (">text<", ">other<"),
        ('k="v"', 'k="w"'),
        ('name="imu"', 'name="other"'),
        ("force.x", "torque.z"),
        ('name="ft"', 'name="other"'),
    ],
)
def test_what_is_in_a_sensor_is_compared(tmp_path, old, new):
    assert compare(tmp_path, SENSORS, SENSORS, ".urdf").is_equal
    comparison = compare(tmp_path, SENSORS, SENSORS.replace(old, new), ".urdf")
    assert {difference.row for difference in comparison.differences} == {"simulator data"}


@pytest.mark.parametrize(
    ("old", "new"), [("libx.so", "liby.so"), ('"p"', '"q"'), (">text<", "><"), ('k="v"', "")]
)
def test_the_plugin_of_a_sensor_is_compared_in_two_formats(tmp_path, old, new):
    (tmp_path / "a.urdf").write_text(SENSORS)
    found = []
    for text in (SENSOR_OF_SDF, SENSOR_OF_SDF.replace(old, new)):
        (tmp_path / "b.sdf").write_text(text)
        comparison = compare_robots(api.load(tmp_path / "a.urdf"), api.load(tmp_path / "b.sdf"))
        found.append([d for d in comparison.differences if d.row == "plugins"])
    assert [len(one) for one in found] == [0, 1]


EMPTY = {
    ".xml": '<mujoco model="m"><worldbody><body name="a"><joint/>'
    + LIMB
    + "</body></worldbody></mujoco>",
    ".urdf": '<robot name="r"><link name="a"/></robot>',
}


@pytest.mark.parametrize(
    "suffix", [pytest.param(".xml", marks=pytest.mark.library("mujoco")), ".urdf"]
)
def test_a_row_without_parts_is_not_equal(tmp_path, suffix):
    checks = compare(tmp_path, EMPTY[suffix], EMPTY[suffix], suffix).make_checks()
    verdicts = {check.name: check.verdict for check in checks}
    rows = {".xml": CHANGES.keys() | {"loops"}, ".urdf": {"simulator data", "textures", "mass"}}
    assert {verdicts[row] for row in rows[suffix]} == {"none"}
    assert verdicts["tree"] == "equal"


@pytest.mark.library("mujoco")
def test_rows_with_parts_are_equal(tmp_path):
    checks = compare(tmp_path, MJCF, MJCF, ".xml").make_checks()
    assert {check.name for check in checks if check.verdict == "equal"} >= CHANGES.keys()


def test_the_range_of_a_command_interface_is_compared(tmp_path):
    text = (
        '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="continuous">'
        '<parent link="a"/><child link="b"/></joint><ros2_control name="c" type="system">'
        '<joint name="j"><command_interface name="position"><param name="min">-1</param>'
        "</command_interface></joint></ros2_control></robot>"
    )
    found = compare(tmp_path, text, text.replace(">-1<", ">-2<"), ".urdf")
    assert [(d.row, d.values) for d in found.differences] == [("simulator data", ("-1", "-2"))]


SDF = """<sdf version="1.9"><model name="m"><link name="a"><inertial><mass>1</mass></inertial>
<light name="lamp" type="point"><pose>0 0 1 0 0 0</pose><diffuse>1 0 0 1</diffuse></light>
<battery name="b"><voltage>12</voltage></battery></link>
<link name="t"><pose>0 0 .5 0 0 0</pose>{}</link>
<joint name="j" type="fixed"><parent>a</parent><child>t</child></joint>
<plugin name="q" filename="x"><rate>1</rate></plugin></model></sdf>"""
BEAM = '<projector name="p"><pose>0 .1 0 0 0 0</pose><texture>t.png</texture></projector>'


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("1 0 0 1", "0 1 0 1", ("other elements", "<light> 'lamp': diffuse")),
        (">12<", ">24<", ("other elements", "<battery> 'b': voltage")),
        ("0 .1 0", "0 .2 0", ("other elements", "<projector> 'p': pose")),
        (BEAM, "", ("other elements", "<projector> 'p': existence")),
        ("<rate>1", "<rate>2", ("plugins", "plugin 'q': rate")),
    ],
)
def test_elements_of_two_sdf(tmp_path, old, new, expected):
    text = SDF.format(BEAM)
    comparison = compare(tmp_path, text, text.replace(old, new, 1), ".sdf")
    assert [(d.row, d.title) for d in comparison.differences] == [expected]


def test_an_element_in_another_link_of_the_same_body_is_equal(tmp_path):
    moved = SDF.format("").replace("<battery", BEAM.replace("0 .1 0", "0 .1 .5") + "<battery")
    assert compare(tmp_path, SDF.format(BEAM), moved, ".sdf").is_equal


@pytest.mark.library("mujoco")
def test_the_place_of_an_effort_is_that_of_its_motor(tmp_path):
    motor = MJCF.replace('<position name="servo" joint="j" kp="10"/>',
                         '<motor joint="j" ctrlrange="-1 1" gear="30"/>')  # fmt: skip
    comparison = compare(tmp_path, motor, motor.replace('"30"', '"40"'), ".xml")
    (effort,) = [d for d in comparison.differences if d.what == "limit of effort"]
    assert [place.line for place in effort.places] == [4, 4]
