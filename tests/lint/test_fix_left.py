"""What ``lint --fix`` leaves alone, because it would break something elsewhere."""

from pathlib import Path

import pytest

from tests.conftest import XACRO

FIX = ("--fix", "--unsafe-fixes", "--no-cache", "--exit-zero")
GRIPPER = """<link name="palm"/>
<link name="finger">
  <inertial><mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/>
  </inertial>
</link>
<joint name="finger_joint" type="prismatic">
  <parent link="palm"/><child link="finger"/><axis xyz="1 0 0"/>
  <limit lower="0" upper="0.04" effort="1" velocity="1"/>
</joint>
"""
PLUGIN = ("--select", "missing-control-plugin", "--target", "gz", *FIX)


def package(write, name, depends=""):
    text = f'<package format="3"><name>{name}</name>{depends}</package>\n'
    return write(f"ws/src/{name}/package.xml", text)


@pytest.mark.parametrize(
    ("include", "is_it"),
    [
        ("$(find gripper)/urdf/gripper.urdf.xacro", True),
        ("../../gripper/urdf/gripper.urdf.xacro", True),
        ("${folder}/gripper.urdf.xacro", True),
        ("$(find other)/urdf/gripper.urdf.xacro", False),
        ("gripper.urdf.xacro", False),
    ],
)
def test_an_end_effector_of_another_robot_gets_no_plugin(write, urdftool, include, is_it):
    package(write, "gripper", "<depend>gz_ros2_control</depend>")
    package(write, "arm")
    path = write("ws/src/gripper/urdf/gripper.urdf.xacro", XACRO.format(GRIPPER))
    body = f'<xacro:include filename="{include}"/>\n'
    write("ws/src/arm/urdf/arm.urdf.xacro", XACRO.format(body))
    result = urdftool("-v", "lint", path, *PLUGIN)
    assert ("<plugin" in Path(path).read_text()) is not is_it
    said = "arm.urdf.xacro includes gripper.urdf.xacro, and would get the element too"
    assert (said in result.err) is is_it


def test_a_robot_of_its_own_gets_its_plugin(write, urdftool):
    package(write, "gripper", "<depend>gz_ros2_control</depend>")
    path = write("ws/src/gripper/urdf/gripper.urdf.xacro", XACRO.format(GRIPPER))
    urdftool("lint", path, *PLUGIN)
    assert "gz-sim-joint-state-publisher-system" in Path(path).read_text()


def test_a_world_is_not_declared_in_a_part(write, urdftool):
    package(write, "arm")
    held = '<link name="base"/><joint name="hold" type="fixed"><parent link="world"/>'
    held += '<child link="base"/></joint>\n'
    path = write("ws/src/arm/urdf/arm.urdf.xacro", XACRO.format(held))
    words = ("lint", path, "--select", "unknown-parent-link", *FIX)
    cell = '<link name="world"/><xacro:include filename="arm.urdf.xacro"/>'
    other = write("ws/src/arm/urdf/cell.urdf.xacro", XACRO.format(cell))
    assert "Nothing to fix." in urdftool(*words).err
    Path(other).unlink()
    assert "Fixed 1" in urdftool(*words[:4], "--fix", "--no-cache").err
    assert '<link name="world"/>' in Path(path).read_text()


NAMED = """<robot name="r">
  <link name="base"/>
  <link name="arm"/>
  <joint name="{joint}" type="{kind}">
    <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
  </joint>
</robot>
"""


@pytest.mark.parametrize(
    ("rule", "joint", "target", "kind", "renamed"),
    [
        ("link-joint-name-clash", "arm", "ros2", "continuous", False),
        ("link-joint-name-clash", "arm", "gz", "continuous", True),
        ("name-style", "armJoint", "ros2", "continuous", False),
        ("name-style", "armJoint", "ros2", "fixed", True),
        ("not-portable-identifier", "arm-joint", "ros2", "continuous", False),
        ("non-ascii-name", "schär", "ros2", "continuous", False),
        ("non-ascii-name", "schär", "ros2", "fixed", True),
    ],
)
def test_a_joint_that_moves_is_not_renamed_for_a_remark(
    write, urdftool, rule, joint, target, kind, renamed
):
    text = NAMED.format(joint=joint, kind=kind)
    path = write("r.urdf", text)
    urdftool("lint", path, "--select", rule, "--target", target, *FIX)
    assert (Path(path).read_text("utf-8") != text) is renamed


FOLLOWING = """<robot name="r">
  <link name="base"/><link name="a"/><link name="b"/>
  <joint name="leader" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
    <limit lower="{0}" upper="{1}" effort="1" velocity="1"/></joint>
  <joint name="follower" type="revolute"><parent link="base"/><child link="b"/><axis xyz="0 0 1"/>
    <limit lower="{2}" upper="{3}" effort="1" velocity="1"/>
    <mimic joint="leader" multiplier="{4}" offset="{5}"/></joint>
</robot>
"""


@pytest.mark.parametrize(
    ("limits", "is_found"),
    [
        (("0", "1", "0", "0.5", "1", "0"), True),
        (("2", "3", "0", "1", "1", "0"), True),
        (("0", "1", "0.5", "-0.5", "1", "0"), False),
        (("1", "0", "0", "0.5", "1", "0"), False),
    ],
)
def test_no_limits_are_computed_for_mimic_joints(write, urdftool, limits, is_found):
    """The file does not tell which limits are right, and exchanged ones are reported first."""
    path = write("r.urdf", FOLLOWING.format(*limits))
    words = ("lint", path, "--select", "mimic-limits-inconsistent")
    assert ("[mimic-limits-inconsistent]" in urdftool(*words).out) is is_found
    urdftool(*words, *FIX)
    assert Path(path).read_text() == FOLLOWING.format(*limits)


SENSOR = """<robot name="r">
  <link name="head"/>
  <gazebo reference="head">
    <sensor name="front" type="camera">{}<camera/></sensor>
  </gazebo>
</robot>
"""


@pytest.mark.parametrize(
    ("pose", "named"),
    [
        ("", True),
        ("<pose>0 0 0 0 0 0</pose>", True),
        ("<pose>0 0 0.1 0 0 0</pose>", False),
        ("<pose>0 0 0 0 1.57 0</pose>", False),
        ('<pose relative_to="base">0 0 0 0 0 0</pose>', False),
    ],
)
def test_a_sensor_with_a_pose_does_not_measure_in_its_link(write, urdftool, pose, named):
    path = write("r.urdf", SENSOR.format(pose))
    words = ("--select", "missing-gz-frame-id", "--target", "gz", "--fix", "--exit-zero")
    urdftool("lint", path, *words)
    assert ("<gz_frame_id>head</gz_frame_id>" in Path(path).read_text()) is named


def test_a_library_of_ignition_gets_the_class_of_ignition(write, urdftool):
    plugin = '<plugin filename="ignition-gazebo-imu-system" name="mine"/>'
    path = write("r.urdf", f'<robot name="r"><link name="a"/><gazebo>{plugin}</gazebo></robot>')
    urdftool("lint", path, "--select", "plugin-class-mismatch", "--target", "gz", "--fix")
    assert 'name="ignition::gazebo::systems::Imu"' in Path(path).read_text()
    assert "plugin-class-mismatch" not in urdftool("lint", path, "--target", "gz").out


MESH = """<robot name="r">
  <link name="base"><visual><geometry><mesh filename="package://{}/a.stl"/></geometry></visual></link>
</robot>
"""
STL = b"\0" * 80 + b"\x01\0\0\0" + b"\0" * 50


@pytest.mark.parametrize(
    ("depends", "safe"),
    [
        ("<buildtool_depend>catkin</buildtool_depend>", False),
        ("<depend>catkin</depend><depend>gazebo_ros</depend>", True),
        ("<buildtool_depend>ament_cmake</buildtool_depend>", True),
    ],
)
def test_a_description_is_not_made_to_need_gazebo(write, urdftool, depends, safe):
    manifest = Path(package(write, "arm", depends))
    write("ws/src/arm/a.stl", STL)
    path = write("ws/src/arm/r.urdf", MESH.format("arm"))
    words = ("lint", path, "--select", "gazebo-path-not-exported", "--target", "gz")
    before = manifest.read_text()
    urdftool(*words, "--fix", "--no-cache")
    assert (manifest.read_text() != before) is safe
    assert manifest.read_text().count("gazebo_ros</") == depends.count("gazebo_ros")
    urdftool(*words, *FIX)
    assert "gazebo_model_path" in manifest.read_text()


@pytest.mark.parametrize(
    ("back", "condition"),
    [
        ("<depend>arm</depend>", False),
        ('<depend condition="$X == 1">arm</depend>', True),
        ("", False),
    ],
)
def test_no_dependency_closes_a_circle(write, urdftool, back, condition):
    manifest = Path(package(write, "arm"))
    package(write, "store", "<depend>between</depend>")
    package(write, "between", back)
    write("ws/src/store/a.stl", STL)
    path = write("ws/src/arm/r.urdf", MESH.format("store"))
    before = manifest.read_text()
    words = ("lint", path, "--select", "undeclared-mesh-dependency,dependency-circle")
    result = urdftool(*words, "--target", "ros2", *FIX)
    assert (manifest.read_text() != before) is (not back)
    if back:
        rule = "undeclared-mesh-dependency" if condition else "dependency-circle"
        assert f"[{rule}]" in result.out
    else:
        assert "<exec_depend>store</exec_depend>" in manifest.read_text()


def test_a_package_that_names_itself_by_its_folder_needs_no_dependency(write, urdftool):
    write("ws/src/arm-data/package.xml", "<package><name>arm_data</name></package>")
    write("ws/src/arm-data/a.stl", STL)
    path = write("ws/src/arm-data/r.urdf", MESH.format("arm-data"))
    words = ("--select", "undeclared-mesh-dependency", "--target", "ros2", "--no-cache")
    assert "undeclared" not in urdftool("lint", path, *words).out
