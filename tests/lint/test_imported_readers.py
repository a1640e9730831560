"""Findings that concern no reader which the Python code of a project imports."""

import json

import pytest

from urdftool.api.lint import check
from urdftool.dependencies import compute_answer
from urdftool.lint.imported_readers import Use, find_imported_readers
from urdftool.source.description import read_description
from urdftool.workspace import Workspace

ROBOT = """<robot name="cart">
  <link name="hand">
    <inertial>
      <mass value="1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    </inertial>
    <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
  </link>
  <link name="finger">
    <inertial>
      <mass value="1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    </inertial>
    <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
  </link>
  <joint name="turn" type="revolute">
    <parent link="hand"/><child link="finger"/><origin xyz="0 0 1"/>
    <limit lower="0" upper="0.04" effort="20" velocity="0.2"/>
  </joint>
</robot>
"""

INFOS = """[lint.severity]
dae-as-collision = "info"
unprefixed-hardware-interface = "info"
"""  # infos of these rules are off by default


def _names(tmp_path, code, mark="setup.py", robot=ROBOT, **options):
    (tmp_path / mark).write_text("")
    (tmp_path / "urdftool.toml").write_text(INFOS)
    (tmp_path / "env.py").write_text(code)
    folder = tmp_path / "data"
    folder.mkdir(exist_ok=True)
    (folder / "cart.urdf").write_text(robot)
    return {finding.code for finding in check(folder / "cart.urdf", **options)}


@pytest.mark.parametrize(
    ("code", "reported"),
    [
        ("", True),
        ("import pybullet as p\n", False),
        ("    from ikpy.chain import Chain\n", False),
        ("import pybullet\nimport mujoco\n", True),
        ("import pybullet\nimport isaacgym\n", True),
        ("import pybullet\nflags = pybullet.URDF_USE_INERTIA_FROM_FILE\n", True),
        ("import pybullet as p\np.loadURDF('cart.urdf', flags=2)\n", True),
        ("import pybullet as p\nother(flags = 1,\n  a=2)\n", False),
        ("# import pybullet\n", True),
    ],
)
def test_an_inertia_that_no_reader_of_the_project_takes_is_off(tmp_path, code, reported):
    assert ("placeholder-inertia" in _names(tmp_path, code)) is reported


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("b.py", "import os, mujoco\n"),
        ("b.py", "import os, \\\n    mujoco\n"),
        ("b.py", "if True: import pydrake\n"),
        ("b.py", "\ufeffimport mujoco\n"),
        ("b.py", 'importlib.import_module("mujoco")\n'),
        ("b.py", "import gymnasium_robotics\n"),
        ("b.ipynb", '{"source": ["import mujoco\\n"]}'),
        ("run", "#!/usr/bin/env python3\nimport mujoco\n"),
        ("requirements.txt", "mujoco>=3\n"),
        ("pyproject.toml", '[project]\ndependencies = ["mujoco"]\n'),
        ("b.py", "from omni.isaac import core\n"),
        ("b.py", "#" * (5 << 20)),
    ],
)
def test_what_names_another_reader_counts_as_use(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    assert "placeholder-inertia" in _names(tmp_path, "import pybullet\n")


def test_it_is_reported_if_its_rule_or_a_reader_is_named(tmp_path):
    code = "import pybullet\n"
    assert "placeholder-inertia" in _names(tmp_path, code, targets=["mujoco"])
    assert "placeholder-inertia" in _names(tmp_path, code, select=["placeholder-inertia"])


def test_code_of_a_folder_that_is_no_package_says_nothing(tmp_path):
    assert "placeholder-inertia" in _names(tmp_path, "import pybullet\n", mark="other.txt")


@pytest.mark.parametrize(
    ("code", "reported"),
    [
        ("", True),
        ("import pybullet\n", False),
        ("import pybullet as p\np.loadURDF('cart.urdf', flags=2)\n", True),
        ("import pinocchio\n", False),
        ("import pinocchio\npinocchio.rnea(model, data, q, v, a)\n", True),
        ("import mujoco\n", True),
    ],
)
def test_an_error_stays_where_a_reader_of_the_project_takes_the_inertia(tmp_path, code, reported):
    robot = ROBOT.replace('ixx="1"', 'ixx="9"')
    assert ("inertia-triangle-inequality" in _names(tmp_path, code, robot=robot)) is reported


def test_inertias_of_a_marker_are_off_and_those_of_a_single_body_are_not(tmp_path):
    robot = ROBOT.replace('type="revolute"', 'type="fixed"')
    assert "placeholder-inertia" in _names(tmp_path, "", robot=robot)  # such as a drone
    robot = robot.replace("collision>", "visual>")
    assert "placeholder-inertia" not in _names(tmp_path, "", robot=robot)
    robot = robot.replace('ixx="1"', 'ixx="9"')
    assert "inertia-triangle-inequality" in _names(tmp_path, "", robot=robot)


@pytest.mark.parametrize("variants", ["", '[[lint.variants]]\nfile = "data/cart.urdf"\n' * 2])
def test_the_last_lines_count_what_is_left_out(tmp_path, urdftool, variants):
    _names(tmp_path, "import pybullet\n")
    (tmp_path / "urdftool.toml").write_text(variants)
    for _ in ("first", "from the cache"):
        result = urdftool("lint", tmp_path, "--format", "json")
        left_out = json.loads(result.out)["summary"]["for_other_readers"]
        assert left_out["placeholder-inertia"] >= 1
        total = sum(left_out.values())
        assert f"{total} finding" in result.err
        assert "--extend-select pedantic shows" in result.err
    shown = urdftool("lint", tmp_path, "--format", "json", "--extend-select", "pedantic")
    assert "left out" not in shown.err
    summary = json.loads(shown.out)["summary"]
    assert "for_other_readers" not in summary
    codes = [finding["rule"] for finding in json.loads(shown.out)["findings"]]
    assert left_out.keys() <= set(codes)


def test_the_folder_of_an_installed_package_is_known_by_its_metadata(tmp_path):
    module = tmp_path / "gym"
    module.mkdir()
    (module / "env.py").write_text("import pybullet\n")
    (tmp_path / "gym-1.0.dist-info").mkdir()
    (module / "cart.urdf").write_text(ROBOT)
    assert "placeholder-inertia" in {one.code for one in check(module / "cart.urdf")}
    (module / "__init__.py").write_text("")
    assert "placeholder-inertia" not in {one.code for one in check(module / "cart.urdf")}


def test_a_report_does_not_depend_on_the_folders_above(tmp_path):
    folder = tmp_path / "data"
    folder.mkdir()
    (folder / "cart.urdf").write_text(ROBOT)
    view = Workspace().with_record()
    description = read_description(folder / "cart.urdf", workspace=view)
    before = set(view.dependencies.stamps)
    assert find_imported_readers(description, frozenset()) is None
    asked = set(view.dependencies.stamps) - before
    assert not [path for kind, path in asked if kind == "list"]


def _find_readers(robot):
    view = Workspace().with_record()
    found = find_imported_readers(read_description(robot, workspace=view), frozenset())
    return found, [one for one in view.dependencies.stamps if one[0] == "code"]


def test_only_code_of_the_project_makes_a_report_old(tmp_path):
    _names(tmp_path, "import pybullet\n")
    robot = tmp_path / "data" / "cart.urdf"
    found, asked = _find_readers(robot)
    assert found == Use(frozenset(("pybullet",)), frozenset(("pybullet",)))
    before = [compute_answer(one) for one in asked]
    for name in (".cache/a.py", "__pycache__/env.pyc", "build/b.py", "data/report.json"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("import mujoco\n")
    assert _find_readers(robot) == (found, asked)
    assert [compute_answer(one) for one in asked] == before
    (tmp_path / "data" / "more.py").write_text("import mujoco\n")
    assert [compute_answer(one) for one in asked] != before
    assert _find_readers(robot)[0].readers == {"pybullet", "mujoco"}


def test_code_of_a_virtual_environment_says_nothing(tmp_path):
    _names(tmp_path, "import pybullet\n")
    (tmp_path / "env").mkdir()
    (tmp_path / "env" / "pyvenv.cfg").write_text("")
    (tmp_path / "env" / "tool.py").write_text("import isaacgym\n")
    assert _find_readers(tmp_path / "data" / "cart.urdf")[0].readers == {"pybullet"}


LEFT = """<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
<joint name="turn"><hardwareInterface>PositionJointInterface</hardwareInterface></joint>
<actuator name="m"/></transmission><gazebo reference="gone"><mu1>1</mu1></gazebo>
<gazebo><plugin name="control" filename="libgazebo_ros_control.so"/></gazebo>
"""


@pytest.mark.parametrize(
    ("code", "mark", "reported"),
    [
        ("import pybullet\n", "setup.py", False),
        ("", "setup.py", True),
        ("import pybullet\nimport rospy\n", "setup.py", True),
        ("import pybullet\n", "package.xml", True),
    ],
)
def test_leftovers_of_ros_in_a_package_for_another_engine(tmp_path, code, mark, reported):
    robot = ROBOT.replace("</robot>", f"{LEFT}</robot>")
    if mark == "package.xml":
        (tmp_path / "setup.py").write_text("")
        (tmp_path / mark).write_text("<package><name>cart</name></package>")
        mark = "other.txt"
    names = _names(tmp_path, code, mark, robot)
    assert ("unprefixed-hardware-interface" in names) is reported
    assert ("dangling-reference" in names) is reported


@pytest.mark.parametrize(
    ("manifest", "reported"),
    [
        ("<package><name>hpp_cart</name></package>", False),
        ("<package><name>cart</name><depend>hpp-manipulation</depend></package>", False),
        ("<package><name>cart</name><!-- <depend>hpp-manipulation</depend> --></package>", True),
        ("<package><name>hppy</name><depend>coal</depend></package>", True),
    ],
)
def test_a_planner_uses_no_inertia_and_no_gazebo(tmp_path, manifest, reported):
    (tmp_path / "package.xml").write_text(manifest)
    robot = ROBOT.replace("</robot>", f"{LEFT}</robot>").replace('upper="0.04"', 'upper="-1"')
    names = _names(tmp_path, "", "other.txt", robot)
    assert ("placeholder-inertia" in names) is reported
    assert ("dangling-reference" in names) is reported
    assert "lower-above-upper" in names


@pytest.mark.parametrize(("code", "reported"), [("import pybullet", False), ("", True)])
@pytest.mark.parametrize("flag", ["", "flags = pybullet.URDF_USE_INERTIA_FROM_FILE"])
def test_a_remark_about_another_engine_is_off_whatever_pybullet_does_with_inertias(
    tmp_path, code, flag, reported
):
    shape = '<geometry><mesh filename="a.dae"/></geometry>'
    robot = ROBOT.replace('<geometry><box size="0.1 0.1 0.1"/></geometry>', shape)
    names = _names(tmp_path, f"{code}\n{flag}\n", robot=robot)
    assert ("dae-as-collision" in names) is reported


@pytest.mark.parametrize(("package", "used"), [("gazebo_ros", False), ("rviz", True)])
def test_a_launch_file_that_starts_gazebo_counts_beside_python_code(tmp_path, package, used):
    (tmp_path / "launch").mkdir()
    text = f'<launch><include file="$(find {package})/launch/a.launch"/></launch>'
    (tmp_path / "launch" / "a.launch").write_text(text)
    (tmp_path / "setup.py").write_text("import pybullet\n")
    path = tmp_path / "cart.urdf"
    path.write_text(ROBOT)
    assert (find_imported_readers(read_description(path), frozenset()) is not None) is used
