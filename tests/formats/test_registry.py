"""The registry of formats: its lines, and what a folder of a format must have."""

from importlib import import_module

import pytest

import urdftool
from tests.conftest import FIXTURES, ROOT
from urdftool.formats.registry import FORMATS, format_named

EVERYTHING = FIXTURES / "formats" / "everything" / "everything.urdf"

BEYOND = """<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/>
<calibration rising="0"/><safety_controller k_velocity="1"/></joint>
<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
<joint name="j"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>
<actuator name="m"/></transmission>
<ros2_control name="c" type="system"><joint name="j">
<command_interface name="position"/></joint></ros2_control>
<gazebo reference="b"><sensor name="s" type="imu"/></gazebo>
<gazebo><plugin name="p" filename="libgazebo_ros_p3d.so"/></gazebo></robot>
"""


def by_name(target):
    return target.name


def test_names_are_those_of_folders():
    for target in FORMATS:
        assert import_module(f"urdftool.formats.{target.name}").__doc__
    with pytest.raises(KeyError):
        format_named("collada")


FILES = {
    "urdf": EVERYTHING,
    "sdf": FIXTURES / "formats" / "sdf" / "gripper_arm.gz.sdf",
    "mjcf": FIXTURES / "formats" / "mjcf" / "arm.xml",
    "usd": FIXTURES / "formats" / "usd" / "arm.usda",
}


@pytest.mark.parametrize("target", FORMATS, ids=by_name)
def test_a_reader_gives_a_robot(target):
    file = FILES[target.name]
    assert target.has_suffix(file)
    reading = target.read(file)
    assert reading.robot.place.path == str(file)
    assert reading.robot.links


def test_the_reader_of_urdf_takes_the_options_of_load():
    robot = format_named("urdf").read(EVERYTHING, gltf_up="z").robot
    assert robot.name == urdftool.load(EVERYTHING).name


@pytest.mark.parametrize("target", FORMATS, ids=by_name)
def test_a_writer_has_options_checks_a_command_and_a_page(target, urdftool):
    options = import_module(f"urdftool.formats.{target.name}.options").Options()
    assert options.file == ""
    assert options.input_files == ()
    assert target.not_compared
    assert urdftool("export", target.name, "--help").code == 0
    assert (ROOT / "docs" / "formats" / f"{target.name}.md").is_file()


@pytest.mark.parametrize("target", [f for f in FORMATS if f.name != "urdf"], ids=by_name)
def test_a_writer_reports_what_its_format_cannot_express(target, write):
    options = import_module(f"urdftool.formats.{target.name}.options").Options(force=True)
    written = target.write(urdftool.load(write("r.urdf", BEYOND)), options)
    codes = {loss.code for loss in written.losses}
    assert target.cannot_express
    assert set(target.cannot_express) <= codes


@pytest.mark.parametrize("target", FORMATS, ids=by_name)
@pytest.mark.parametrize("letter", ["n", "\N{LATIN SMALL LETTER E WITH ACUTE}"])
def test_a_robot_with_a_long_name_has_short_file_names(target, write, letter):
    """File systems allow names of 255 bytes."""
    path = write("r.urdf", f'<robot name="{letter * 3000}"><link name="a"/></robot>')
    options = import_module(f"urdftool.formats.{target.name}.options").Options(force=True)
    written = target.write(urdftool.load(path), options)
    assert written.files
    assert max(len(name.encode()) for name in written.files) < 230


def test_the_export_command_offers_what_can_be_written(urdftool):
    shown = urdftool("export", "--help").out
    assert all(f"  {target.name} " in shown for target in FORMATS)
    assert urdftool("export", "collada", EVERYTHING).code == 2
