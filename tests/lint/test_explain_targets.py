"""``lint --explain-targets``: which file names a target, and what does not count."""

import json
from pathlib import Path

import jsonschema
import pytest

ROOT = Path(__file__).parents[2]
SCHEMA = json.loads((ROOT / "docs" / "schemas" / "lint-targets.json").read_text())
FILES = {
    "arm_description/package.xml": """<package format="3">
<name>arm_description</name>
<buildtool_depend>ament_cmake</buildtool_depend>
</package>""",
    "arm_description/urdf/arm.urdf.xacro": """<robot name="arm"
  xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="sim" default="false"/>
<link name="base"><visual><geometry>
  <mesh filename="package://gripper_description/hand.stl"/></geometry></visual></link>
<gazebo><plugin name="old" filename="libgazebo_ros_imu.so"/></gazebo>
<ros2_control name="arm" type="system"><hardware><plugin>mock/System</plugin></hardware>
</ros2_control></robot>""",
    "arm_description/urdf/plain.urdf": '<robot name="plain"><link name="base"/></robot>',
    "arm_description/config/arm.yaml": """controller_manager:
  ros__parameters:
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
""",
    "arm_description/launch/show.launch.py": "FILES = ['arm.urdf.xacro', 'arm.yaml']",
    "arm_gz/package.xml": """<package format="3"><name>arm_gz</name>
<exec_depend>ros_gz_sim</exec_depend></package>""",
    "arm_gz/launch/sim.launch.xml": """<launch>
<!-- gazebo_ros -->
<node pkg="ros_gz_sim" exec="create"/>
<param value="$(command 'xacro $(find-pkg-share arm_description)/urdf/arm.urdf.xacro sim:=true')"/>
</launch>""",
    "other/package.xml": "<package><name>other</name><depend>gazebo_ros</depend></package>",
    "other/launch/other.launch.py": "START = 'gzserver'",
}
ARM = "arm_description/urdf/arm.urdf.xacro"


@pytest.fixture
def repository(tmp_path, monkeypatch):
    (tmp_path / ".git").mkdir()
    for name, text in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def explain(urdftool, *words):
    done = urdftool("lint", "--explain-targets", "--format", "json", *words)
    table = json.loads(done.out)
    jsonschema.validate(table, SCHEMA)
    return {robot["path"]: robot for robot in table["robots"]}, done.code


def list_evidence(robot, *, counts):
    return {
        (one["target"], one["path"], one["line"])
        for one in robot["evidence"]
        if (one["ignored"] is None) is counts
    }


def test_a_package_that_launches_the_robot_decides_the_generation(urdftool, repository):
    robots, code = explain(urdftool, ".")
    assert code == 0
    arm = robots[ARM]
    assert arm["targets"] == ["gz", "ros2"]
    assert list_evidence(arm, counts=True) == {
        ("ros2", "arm_description/package.xml", 3),
        ("gz", "arm_gz/package.xml", 2),
        ("gz", "arm_gz/launch/sim.launch.xml", 3),
        ("ros2", ARM, 7),
    }
    assert list_evidence(arm, counts=False) == {("gazebo-classic", ARM, 6)}
    [reason] = [one["ignored"] for one in arm["evidence"] if one["ignored"]]
    assert reason == "a package that launches it is for new Gazebo, a plugin for Gazebo Classic"


def test_a_robot_without_gazebo_elements_is_not_for_gazebo(urdftool, repository):
    plain = explain(urdftool, ".")[0]["arm_description/urdf/plain.urdf"]
    assert plain["targets"] == ["ros2"]
    reasons = {one["ignored"] for one in plain["evidence"] if one["target"] == "gz"}
    assert reasons == {"the robot has no <gazebo> element"}


def test_the_file_alone_has_the_targets_of_the_folder(urdftool, repository):
    alone = explain(urdftool, ARM)[0][ARM]
    together = explain(urdftool, ".")[0][ARM]
    assert alone["evidence"] == together["evidence"]
    assert alone["arguments"] is None
    done = urdftool("lint", ARM, "--format", "json")
    assert json.loads(done.out)["summary"]["targets"] == alone["targets"]


def test_packages_arguments_and_controllers(urdftool, repository):
    arm = explain(urdftool, ".")[0][ARM]
    folders = {"arm_description": "arm_description", "gripper_description": None}
    assert arm["packages"] == folders
    place = "arm_gz/launch/sim.launch.xml:4"
    assert arm["arguments"] == [{"values": {"sim": "true"}, "place": place}]
    [use] = arm["controllers"]
    assert use["path"] == "arm_description/config/arm.yaml"
    assert use["controllers"] == {"arm": "joint_trajectory_controller/JointTrajectoryController"}


def test_text(urdftool, repository):
    out = urdftool("lint", "--explain-targets", ".").out
    assert "    ros2: arm_description/package.xml:3: depends on ament_cmake\n" in out
    assert "    sim=true: arm_gz/launch/sim.launch.xml:4\n" in out
    assert "    gripper_description: not found\n" in out


def test_targets_that_are_set(urdftool, repository):
    arm = explain(urdftool, ARM, "--target", "mujoco")[0][ARM]
    assert (arm["targets"], arm["set_by"]) == (["mujoco"], "--target")
    assert {one["ignored"] for one in arm["evidence"]} == {"--target sets the targets"}
    (repository / "urdftool.toml").write_text('[lint]\ntargets = ["gz"]\n')
    arm = explain(urdftool, ARM)[0][ARM]
    assert (arm["targets"], arm["set_by"]) == (["gz"], "urdftool.toml")


@pytest.mark.parametrize("text", ["<robot", "", "<robot name='r'>\0</robot>"])
def test_a_robot_that_is_not_read_is_named(urdftool, repository, text):
    (repository / "broken.urdf").write_text(text)
    robots, code = explain(urdftool, ".")
    assert code == 2
    assert robots["broken.urdf"]["not_checked"]
    assert robots[ARM]["targets"] == ["gz", "ros2"]


def test_a_format_without_meaning_is_a_wrong_use(urdftool, repository):
    done = urdftool("lint", "--explain-targets", "--format", "sarif", ARM)
    assert done.code == 2
    assert "targets are printed as text or JSON" in done.err
