import csv
import hashlib
import shutil
import subprocess

import pytest

from tests.conftest import CORPUS, FIXTURES
from tests.graph.robots import HOSTILE, hostile_text, robot, tree
from urdftool.errors import XmlError
from urdftool.graph.dot import to_dot
from urdftool.graph.ros import make_ros_figure
from urdftool.model.load import load, make_robot
from urdftool.source.description import read_description
from urdftool.source.document import read_file
from urdftool.source.well_formed import repair

EXPECTED = FIXTURES / "graph"
ROBOTS = {path.stem: path for path in (FIXTURES / "robots").rglob("*.urdf")}
TOOL = shutil.which("urdf_to_graphviz")


def dot(model):
    return to_dot(make_ros_figure(model))


def theirs(path, folder):
    """What the tool of ROS writes; no dot is on its path, as only the text counts."""
    subprocess.run(
        [TOOL, str(path), "theirs"], cwd=folder, env={"PATH": ""}, capture_output=True, check=False
    )
    return (folder / "theirs.gv").read_bytes()


@pytest.mark.parametrize("expected", sorted(EXPECTED.glob("*.gv")), ids=lambda path: path.stem)
def test_the_text_is_that_of_urdf_to_graphiz(expected):
    assert dot(load(ROBOTS[expected.stem])) == expected.read_text("utf-8")


@pytest.mark.program("urdf_to_graphviz")
@pytest.mark.parametrize("name", sorted(path.stem for path in EXPECTED.glob("*.gv")))
def test_the_kept_text_is_what_the_tool_writes(name, tmp_path):
    assert theirs(ROBOTS[name], tmp_path) == (EXPECTED / f"{name}.gv").read_bytes()


TURNED = """<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="fixed"><parent link="a"/><child link="b"/>
<origin xyz="0.1 -1e-7 1234567.5" rpy="{}"/></joint></robot>"""


@pytest.mark.program("urdf_to_graphviz")
@pytest.mark.parametrize(
    "rpy", ["0 0 0", "3.14159265 1.5707963 0.3", "1 -1.5707963267948966 2", "4 5 6", "-0 1e-9 0"]
)
def test_angles_come_back_as_urdfdom_has_them(rpy, tmp_path, write):
    path = write("turned.urdf", TURNED.format(rpy))
    assert dot(load(path)).encode() == theirs(tmp_path / path, tmp_path)


@pytest.mark.program("urdf_to_graphviz")
def test_a_joint_named_as_a_link_is_one_node_as_there(tmp_path, write):
    text = '<robot name="r"><link name="a"/><link name="b"/><joint name="b" type="fixed">'
    path = write("clash.urdf", f'{text}<parent link="a"/><child link="b"/></joint></robot>')
    assert dot(load(path)).encode() == theirs(tmp_path / path, tmp_path)


@pytest.mark.corpus
@pytest.mark.parametrize("step", [8, pytest.param(1, marks=pytest.mark.slow)])
def test_the_text_is_the_same_for_every_robot_of_the_corpus(step):
    different = []
    with open(EXPECTED / "corpus.tsv") as table:
        rows = list(csv.DictReader(table, delimiter="\t"))
    for row in rows[::step]:
        words = (row["xacro_args"] or "").split()
        arguments = {name: value for name, _, value in (word.partition(":=") for word in words)}
        digest = hashlib.sha256(dot(lax(CORPUS / row["path"], arguments)).encode()).hexdigest()
        if digest != row["sha256"]:
            different.append(row["path"])
    assert len(rows) > 100
    assert different == []


def lax(path, arguments):
    """As the command reads it: what ROS reads all the same is passed over."""
    try:
        return make_robot(read_description(path, arguments))
    except XmlError:
        return make_robot(read_description(path, arguments, file=repair(read_file(path))))


def test_children_come_in_the_order_of_their_joints_bytes():
    figure = make_ros_figure(tree("abcd", [("z", "a", "b"), ("é", "a", "c"), ("B", "a", "d")]))
    assert [node.name for node in figure.list_nodes("link")] == ["a", "d", "b", "c"]


def test_quaternions_count_since_version_1_1():
    text = TURNED.format("0 0 0").replace("rpy=", 'quat_xyzw="0 0 1 0" rpy=')
    assert "rpy: 0 -0 0" in dot(robot(text))
    assert "rpy: 0 -0 3.14159" in dot(robot(text.replace('name="r"', 'name="r" version="1.1"', 1)))


def test_names_are_quoted():
    text = dot(robot(hostile_text(HOSTILE)))
    assert '"a \\"q\\" b" [label="a \\"q\\" b"];' in text
    assert '"tail\\\\" [label="tail\\\\"];' in text
    assert text.count("\n") == 4 + len(HOSTILE) * 3 - 2 + sum(
        1 for line in text.splitlines() if line.startswith('"j ') and "label" in line
    )
