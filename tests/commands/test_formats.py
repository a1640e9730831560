"""Commands that take SDF and MJCF as they take URDF."""

import json

import pytest

from tests.conftest import FIXTURES
from tests.formats.defective import joint, link, sdf
from urdftool.formats.detect import format_of
from urdftool.source.location import SourceFile

READERS = FIXTURES / "readers"
FORMATS = FIXTURES / "formats"
MJCF = pytest.param(READERS / "mechanism.xml", id="mjcf", marks=pytest.mark.library("mujoco"))
SDF = pytest.param(READERS / "mechanism.sdf", id="sdf")
BOTH = pytest.mark.parametrize("path", [SDF, MJCF])
ARM = FORMATS / "mjcf" / "arm.xml"


@pytest.mark.parametrize(
    ("text", "name"),
    [
        (b"<robot/>", "urdf"),
        (b"<?xml version='1.0'?>\n<!-- <robot> -->\n<sdf version='1.9'/>", "sdf"),
        (b"\xef\xbb\xbf<mujoco model='a'/>", "mjcf"),
        (b"<mujocoinclude/>", "mjcf"),
        (b"<!DOCTYPE sdf [<!ENTITY a 'b'>]>\n<sdf/>", "sdf"),
        (b"<sdformat/>", "urdf"),
        (b"<!-- no end <sdf/>", "urdf"),
        (b"", "urdf"),
    ],
)
def test_the_format_is_that_of_the_root_element(text, name):
    assert format_of(SourceFile("a.xml", text)).name == name


@BOTH
def test_info(urdftool, path):
    result = urdftool("info", path, "--format", "json")
    assert result.code == 0
    data = json.loads(result.out)
    assert data["name"] == "mechanism"
    assert result.err.count("[unread-") == len(result.err.splitlines())
    assert f"{path}:" in result.err


@BOTH
def test_graph(urdftool, path, tmp_path):
    result = urdftool("graph", path, "-o", "-")
    assert result.code == 0
    assert "closing a loop" in result.out
    assert urdftool("graph", path, "-o", tmp_path / "a.json").code == 0
    nodes = json.loads((tmp_path / "a.json").read_text("utf-8"))["nodes"]
    arm = next(node for node in nodes if node["name"] in ("arm", "wrist"))
    assert arm["line"] > 1
    assert urdftool("graph", path, "-o", tmp_path / "a.dot", "--style", "ros").code == 0


@BOTH
def test_a_robot_equals_itself(urdftool, path):
    result = urdftool("diff", path, path)
    assert (result.code, result.out) == (0, "")


@pytest.mark.library("mujoco")
def test_diff_across_formats(urdftool):
    result = urdftool("diff", ARM.with_suffix(".urdf"), ARM, "--format", "json")
    assert result.code == 1
    every = json.loads(result.out)["changes"]
    joints = [change for change in every if change["element"]["kind"] == "joint"]
    named = sorted(change["element"]["name"] for change in joints)
    # the export keeps limits of velocity in <custom>, and adds a stop beside a servo
    assert named == ["anchor", "sensor_plate_fixed", "shoulder"]
    assert "limit solref" in str(joints)


@BOTH
def test_view(urdftool, path, tmp_path):
    result = urdftool("view", path, "--picture", tmp_path / "a.png", "--size", "60x60")
    assert result.code == 0
    assert (tmp_path / "a.png").stat().st_size > 100


@BOTH
def test_inertia_and_collision_only_read(urdftool, path, tmp_path):
    before = path.read_bytes()
    result = urdftool("inertia", "robot", path)
    assert result.code in (0, 1)
    assert "mechanism" in result.out or "base" in result.out
    assert urdftool("collision", path, "--check").code == 1
    for words in (
        ("inertia", "robot", path, "--write"),
        ("collision", path, "-o", tmp_path / "out.urdf"),
    ):
        refused = urdftool(*words)
        assert refused.code == 2
        assert "requires a URDF or xacro file" in refused.err
    assert not (tmp_path / "out.urdf").exists()
    assert path.read_bytes() == before


@pytest.mark.library("pybullet")
def test_simulate(urdftool):
    result = urdftool("simulate", FORMATS / "sdf" / "gripper_arm.gz.sdf", "--engine", "pybullet")
    assert result.code in (0, 1)
    assert "5.84 kg" in result.out


@BOTH
def test_what_no_engine_simulates_is_refused(urdftool, path):
    result = urdftool("simulate", path)
    assert result.code == 2
    assert f"{path}:" in result.err


def test_a_bad_file_is_one_message(urdftool, write):
    bad = write("bad.sdf", '<sdf version="1.9"><world name="a"/>\n<world name="b"/></sdf>')
    for command in ("info", "graph", "simulate"):
        result = urdftool(command, bad)
        assert result.code == 2
        assert result.err.splitlines()[0].startswith(f"{bad}:2:1: ")


def test_arguments_of_xacro_are_not_used(urdftool):
    result = urdftool("info", FORMATS / "sdf" / "gripper_arm.gz.sdf", "prefix:=a_")
    assert result.code == 0
    assert "prefix" in result.err


def test_inertia_that_no_body_can_have_is_found_with_its_line(urdftool, write):
    text = """<sdf version="1.9"><model name="m">
    <link name="thin"><inertial><mass>1</mass>
    <inertia><ixx>1</ixx><iyy>0.2</iyy><izz>0.1</izz></inertia></inertial></link>
    <link name="negative"><inertial><mass>-1</mass></inertial></link>
    </model></sdf>"""
    result = urdftool("inertia", "robot", write("m.sdf", text), "--format", "json")
    assert result.code == 1
    links = {link["name"]: link for link in json.loads(result.out)["links"]}
    assert [fault["kind"] for fault in links["thin"]["faults"]] == ["triangle"]
    assert links["thin"]["faults"][0]["line"] == 3
    assert links["negative"]["faults"][0]["kind"] == "mass"


@pytest.mark.library("pybullet")
@pytest.mark.parametrize("kind", ["ball", "screw"])
def test_simulate_names_the_joint_that_no_engine_simulates(urdftool, write, kind):
    path = write("m.sdf", sdf(link("a") + link("b") + joint("a", "b", kind=kind)))
    result = urdftool("simulate", path, "--engine", "pybullet")
    assert result.code == 2
    assert result.err.startswith(f"{path}:9:1: joint 'j' is {kind}, which is not simulated")


@pytest.mark.library("pybullet")
def test_simulate_says_that_a_loop_stays_open(urdftool, write):
    three = link("a") + link("b") + link("c") + joint("a", "b") + joint("b", "c", name="k")
    text = sdf(three + joint("a", "c", name="loop"))
    path = write("m.sdf", text)
    result = urdftool("simulate", path, "--engine", "pybullet", "--duration", "0.1")
    assert result.code in (0, 1)
    (warning,) = [line for line in result.err.splitlines() if "stays open" in line]
    line = text[: text.index('<joint name="loop"')].count("\n") + 1
    assert warning.startswith(f"{path}:{line}:1: warning: closed loop 'loop' between links")


@pytest.mark.library("mujoco")
@pytest.mark.library("pybullet")
def test_simulate_says_which_options_of_an_mjcf_it_replaces(urdftool, write):
    text = (
        '<mujoco><option timestep="0.05"><flag contact="disable"/></option><worldbody><body '
        'name="b"><freejoint/><geom type="box" size=".1 .1 .1"/></body></worldbody></mujoco>'
    )
    path = write("m.xml", text)
    result = urdftool("simulate", path, "--engine", "pybullet", "--duration", "0.1")
    assert "not simulated: timestep of <option>, flag contact" in result.err
