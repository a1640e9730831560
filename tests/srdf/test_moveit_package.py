"""``urdftool srdf --moveit``: the package is complete, consistent, and keeps what exists."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml

from urdftool.model.load import load
from urdftool.srdf.moveit.distributions import DISTRIBUTIONS
from urdftool.srdf.moveit.package import LAUNCHES

from .moveit_loader import MoveItConfigs, list_undeclared
from .small_robots import ARM, FINGERS, WHEELS, prefix_lines, write_urdf

MANIFEST = '<package format="3"><name>{}</name></package>'
LONG_ARM = ARM.replace("tool: l3", "j4: l3 > l4 revolute\nj5: l4 > l5 revolute\ntool: l5")


@pytest.fixture
def make(write, urdftool):
    """Write a robot in a package, and its MoveIt package; gives the result and the folder."""

    def maker(lines, *arguments, name="robot", more="", text=""):
        write("robot_description/package.xml", MANIFEST.format("robot_description"))
        urdf = text or write_urdf(lines, name, ["tool0"], more)
        path = write("robot_description/urdf/robot.urdf.xacro", urdf)
        result = urdftool("srdf", path, "--moveit", "moveit_config", *arguments)
        return result, Path("moveit_config")

    return maker


def load_package(folder: Path, stem: str = "robot") -> MoveItConfigs:
    return MoveItConfigs(folder, stem, {"robot_description": Path("robot_description").resolve()})


def read_all(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


@pytest.mark.parametrize(
    "lines",
    [
        pytest.param(ARM, id="arm"),
        pytest.param(LONG_ARM + FINGERS, id="arm with gripper"),
        pytest.param(WHEELS + ARM, id="mobile base with arm"),
        pytest.param(
            "ml: base > left_base fixed\nmr: base > right_base fixed\n"
            + prefix_lines(ARM + FINGERS, "left_")
            + "\n"
            + prefix_lines(ARM + FINGERS, "right_"),
            id="two arms",
        ),
        pytest.param(
            ARM + "f: tool0 > t revolute mimic=j1,1", id="mimic joint whose leader is elsewhere"
        ),
        pytest.param(prefix_lines(ARM, "手 é'"), id="names with spaces and unicode"),
        pytest.param(prefix_lines(ARM, "{{a}}"), id="names with braces"),
        pytest.param(ARM.replace("limit=-1.5,1.5", "limit=1,-1"), id="crossed limits"),
    ],
)
def test_package_is_loaded_and_consistent(make, lines) -> None:
    result, folder = make(lines)
    assert (result.code, result.err.count("[")) == (0, 0), result.err
    assert "find nothing" in result.err
    configs = load_package(folder)
    assert list_undeclared(configs) == []
    source = load(Path("robot_description/urdf/robot.urdf.xacro"))
    robot = configs.robot
    assert (robot.name, list(robot.link), list(robot.joint)) == (
        source.name,
        list(source.link),
        list(source.joint),
    )
    check_names(configs)


def check_names(configs: MoveItConfigs) -> None:
    """Check that the files refer to each other's names, and that every joint can be moved."""
    groups = {element.get("name") for element in configs.semantic.list_children("group")}
    assert set(configs.kinematics or {}) <= groups
    manager = configs.trajectory_execution["moveit_simple_controller_manager"]
    spawned = configs.ros2_controllers["controller_manager"]["ros__parameters"]
    joints: list[str] = []
    for name in manager["controller_names"]:
        section = manager[name]
        own = configs.ros2_controllers[name]["ros__parameters"]
        assert section["joints"] == own.get("joints", [own.get("joint")])
        assert section["default"] is True
        joints += section["joints"]
    assert set(configs.spawned) <= set(spawned)
    assert len(joints) == len(set(joints))
    controlled = {one.name for block in configs.robot.ros2_controls for one in block.joints}
    assert set(joints) <= controlled
    assert set(joints) <= set(configs.joint_limits["joint_limits"])


def test_numbers_of_the_arm(make) -> None:
    _, folder = make(LONG_ARM + FINGERS)
    configs = load_package(folder)
    assert configs.joint_limits["joint_limits"]["j1"] == {
        "has_velocity_limits": True,
        "max_velocity": 2.0,
        "has_acceleration_limits": True,
        "max_acceleration": 4.0,
    }
    assert "left" in configs.joint_limits["joint_limits"]
    assert "right" not in configs.joint_limits["joint_limits"]  # a mimic joint
    text = (folder / "config/joint_limits.yaml").read_text()
    assert text.count("max_acceleration: 4.0  # guess") == 6
    assert configs.kinematics["arm"]["position_only_ik"] is True  # five joints
    assert "gripper" not in configs.kinematics


def test_six_joints_reach_orientations(make) -> None:
    lines = LONG_ARM.replace("tool: l5", "j6: l5 > l6 revolute\ntool: l6")
    _, folder = make(lines)
    assert "position_only_ik" not in load_package(folder).kinematics["arm"]


@pytest.mark.parametrize("name", DISTRIBUTIONS)
def test_gripper_controller_of_the_distribution(make, name) -> None:
    result, folder = make(ARM + FINGERS, "--ros", name)
    assert result.code == 0, result.err
    configs = load_package(folder)
    known = DISTRIBUTIONS[name]
    spawned = configs.ros2_controllers["controller_manager"]["ros__parameters"]
    manager = configs.trajectory_execution["moveit_simple_controller_manager"]
    assert spawned["gripper_controller"]["type"] == known.gripper_controller
    assert manager["gripper_controller"]["type"] == known.gripper_type
    assert f"<exec_depend>{known.gripper_package}<" in (folder / "package.xml").read_text()


def test_launch_files_are_python_and_load_this_package(make) -> None:
    _, folder = make(ARM)
    for name in LAUNCHES:
        text = (folder / "launch" / f"{name}.launch.py").read_text()
        compile(text, name, "exec")
        assert "MoveItConfigsBuilder('robot', package_name='moveit_config')" in text
    assert "install(DIRECTORY config launch" in (folder / "CMakeLists.txt").read_text()


def test_planning_frame_is_the_world_of_the_virtual_joint(make) -> None:
    _, folder = make(ARM)
    rviz = yaml.safe_load((folder / "config/moveit.rviz").read_text())
    assert rviz["Visualization Manager"]["Global Options"]["Fixed Frame"] == "world"


XACRO = """<robot name="robot" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="prefix" default="a_"/>
{}
</robot>"""


def test_xacro_arguments_are_kept(make) -> None:
    inner = write_urdf(prefix_lines(ARM, "PRE")).partition("\n")[2].rpartition("\n")[0]
    text = XACRO.format(inner.replace("PRE", "$(arg prefix)"))
    result, folder = make("", "prefix:=b_", text=text)
    assert result.code == 0, result.err
    configs = load_package(folder)
    assert "b_j1" in configs.robot.joint
    settings = yaml.safe_load((folder / ".setup_assistant").read_text())
    assert settings["moveit_setup_assistant_config"]["urdf"]["xacro_args"] == "prefix:=b_"


CONTROL = """<ros2_control name="real" type="system"><hardware><plugin>a/B</plugin></hardware>
{}</ros2_control>"""
JOINT = """<joint name="{}"><command_interface name="{}"/><state_interface name="position"/>
<state_interface name="velocity"/></joint>"""


def test_joints_with_hardware_get_no_mock_hardware(make) -> None:
    joints = "".join(JOINT.format(name, "position") for name in ("j1", "j2", "j3"))
    result, folder = make(ARM + FINGERS, more=CONTROL.format(joints))
    assert result.code == 0, result.err
    blocks = load_package(folder).robot.ros2_controls
    assert {one.name: [j.name for j in one.joints] for one in blocks} == {
        "real": ["j1", "j2", "j3"],
        "MockSystem": ["left"],
    }


def test_robot_with_hardware_only(make) -> None:
    joints = "".join(JOINT.format(name, "velocity") for name in ("j1", "j2", "j3"))
    result, folder = make(ARM, more=CONTROL.format(joints))
    assert result.code == 0, result.err
    assert not (folder / "config/robot.ros2_control.xacro").exists()
    own = load_package(folder).ros2_controllers["arm_controller"]["ros__parameters"]
    assert own["command_interfaces"] == ["velocity"]


# an existing package ------------------------------------------------------------------------


def test_second_run_changes_nothing(make) -> None:
    _, folder = make(ARM + FINGERS)
    before = read_all(folder)
    result, _ = make(ARM + FINGERS)
    assert result.code == 0
    assert "0 files are new, 0 completed, 21 kept" in result.err
    assert read_all(folder) == before


def edit(path: Path, *changes: tuple[str, str]) -> None:
    text = path.read_text("utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path.write_text(text, "utf-8")


def test_edits_by_hand_are_kept_and_new_joints_added(make) -> None:
    _, folder = make(ARM)
    limits = folder / "config/joint_limits.yaml"
    edit(limits, ("max_acceleration: 4.0  # guess", "max_acceleration: 9.5  # measured"))
    edit(limits, ("    has_acceleration_limits: true\n", ""))
    edit(folder / "launch/demo.launch.py", ("from moveit", "# mine\nfrom moveit"))
    before = read_all(folder)
    longer = LONG_ARM
    result, _ = make(longer)
    assert "added joint_limits.j4, joint_limits.j5" in result.err
    after = read_all(folder)
    assert after["launch/demo.launch.py"] == before["launch/demo.launch.py"]
    configs = load_package(folder)
    table = configs.joint_limits["joint_limits"]
    assert table["j1"]["max_acceleration"] == 9.5
    assert table["j1"]["has_acceleration_limits"] is True  # a key that was lacking
    assert list(table) == ["j1", "j2", "j3", "j4", "j5"]
    kept = before["config/joint_limits.yaml"].decode().splitlines()
    shown = after["config/joint_limits.yaml"].decode().splitlines()
    assert [line for line in shown if line in kept] == kept or set(kept) <= set(shown)


def test_renamed_group_keeps_its_name_everywhere(make) -> None:
    _, folder = make(ARM)
    edit(folder / "config/robot.srdf", ('<group name="arm">', '<group name="manipulator">'))
    edit(folder / "config/robot.srdf", ('group="arm"', 'group="manipulator"'))
    (folder / "config/kinematics.yaml").unlink()
    result, _ = make(ARM)
    assert result.code == 0, result.err
    assert list(load_package(folder).kinematics) == ["manipulator"]


def test_existing_controllers_are_adopted(make) -> None:
    _, folder = make(ARM)
    for name in ("ros2_controllers", "moveit_controllers"):
        path = folder / f"config/{name}.yaml"
        path.write_text(path.read_text().replace("arm_controller", "scaled_controller"))
    edit(
        folder / "config/moveit_controllers.yaml",
        ("    action_ns: follow_joint_trajectory\n", ""),
        ("    default: true\n", ""),
    )
    make(ARM + FINGERS)
    configs = load_package(folder)
    manager = configs.trajectory_execution["moveit_simple_controller_manager"]
    assert manager["controller_names"] == ["scaled_controller", "gripper_controller"]
    assert manager["scaled_controller"]["action_ns"] == "follow_joint_trajectory"
    assert manager["scaled_controller"]["default"] is True
    assert "arm_controller" not in configs.ros2_controllers


def test_new_group_gets_a_controller_in_existing_lists(make) -> None:
    _, folder = make(ARM)
    edit(
        folder / "config/robot.srdf",
        ("</group>", '</group>\n  <group name="gripper"><link name="left_tip"/></group>'),
    )
    make(ARM + FINGERS)
    configs = load_package(folder)
    manager = configs.trajectory_execution["moveit_simple_controller_manager"]
    assert manager["controller_names"] == ["arm_controller", "gripper_controller"]
    check_names(configs)


def test_flow_style_and_line_ends_are_kept(make) -> None:
    _, folder = make(ARM)
    limits = folder / "config/joint_limits.yaml"
    limits.write_bytes(b"joint_limits: {j1: {max_velocity: 1.5}}\r\n# end\r\n")
    names = folder / "config/moveit_controllers.yaml"
    names.write_bytes(b"moveit_simple_controller_manager:\r\n  controller_names: []\r\n")
    result, _ = make(ARM)
    assert result.code == 0, result.err
    text = limits.read_bytes()
    assert text.startswith(b"joint_limits: {j1: {max_velocity: 1.5, has_velocity_limits: true")
    assert b"\n" not in text.replace(b"\r\n", b"")
    configs = load_package(folder)
    assert configs.joint_limits["joint_limits"]["j1"]["max_velocity"] == 1.5
    check_names(configs)


def test_file_of_comments_gets_its_content(make) -> None:
    _, folder = make(ARM)
    path = folder / "config/pilz_cartesian_limits.yaml"
    path.write_text("# to be written\n")
    make(ARM)
    assert path.read_text().startswith("# to be written\ncartesian_limits:\n")


def test_integer_by_hand_is_kept_and_reported(make) -> None:
    _, folder = make(ARM)
    edit(folder / "config/joint_limits.yaml", ("max_velocity: 2.0", "max_velocity: 2"))
    result, _ = make(ARM)
    assert result.code == 1
    assert "[moveit-parameter-type]" in result.err
    assert "max_velocity: 2\n" in (folder / "config/joint_limits.yaml").read_text()


# bad input ----------------------------------------------------------------------------------


def test_no_joints(make) -> None:
    result, folder = make("only: base > part fixed")
    assert result.code == 2
    assert "no planning group" in result.err
    assert not folder.exists()


@pytest.mark.parametrize("text", ["a: [", "- a\n", "a: b: c\n", "\t\tx: y"])
def test_broken_parameter_file(make, text) -> None:
    _, folder = make(ARM)
    (folder / "config/kinematics.yaml").write_text(text)
    (folder / "launch/demo.launch.py").unlink()
    before = read_all(folder)
    result, _ = make(ARM)
    assert result.code == 2
    assert re.search(r"kinematics\.yaml(:\d+)?", result.err)
    assert read_all(folder) == before


def test_controller_names_that_are_no_list(make) -> None:
    _, folder = make(ARM)
    path = folder / "config/moveit_controllers.yaml"
    path.write_text("moveit_simple_controller_manager:\n  controller_names: arm\n")
    result, _ = make(ARM)
    assert result.code == 2
    assert "moveit_controllers.yaml:2:21: controller_names is not a list" in result.err


def test_several_srdf_files(make) -> None:
    _, folder = make(ARM)
    (folder / "config/robot.srdf").rename(folder / "config/a.srdf")
    (folder / "config/b.srdf").write_text("<robot name='robot'/>")
    result, _ = make(ARM)
    assert result.code == 2
    assert "several SRDF files (a.srdf, b.srdf)" in result.err


def test_srdf_that_is_none(make) -> None:
    _, folder = make(ARM)
    (folder / "config/robot.srdf").write_text("<sdf/>")
    result, _ = make(ARM)
    assert result.code == 2
    assert "robot.srdf:1:1: the root element is <sdf>" in result.err


def test_folder_that_is_a_file(make, write) -> None:
    write("moveit_config", "text")
    result, _ = make(ARM)
    assert result.code == 2
    assert Path("moveit_config").read_text() == "text"


def test_group_that_the_existing_srdf_lacks(make) -> None:
    _, folder = make(ARM)
    result, _ = make(ARM, "--group", "other=base:l2")
    assert result.code == 0, result.err
    groups = load_package(folder).semantic.list_children("group")
    assert [group.get("name") for group in groups] == ["arm", "other"]


def test_group_of_a_name_that_the_existing_srdf_has(make) -> None:
    _, folder = make(ARM)
    before = read_all(folder)
    result, _ = make(ARM, "--group", "arm=base:l2")
    assert result.code == 2
    assert "has a group 'arm' that is not the chain from 'base' to 'l2'" in result.err
    assert read_all(folder) == before


def test_robot_of_another_format(urdftool, write) -> None:
    pytest.importorskip("mujoco")
    path = write(
        "arm.xml", "<mujoco><worldbody><body><joint/><geom size='1'/></body></worldbody></mujoco>"
    )
    result = urdftool("srdf", path, "--moveit", "out")
    assert result.code == 2
    assert "urdftool export urdf" in result.err
    assert not Path("out").exists()


def test_output_and_package(make) -> None:
    result, _ = make(ARM, "-o", "arm.srdf")
    assert result.code == 2
    assert "leave out --output" in result.err


def test_description_outside_of_packages(urdftool, write) -> None:
    path = write("somewhere/robot.urdf", write_urdf(ARM))
    result = urdftool("srdf", path, "--moveit", "out/my config")
    assert result.code == 0, result.err
    assert "is in no ROS package" in result.err
    assert "<name>my_config</name>" in Path("out/my config/package.xml").read_text()
