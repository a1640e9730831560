"""The generation of Gazebo: package.xml before launch files before plugins."""

import pytest

from urdftool.lint.options import Options
from urdftool.lint.run import check_file

CLASSIC = '<gazebo><plugin name="a" filename="libgazebo_ros_ray_sensor.so"/></gazebo>'
NEW = '<gazebo><plugin name="gz::sim::systems::Imu" filename="gz-sim-imu-system"/></gazebo>'
ROBOT = '<robot name="r"><link name="base"/>{}</robot>'
MANIFEST = """<package format="3"><name>p</name><exec_depend>{}</exec_depend>
<export><build_type>ament_cmake</build_type></export></package>"""
TRANSMISSION = """<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
<joint name="j"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>
</transmission>"""


def _check(tmp_path, blocks, dependency="", launch=""):
    if dependency:
        (tmp_path / "package.xml").write_text(MANIFEST.format(dependency), "utf-8")
    if launch:
        (tmp_path / "launch").mkdir()
        (tmp_path / "launch" / "gazebo.launch.py").write_text(launch, "utf-8")
    path = tmp_path / "r.urdf"
    path.write_text(ROBOT.format(blocks), "utf-8")
    return check_file(path, Options())


@pytest.mark.parametrize(
    ("blocks", "dependency", "launch", "expected", "overruled"),
    [
        (CLASSIC, "", "", {"gazebo-classic"}, False),
        (NEW, "", "", {"gz"}, False),
        (CLASSIC + NEW, "", "", {"gz"}, True),
        (CLASSIC, "ros_gz_sim", "", {"gz", "ros2"}, True),
        (NEW, "gazebo_ros", "", {"gazebo-classic", "ros2"}, True),
        (CLASSIC, "gazebo_ros", "", {"gazebo-classic", "ros2"}, False),
        (CLASSIC + NEW, "urdf", "x = 'gazebo_ros'", {"gazebo-classic", "ros2"}, True),
        (CLASSIC + NEW, "urdf", "# gazebo_ros\nx = 'ros_gz_sim'", {"gz", "ros2"}, True),
        (TRANSMISSION, "", "", {"ros1"}, False),
        (TRANSMISSION, "urdf", "", {"ros2"}, False),
    ],
)
def test_strong_evidence_decides(tmp_path, blocks, dependency, launch, expected, overruled):
    report = _check(tmp_path, blocks, dependency, launch)
    assert report.targets == expected
    assert bool(report.overruled) is overruled


def test_a_plugin_of_the_other_generation_is_a_finding(tmp_path, urdftool):
    _check(tmp_path, CLASSIC, "ros_gz_sim")
    done = urdftool("lint", str(tmp_path / "r.urdf"))
    assert "classic-plugin-in-gz" in done.out
    assert "package.xml is for new Gazebo, a plugin for Gazebo Classic" in done.out + done.err
