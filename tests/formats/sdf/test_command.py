"""The command: files, streams, exit codes."""

import json
import os

import pytest

from tests.conftest import FIXTURES
from tests.formats.test_standing_pose import quadruped

from .robots import TWO, gazebo, inertial, link

ROBOT = '<robot name="r">' + "".join(TWO) + "</robot>\n"
ARM = FIXTURES / "formats" / "sdf" / "gripper_arm.urdf"
MIRA = FIXTURES / "robots" / "mira_description" / "urdf" / "mira.urdf"


def test_a_folder(urdftool, write, tmp_path):
    result = urdftool("export", "sdf", write("r.urdf", ROBOT), "-o", "out")
    assert (result.code, result.out) == (0, "")
    assert sorted(os.listdir(tmp_path / "out")) == ["model.config", "model.sdf"]
    assert '<sdf version="1.11">model.sdf</sdf>' in (tmp_path / "out/model.config").read_text()


def test_one_file(urdftool, write, tmp_path):
    assert urdftool("export", "sdf", write("r.urdf", ROBOT), "-o", "r.sdf").code == 0
    assert sorted(os.listdir(tmp_path)) == ["r.sdf", "r.urdf"]


def test_standard_output(urdftool, write):
    result = urdftool("export", "sdf", write("r.urdf", ROBOT))
    assert result.out.startswith('<?xml version="1.0"?>')
    assert result.err == ""


def test_twice_is_the_same(urdftool, write, tmp_path):
    path = write("r.urdf", ROBOT)
    urdftool("export", "sdf", path, "-o", "out")
    first = (tmp_path / "out/model.sdf").read_bytes()
    assert urdftool("export", "sdf", path, "-o", "out").code == 0
    assert (tmp_path / "out/model.sdf").read_bytes() == first


def test_what_is_not_ours_is_left_alone(urdftool, write, tmp_path):
    path = write("r.urdf", ROBOT)
    write("out/model.sdf", "<sdf/>")
    result = urdftool("export", "sdf", path, "-o", "out")
    assert result.code == 2
    assert "--overwrite" in result.err
    assert (tmp_path / "out/model.sdf").read_text() == "<sdf/>"
    assert urdftool("export", "sdf", path, "-o", "out", "--overwrite").code == 0
    model = tmp_path / "out/model.sdf"
    model.write_text(model.read_text().replace('name="r"', 'name="mine"'))
    assert urdftool("export", "sdf", path, "-o", "out").code == 2


def test_an_input_is_never_overwritten(urdftool, write):
    path = write("r.sdf", ROBOT)
    result = urdftool("export", "sdf", path, "-o", path, "--overwrite")
    assert result.code == 2
    assert "input" in result.err


def test_a_defect_writes_nothing(urdftool, write, tmp_path):
    bad = '<robot name="r">' + link("a", inertial(1, (1, 1, 9))) + link("b") + "</robot>"
    result = urdftool("export", "sdf", write("r.urdf", bad), "-o", "out")
    assert result.code == 2
    assert result.err.startswith("r.urdf:1:")
    assert "multiple-roots" in result.err
    assert not (tmp_path / "out").exists()


def test_strict(urdftool, write, tmp_path):
    lossy = '<robot name="r">' + link("a") + gazebo("nothing", "<mu1>1</mu1>") + "</robot>"
    path = write("r.urdf", lossy)
    assert urdftool("export", "sdf", path, "-o", "out", "--strict").code == 2
    assert not (tmp_path / "out").exists()
    result = urdftool("export", "sdf", path, "-o", "out")
    assert result.code == 0
    assert "warning" in result.err
    assert "[dangling-reference]" in result.err


def test_json(urdftool, tmp_path):
    result = urdftool("export", "sdf", ARM, "-o", tmp_path / "arm", "--format", "json", "--verify")
    report = json.loads(result.out)
    assert report["version"] == 1
    assert report["faithful"] is True
    assert {f["rule"] for f in report["findings"]} >= {"lossy-safety", "lossy-calibration"}
    assert all(f["line"] for f in report["findings"])
    assert "frames" in [check["check"] for check in report["checks"]]


def test_verify_prints_a_table(urdftool, tmp_path):
    result = urdftool("export", "sdf", MIRA, "-o", tmp_path / "mira", "--verify")
    assert result.code == 0
    assert "mass matrix" in result.out
    assert "differs" not in result.out


@pytest.mark.parametrize(
    ("options", "uri"),
    [
        ((), "meshes/mira_body.dae"),
        (("--target", "gazebo-classic"), "model://mira/meshes/mira_body.dae"),
        (("--uri", "package"), "package://mira_description/meshes/mira_body.dae"),
        (("--uri", "file"), f"file://{MIRA.parents[1]}/meshes/mira_body.dae"),
        (("--uri", "model"), "model://mira/meshes/mira_body.dae"),
    ],
)
def test_names_of_meshes(urdftool, tmp_path, options, uri):
    result = urdftool("export", "sdf", MIRA, "-o", tmp_path / "mira", "--verify", *options)
    assert result.code == 0, result.out + result.err
    assert f"<uri>{uri}</uri>" in (tmp_path / "mira/model.sdf").read_text()
    copied = (tmp_path / "mira/meshes/mira_body.dae").exists()
    assert copied == (uri.startswith(("meshes", "model")))


def test_meshes_beside_a_file(urdftool, tmp_path):
    result = urdftool("export", "sdf", MIRA, "-o", tmp_path / "m.sdf", "--mesh-dir", "stuff")
    assert result.code == 0
    assert (tmp_path / "stuff" / "mira_body.dae").exists()
    assert "<uri>stuff/mira_body.dae</uri>" in (tmp_path / "m.sdf").read_text()


@pytest.mark.parametrize(
    "options",
    [
        ("--sdf-version", "1.7"),
        ("--target", "gazebo-classic", "--sdf-version", "1.9"),
        ("--mesh-dir", "/tmp"),
        ("--mesh-dir", "../x"),
        ("--target", "unreal"),
    ],
)
def test_wrong_usage(urdftool, write, options):
    result = urdftool("export", "sdf", write("r.urdf", ROBOT), "-o", "out", *options)
    assert result.code == 2
    assert "Traceback" not in result.err


@pytest.mark.parametrize("text", ["", "<robot", "<sdf/>", "<robot/>", "\x00", "<robot name='r'/>"])
def test_what_is_no_robot(urdftool, write, tmp_path, text):
    result = urdftool("export", "sdf", write("r.urdf", text), "-o", "out", "--force")
    assert result.code == 2
    assert not (tmp_path / "out").exists()


def test_a_place_that_is_not_there(urdftool, write):
    result = urdftool("export", "sdf", write("r.urdf", ROBOT), "-o", "r.urdf/out")
    assert result.code == 2
    assert "r.urdf" in result.err


def test_missing_folders_are_made(urdftool, write, tmp_path):
    result = urdftool("export", "sdf", write("r.urdf", ROBOT), "-o", "not/yet/out")
    assert result.code == 0
    assert (tmp_path / "not/yet/out/model.sdf").is_file()


CUBE = """<robot name="c"><link name="a"><inertial><mass value="1"/>
<inertia ixx=".01" ixy="0" ixz="0" iyy=".01" iyz="0" izz=".01"/></inertial>
<collision><origin xyz="0 0 -0.1"/><geometry><box size=".2 .2 .2"/></geometry></collision></link>
<link name="b"><inertial><mass value="1"/>
<inertia ixx=".01" ixy="0" ixz="0" iyy=".01" iyz="0" izz=".01"/></inertial>
<collision><geometry><box size=".1 .1 .1"/></geometry></collision></link>
<link name="m"><inertial><mass value="1"/>
<inertia ixx=".01" ixy="0" ixz="0" iyy=".01" iyz="0" izz=".01"/></inertial></link>
<joint name="j" type="prismatic"><parent link="a"/><child link="m"/><axis xyz="0 0 1"/>
<limit lower="0" upper="1" effort="9" velocity="9"/></joint>
<joint name="k" type="revolute"><parent link="m"/><child link="b"/>
<limit lower="-1" upper="1" effort="9" velocity="9"/></joint>{}</robot>"""


def test_the_start_on_the_ground_is_in_the_world_and_named(urdftool, write, tmp_path):
    path = write("c.urdf", CUBE.format(""))
    done = urdftool(
        *("export", "sdf", path, "-o", "out", "--world", "--verify", "-v", "--base", "free")
    )
    assert done.code == 0
    assert "its root is at z = 0.2 m; world.sdf places it there" in done.err
    assert "<pose>0 0 0.2 0 0 0</pose>" in (tmp_path / "out/world.sdf").read_text()
    assert "0.2 0 0 0" not in (tmp_path / "out/model.sdf").read_text().partition("<collision")[0]
    done = urdftool("export", "sdf", path, "-o", "alone", "-v", "--base", "free")
    assert "spawn it there (-z 0.2)" in done.err
    assert "initial joint positions" not in done.err


def test_a_home_that_sdf_does_not_hold_is_named(urdftool, write):
    done = urdftool("export", "sdf", write("q.urdf", quadruped()), "-o", "out", "-v")
    assert done.code == 0, done.err
    assert "SDF has no initial joint positions" in done.err
    assert "and 5 more" in done.err  # hip and knee of four legs


@pytest.mark.library("mujoco")
def test_links_that_overlap_at_the_start_are_named(urdftool, write):
    collide = "<gazebo><self_collide>true</self_collide></gazebo>"
    done = urdftool("export", "sdf", write("c.urdf", CUBE.format(collide)), "-o", "out")
    assert "2 links overlap at the start, and Gazebo pushes them apart" in done.err
    assert "'a' and 'b'" in done.err or "'b' and 'a'" in done.err
    done = urdftool("export", "sdf", write("d.urdf", CUBE.format("")), "-o", "other")
    assert "overlap" not in done.err


def test_a_world(urdftool, write, tmp_path):
    path = write("r.urdf", ROBOT)
    assert urdftool("export", "sdf", path, "-o", "out", "--world", "--verify").code == 0
    assert "<world " in (tmp_path / "out/world.sdf").read_text()
    assert urdftool("export", "sdf", path, "-o", "w.sdf", "--world", "--verify").code == 0
    assert "<world " in (tmp_path / "w.sdf").read_text()
