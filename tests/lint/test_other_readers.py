"""Targets, findings and effects of descriptions in Python projects, by what their code imports."""

import json

import pytest

from tests.lint.test_imported_readers import LEFT, ROBOT
from urdftool.api.lint import check

CONTROL = """<ros2_control name="c" type="system"><hardware><plugin>gone/Gone</plugin></hardware>
<joint name="gone"><command_interface name="position"/></joint></ros2_control>
"""
SRDF = """<robot name="other"><disable_collisions link1="hand" link2="gone" reason="Never"/></robot>
"""


def _show_infos(folder, rule):
    """Show the infos of a rule whose infos are off by default."""
    (folder / "urdftool.toml").write_text(f'[lint.severity]\n{rule} = "info"\n')


def _make_project(tmp_path, code, robot=ROBOT, srdf=""):
    """Make an installed package with a robot in a folder of its module, and return its path."""
    module = tmp_path / "planner"
    folder = module / "data"
    folder.mkdir(parents=True)
    (tmp_path / "planner-1.0.dist-info").mkdir()
    (module / "__init__.py").write_text("")
    (module / "env.py").write_text(code)
    (folder / "cart.urdf").write_text(robot)
    if srdf:
        (folder / "cart.srdf").write_text(srdf)
    return folder / "cart.urdf"


def _codes(path, **options):
    return {finding.code for finding in check(path, **options)}


@pytest.mark.parametrize(
    ("code", "is_for_moveit"),
    [
        ("", True),
        ("import pybullet\n", False),
        ("import pybullet\nimport moveit_commander\n", True),
    ],
)
def test_an_srdf_beside_a_file_is_for_moveit_unless_the_project_imports_other_readers(
    tmp_path, code, is_for_moveit
):
    path = _make_project(tmp_path, code, srdf=SRDF)
    codes = _codes(path)
    assert ("srdf-unknown-link" in codes) is is_for_moveit
    assert ("srdf-robot-name" in codes) is is_for_moveit


@pytest.mark.parametrize(
    ("camera", "is_for_moveit"),
    [
        ("import rclpy\n", False),
        ("import rclpy\npath = 'cart.urdf'\n", True),
        ("import rclpy\nnode.declare_parameter('robot_description')\n", True),
    ],
)
def test_ros_counts_only_where_its_code_may_read_descriptions(tmp_path, camera, is_for_moveit):
    path = _make_project(tmp_path, "import pybullet\nload('cart.urdf')\n", srdf=SRDF)
    code = path.parent.parent
    (code / "camera.py").write_text(camera)
    (code / "show.ipynb").write_text("import rclpy  # urdf" + " " * (5 << 20))
    assert ("srdf-unknown-link" in _codes(path)) is is_for_moveit
    (code / "env.py").write_text("import pybullet\n")  # nothing shows who reads the description
    assert "srdf-unknown-link" in _codes(path)


@pytest.mark.parametrize(("code", "is_for_ros"), [("", True), ("import mujoco\n", False)])
def test_the_package_of_a_copied_description_is_a_leftover(tmp_path, code, is_for_ros):
    robot = ROBOT.replace("</robot>", f"{LEFT}{CONTROL}</robot>")
    path = _make_project(tmp_path, code, robot)
    manifest = "<package><name>cart</name><depend>gazebo_ros</depend>{}</package>"
    build = "<export><build_type>ament_cmake</build_type></export>"
    (path.parent / "package.xml").write_text(manifest.format(build))
    codes = _codes(path)
    assert ("ros2-control-unknown-joint" in codes) is is_for_ros
    assert ("dangling-reference" in codes) is is_for_ros


def test_why_a_target_does_not_count_is_explained(tmp_path, urdftool):
    path = _make_project(tmp_path, "import pybullet\n", srdf=SRDF)
    text = urdftool("lint", "--explain-targets", path).out
    assert "does not count: the project uses pybullet" in text.replace("\n", " ")


def test_effects_are_those_on_the_readers_of_the_project(tmp_path, urdftool):
    robot = ROBOT.replace("<collision>", '<visual><geometry><sphere radius="1"/></geometry>'
                          '<material name="grey"/></visual><collision>', 1)  # fmt: skip
    path = _make_project(tmp_path, "import pybullet\n", robot)

    def read(*words):
        found = json.loads(urdftool("lint", path, "--format", "json", *words).out)["findings"]
        (one,) = [finding for finding in found if finding["rule"] == "undefined-material"]
        return one["effects"]

    assert set(read()) == {"pybullet"}
    assert {"urdfdom", "rviz", "pybullet"} <= set(read("--target", "ros2"))


@pytest.mark.parametrize(
    ("code", "reported"),
    [
        ("", True),
        ("import pybullet\n", True),
        ("import yourdfpy\n", False),
        ("import ikpy\n", False),
        ("import mujoco\n", True),
    ],
)
def test_an_error_is_one_of_a_reader_that_the_project_uses(tmp_path, code, reported):
    limit = '<limit lower="0" upper="0.04" effort="20" velocity="0.2"/>'
    robot = ROBOT.replace(limit, "")
    path = _make_project(tmp_path, code, robot)
    assert ("missing-limit" in _codes(path)) is reported
    path.write_text(robot.replace('child link="finger"', 'child link="gone"'))
    assert "unknown-child-link" in _codes(path)


CAPSULE = '<capsule radius="0.05" length="0.1"/>'


@pytest.mark.parametrize(
    ("code", "severity"), [("import newton\n", None), ("import pinocchio\n", "error")]
)
def test_a_capsule_is_an_error_where_a_reader_of_the_project_drops_it(tmp_path, code, severity):
    robot = ROBOT.replace('<box size="0.1 0.1 0.1"/>', CAPSULE)
    path = _make_project(tmp_path, code, robot)
    found = [one for one in check(path) if one.code == "feature-needs-newer-version"]
    assert {one.severity.label for one in found} == ({severity} if severity else set())


@pytest.mark.parametrize(
    ("code", "reported"),
    [
        ("import pybullet\nclient.resetJointState(0, 1, 2)\n", False),
        ("import pybullet\nclient.resetJointState(0, 1, 2)\nimport gymnasium\n", False),
        ("import pybullet, gym\np.resetJointState(0, 1, 2)\np.stepSimulation()\n", True),
        ("import pybullet\nclient.resetJointState(0, 1, 2)\nclient.stepSimulation()\n", False),
        ("import pybullet\nclient.setJointMotorControl2(0, 1, 2)\n", True),
    ],
)
def test_a_planner_has_no_drives(tmp_path, code, reported):
    path = _make_project(tmp_path, code, ROBOT.replace('effort="20"', 'effort="20000"'))
    _show_infos(tmp_path, "implausible-effort")
    assert ("implausible-effort" in _codes(path)) is reported


@pytest.mark.parametrize(("mentions", "reported"), [("", False), ("path = 'a.urdf'", True)])
def test_mujoco_reads_urdf_only_if_its_code_mentions_it(tmp_path, mentions, reported):
    robot = ROBOT.replace('<box size="0.1 0.1 0.1"/>', '<mesh filename="a.dae"/>')
    path = _make_project(tmp_path, "import pybullet\npybullet.loadURDF('a.urdf')\n", robot)
    (path.parent.parent / "other.py").write_text(f"import mujoco\n{mentions}\n")
    _show_infos(tmp_path, "dae-as-collision")
    assert ("dae-as-collision" in _codes(path)) is reported


@pytest.mark.parametrize(
    ("code", "severity"),
    [("", "error"), ("import pydrake\nSimulator(d)\n", "warning"), ("import pybullet\n", "error")],
)
def test_what_all_readers_of_the_project_take_as_written_is_no_error(tmp_path, code, severity):
    limit = '<limit lower="0" upper="0.04" effort="20" velocity="0.2"/>'
    path = _make_project(tmp_path, code, ROBOT.replace(limit, ""))
    found = {one.severity.label for one in check(path) if one.code == "missing-limit"}
    assert found == {severity}
