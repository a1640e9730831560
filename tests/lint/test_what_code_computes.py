"""Which readers a project computes dynamics with, by the names that its code calls."""

import json

import pytest

from tests.lint.test_imported_readers import ROBOT
from urdftool.api.lint import check
from urdftool.lint.called_names import list_names
from urdftool.lint.imported_readers import find_imported_readers
from urdftool.lint.libraries import CHAIN, OWN, PLANNER, SCENE, TESSERACT
from urdftool.source.description import read_description


def _find_use(tmp_path, code, name="env.py", ending="urdf"):
    (tmp_path / "setup.py").write_text("")
    (tmp_path / name).write_text(code)
    path = tmp_path / "cart.urdf"
    path.write_text(ROBOT)
    description = read_description(path)
    description.path = str(tmp_path / f"cart.{ending}")
    return find_imported_readers(description, frozenset())


MUJOCO = "import mujoco\nmujoco.mj_forward(model, data)  # urdf\n"


@pytest.mark.parametrize(
    ("code", "moving"),
    [
        (MUJOCO, set()),
        ("import mujoco\n", {"mujoco"}),
        (f"{MUJOCO}mujoco.mj_step(model, data)\n", {"mujoco"}),
        (f"{MUJOCO}from mujoco import mj_step as step\nstep(model, data)\n", {"mujoco"}),
        (f"{MUJOCO}run = getattr(mujoco, 'mj_step')\n", {"mujoco"}),
        (f"{MUJOCO}mujoco.viewer.launch(model)\n", {"mujoco"}),
        (f"{MUJOCO}mujoco.viewer.launch_passive(model, data)\nplaywright.launch()\n", set()),
        (f'{MUJOCO}# mj_step\n"""This does not call mj_step."""\n', set()),
        (f"{MUJOCO}print mj_step\n", {"mujoco"}),  # Python 2
        (f"{MUJOCO}import dm_control\n", {"mujoco"}),
        ("import mink\n", set()),
        ("import pinocchio, pink\npinocchio.forwardKinematics(m, d, q)\n", set()),
        ("import placo\nsolver = placo.KinematicsSolver(robot)\n", set()),
        ("import placo\nsolver = placo.DynamicsSolver(robot)\n", {"pinocchio"}),
        ("import pydrake\nik = InverseKinematics(plant)\n", set()),
        ("import pydrake\nik = InverseKinematics(plant)\nSimulator(diagram)\n", {"drake"}),
        ("import pybullet as p\np.resetJointState(0, 1, 2)\np.stepSimulation()\n", set()),
        ("import pybullet as p\np.resetJointState(0, 1, 2)\nimport sapien\n", None),
        ("import tesseract_robotics\n", set()),
    ],
)
def test_dynamics_are_computed_where_a_call_is_seen_or_nothing_is_known(tmp_path, code, moving):
    use = _find_use(tmp_path, code)
    assert use.moving == moving if moving is not None else "mujoco" in use.moving


def test_a_notebook_calls_what_its_cells_of_code_do(tmp_path):
    def make(*cells):
        cells = [{"cell_type": kind, "source": lines} for kind, lines in cells]
        return json.dumps({"cells": cells})

    _find_use(tmp_path, "import mujoco\n")
    code = ["%pip install mujoco\n", "import mujoco\n", "mujoco.mj_forward(m, d)\n"]
    text = make(("markdown", ["mj_step\n"]), ("code", code))
    assert "mj_forward" in list_names("a.ipynb", text.encode())
    assert _find_use(tmp_path, text, "a.ipynb").moving == set()
    text = make(("code", code), ("code", ["!ls\n", "mujoco.mj_step(m, d)"]))
    assert _find_use(tmp_path, text, "a.ipynb").moving == {"mujoco"}
    assert "mj_step" in list_names("a.ipynb", b'{"mj_step": ')  # no notebook


@pytest.mark.parametrize(
    ("code", "readers"),
    [
        ("import ikpy\n", {CHAIN}),
        ("import yourdfpy\n", {SCENE}),
        ("import pyroki\n", {PLANNER}),
        ("from tesseract_robotics import planning\n", {TESSERACT}),
    ],
)
def test_readers_of_kinematics_by_what_they_take(tmp_path, code, readers):
    use = _find_use(tmp_path, code)
    assert use.readers == readers
    assert not use.moving


@pytest.mark.parametrize(
    ("code", "readers"),
    [
        ("import pydrake, mujoco\n", {"drake"}),
        ("import pybullet\n", {"pybullet"}),
        ("import mujoco\n", None),
        ("import pydrake\nimport rclpy\ntext = 'a.urdf'\n", None),
        ("import pydrake\n# taken from the scenario, and from gz\n", {"drake"}),
    ],
)
def test_a_robot_in_sdf_is_read_by_what_the_code_imports(tmp_path, code, readers):
    use = _find_use(tmp_path, code, ending="sdf")
    assert (use and use.readers) == readers


def test_the_last_lines_count_what_is_about_dynamics(tmp_path, urdftool):
    _find_use(tmp_path, "import pink\nimport pinocchio\n")
    result = urdftool("lint", tmp_path, "--format", "json")
    assert "2 findings left out, about dynamics, which no code here computes; --ext" in result.err
    assert json.loads(result.out)["summary"]["for_other_readers"] == {"placeholder-inertia": 2}


SDF = """<sdf version="1.9"><model name="box"><link name="a"><collision name="c"><geometry>
<box><size>1 1 1</size></box></geometry></collision></link><link name="b"><inertial><mass>1</mass>
<inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial></link>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>
</joint></model></sdf>"""


@pytest.mark.parametrize(
    ("code", "targets"), [("", "gz"), ("import pydrake\n", "none; the project uses drake")]
)
def test_sdf_is_for_the_readers_of_the_project(tmp_path, urdftool, code, targets):
    (tmp_path / "setup.py").write_text("")
    (tmp_path / "env.py").write_text(code)
    (tmp_path / "box.sdf").write_text(SDF)
    result = urdftool("lint", tmp_path / "box.sdf")
    assert f"(targets: {targets})" in result.err
    assert ("error: link 'a' has no <inertial>" in result.out) is (not code)


DIRECTIVES = """directives:
- add_model: {name: floor, file: package://lab/box.sdf}
- add_weld: {parent: table::top, child: floor::a}
- add_model: {name: table, file: package://lab/table.sdf}
- add_weld: {parent: world, child: table::top}
"""


@pytest.mark.parametrize(
    ("name", "text", "reported"),
    [
        ("a.dmd.yaml", DIRECTIVES, False),
        ("a.scenario.yaml", "Lab:\n  " + DIRECTIVES.replace("\n", "\n  "), False),
        ("a.yaml", DIRECTIVES, True),
        ("a.dmd.yaml", DIRECTIVES.replace("parent: world", "parent: arm::hand"), True),
        ("a.dmd.yaml", DIRECTIVES.replace("box.sdf", "ox.sdf"), True),
        (
            "a.dmd.yaml",
            f"{DIRECTIVES}- add_model: {{name: b, file: package://lab/box.sdf}}\n",
            False,
        ),
        (
            "a.dmd.yaml",
            f"{DIRECTIVES}- add_model: {{name: b, file: package://lab/box.sdf, "
            "default_free_body_pose: {a: {}}}\n",
            True,
        ),
        ("a.dmd.yaml", f"{DIRECTIVES}add_model: [", True),
    ],
)
def test_no_inertia_is_used_of_a_link_that_directives_weld(tmp_path, name, text, reported):
    folder = tmp_path / "lab"
    folder.mkdir()
    (tmp_path / "setup.py").write_text("")
    (tmp_path / "env.py").write_text("import pydrake\nSimulator(diagram)\n")
    (folder / "box.sdf").write_text(SDF)
    (folder / name).write_text(text)
    codes = {finding.code for finding in check(folder / "box.sdf")}
    assert ("missing-inertial" in codes) is reported


@pytest.mark.parametrize(("shape", "rejected"), [("drake:ellipsoid", True), ("sphere", False)])
def test_no_effect_is_said_of_readers_that_reject_a_shape_of_drake(tmp_path, shape, rejected):
    path = tmp_path / "cart.urdf"
    path.write_text(ROBOT.replace("<box ", f"<{shape} radius='1' "))
    found = [one for one in check(path) if one.code == "placeholder-inertia"]
    named = {reader for one in found for key in one.effects for reader in key.split(", ")}
    assert "drake" in named
    assert named.isdisjoint({"mujoco", "pybullet"}) is rejected


def test_drake_takes_no_mass_and_no_motor_in_sdf(tmp_path):
    (tmp_path / "setup.py").write_text("")
    path = tmp_path / "box.sdf"
    path.write_text(SDF.replace('"a">', '"a"><inertial><mass>0</mass></inertial>'))
    assert "zero-mass" in {finding.code for finding in check(path)}
    (tmp_path / "env.py").write_text("import pydrake\n")
    assert "zero-mass" not in {finding.code for finding in check(path)}


SRDF = """<robot name="other"><group name="g"><chain base_link="hand" tip_link="gone"/></group>
<disable_collisions link1="hand" link2="nobody" reason="Never"/></robot>"""


def test_an_srdf_of_tesseract_is_checked_for_what_it_names(tmp_path):
    _find_use(tmp_path, "import tesseract_robotics\n")
    (tmp_path / "cart.srdf").write_text(SRDF)
    found = check(tmp_path / "cart.urdf")
    codes = {finding.code for finding in found}
    assert {"srdf-robot-name", "srdf-unknown-link"} <= codes
    assert not codes & {"chain-not-connected", "adjacent-pair-not-disabled"}
    assert not any("moveit" in key for finding in found for key in finding.effects)
    (tmp_path / "env.py").write_text("import pybullet\n")
    assert "srdf-robot-name" not in {finding.code for finding in check(tmp_path / "cart.urdf")}


def test_a_file_with_a_prefix_that_it_does_not_use_is_checked_beside_a_wrong_comment(tmp_path):
    path = tmp_path / "cart.urdf"
    text = ROBOT.replace('"cart"', '"cart" xmlns:xacro="http://www.ros.org/wiki/xacro"')
    path.write_text(text.replace("</robot>", "<!-- a -- b --></robot>"))
    assert {"not-well-formed", "placeholder-inertia"} <= {one.code for one in check(path)}


@pytest.mark.parametrize(
    ("code", "label"),
    [("", "error"), ("import pydrake\n", "warning"), ("import yourdfpy\n", "error")],
)
def test_a_comment_that_all_readers_of_the_project_accept_is_no_error(tmp_path, code, label):
    _find_use(tmp_path, code)
    path = tmp_path / "cart.urdf"
    path.write_text(ROBOT.replace("</robot>", "<!-- a -- b --></robot>"))
    found = [one.severity.label for one in check(path) if one.code == "not-well-formed"]
    assert found == [label]


PARSER = """from xml.etree import ElementTree
for joint in ElementTree.parse("cart.urdf").iter("joint"):
    print(joint)
"""


@pytest.mark.parametrize(
    ("code", "readers"),
    [
        (PARSER, {OWN}),
        (f"{PARSER}# or mujoco\n", {OWN}),
        (f"{PARSER}print(joint.find('inertia'))\n", None),
        (f"{PARSER}import rospy\n", None),
        (f"{PARSER}import ament_index_python\n", {OWN}),
        (PARSER.replace("urdf", "xml"), None),
        (f"{PARSER}import pybullet\n", {"pybullet"}),
    ],
)
def test_code_that_reads_urdf_by_itself_takes_no_inertia_unless_it_names_one(
    tmp_path, code, readers
):
    use = _find_use(tmp_path, code)
    assert (use and use.readers) == readers
    if readers == {OWN}:
        assert not {one.code for one in check(tmp_path / "cart.urdf")} & {"placeholder-inertia"}


def test_models_whose_files_are_missing_with_their_folder_are_one_finding(tmp_path, urdftool):
    pytest.importorskip("mujoco")
    (tmp_path / ".git").mkdir()
    body = '<worldbody><body><geom type="mesh" mesh="m"/></body></worldbody>'
    model = f'<mujoco><asset><mesh name="m" file="{{}}"/></asset>{body}</mujoco>'
    for name in ("a", "b", "c"):
        (tmp_path / f"{name}.xml").write_text(model.format(f"gone/{name}.stl"))
    (tmp_path / "d.xml").write_text(model.format("d.stl"))
    found = json.loads(urdftool("lint", tmp_path, "--format", "json").out)["findings"]
    messages = [one["message"].partition(";")[0] for one in found]
    assert len(found) == 2
    assert messages[0].endswith(
        "gone' does not exist, but 3 models need files in it, first 'a.stl'"
    )
