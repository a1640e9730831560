"""The command: what is written where, what is said, and the exit codes."""

import json

import pytest

from tests.conftest import ROOT

from .goldens import FOLDER
from .robots import BOX, INERTIAL, joint, link, robot

ARM = FOLDER / "arm.urdf"


def files(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


def test_a_folder(urdftool, tmp_path):
    result = urdftool("export", "mjcf", ARM, "-o", tmp_path / "out", "--scene")
    assert result.code == 0
    assert result.out == ""
    assert files(tmp_path) == ["out/arm.xml", "out/scene.xml"]


def test_one_file(urdftool, tmp_path):
    assert urdftool("export", "mjcf", ARM, "-o", tmp_path / "x.mjcf", "--scene").code == 0
    assert files(tmp_path) == ["x.mjcf", "x_scene.xml"]
    assert b'<include file="x.mjcf"/>' in (tmp_path / "x_scene.xml").read_bytes()


def test_standard_output(urdftool):
    result = urdftool("export", "mjcf", ARM)
    assert result.code == 0
    assert result.out.startswith("<!-- Exported by urdftool")


def test_again_into_the_same_folder(urdftool, tmp_path):
    for _ in range(2):
        assert urdftool("export", "mjcf", ARM, "-o", tmp_path / "out").code == 0
    (tmp_path / "out" / "notes.txt").write_text("mine")
    assert urdftool("export", "mjcf", ARM, "-o", tmp_path / "out", "--scene").code == 0
    assert files(tmp_path) == ["out/arm.xml", "out/notes.txt", "out/scene.xml"]


def test_a_folder_that_is_not_ours(urdftool, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "notes.txt").write_text("mine")
    result = urdftool("export", "mjcf", ARM, "-o", tmp_path / "out")
    assert result.code == 2
    assert "--overwrite" in result.err
    assert files(tmp_path) == ["out/notes.txt"]
    assert urdftool("export", "mjcf", ARM, "-o", tmp_path / "out", "--overwrite").code == 0
    assert files(tmp_path) == ["out/arm.xml", "out/notes.txt"]


def test_an_edited_model_is_kept(urdftool, tmp_path):
    urdftool("export", "mjcf", ARM, "-o", tmp_path / "out")
    model = tmp_path / "out" / "arm.xml"
    model.write_text(model.read_text().replace('kp="2400"', 'kp="900"'))
    result = urdftool("export", "mjcf", ARM, "-o", tmp_path / "out")
    assert result.code == 2
    assert "was edited" in result.err
    assert 'kp="900"' in model.read_text()


def test_an_input_is_not_overwritten(urdftool, write):
    path = write("r.xml", robot(link("a")))
    result = urdftool("export", "mjcf", path, "-o", path, "--overwrite")
    assert result.code == 2
    assert "is an input of the export" in result.err


def test_defects_one_line_each(urdftool, write, tmp_path):
    mesh = '<visual><geometry><mesh filename="x.stl"/></geometry></visual>'
    bad = joint("j", "a", "b", inside='<axis xyz="0 0 0"/><limit lower="0" upper="1"/>')
    path = write("r.urdf", robot("", link("a"), "", link("b", mesh), bad))
    result = urdftool("export", "mjcf", path, "-o", tmp_path / "out")
    assert result.code == 2
    lines = result.err.splitlines()
    assert [line.rpartition("[")[2] for line in lines[:2]] == ["zero-axis]", "mesh-not-found]"]
    assert lines[0].startswith("r.urdf:5:")
    assert lines[2] == "urdftool: no file was written: 2 errors"
    assert not (tmp_path / "out").exists()
    assert urdftool("export", "mjcf", path, "-o", tmp_path / "out", "--force").code == 0


def test_two_roots_cannot_be_forced(urdftool, write, tmp_path):
    path = write("r.urdf", robot(link("a"), link("b")))
    assert urdftool("export", "mjcf", path, "-o", tmp_path / "out", "--force").code == 2


def test_strict(urdftool, tmp_path):
    rover = FOLDER / "rover.urdf"
    result = urdftool("export", "mjcf", rover, "-o", tmp_path / "out", "--strict")
    assert result.code == 2
    assert "error: friction of 'left_wheel'" in result.err
    assert urdftool("export", "mjcf", ARM, "-o", tmp_path / "out", "--strict").code == 0


def test_json(urdftool, tmp_path):
    result = urdftool("export", "mjcf", ARM, "-o", tmp_path / "out", "--format", "json")
    report = json.loads(result.out)
    jsonschema = pytest.importorskip("jsonschema")
    jsonschema.validate(report, json.loads((ROOT / "docs" / "schemas" / "export.json").read_text()))
    assert report["version"] == 1
    assert report["files"] == ["arm.xml"]
    moved = next(f for f in report["findings"] if f["rule"] == "lossy-inertia-moved")
    assert moved["element"] == {"kind": "link", "name": "sensor_plate"}
    assert moved["line"] == 13


def test_verify_prints_a_table(urdftool, tmp_path):
    pytest.importorskip("mujoco")
    result = urdftool("export", "mjcf", ARM, "-o", tmp_path / "out", "--verify")
    assert result.code == 0
    *rows, rest = result.out.splitlines()[2:]
    table = [line for line in rows if line.endswith(("equal", "none", "differs", "announced"))]
    assert len(table) > 20
    other = [line.split("  ")[0] for line in table if not line.endswith(("equal", "none"))]
    assert other == ["joint physics", "actuators", "contact pairs", "configurations", "runs"]
    assert "runs: announced: 1 motor without a servo got the torque" in result.out
    assert "joint physics: announced: stiffness of stops added at 1 of 5 joints" in result.out
    assert rest.startswith("not compared: ")


@pytest.mark.parametrize("folder", ["/tmp/x", "../x"])
def test_mesh_dir_is_beside_the_model(urdftool, tmp_path, folder):
    result = urdftool("export", "mjcf", ARM, "-o", tmp_path / "out", "--mesh-dir", folder)
    assert result.code == 2


def test_a_chain_too_deep_for_mujoco(urdftool, write, tmp_path):
    links = [link(f"l{i}") for i in range(600)]
    joints = [joint(f"j{i}", f"l{i}", f"l{i + 1}", "continuous", "") for i in range(599)]
    path = write("r.urdf", robot(*links, *joints))
    result = urdftool("export", "mjcf", path, "-o", tmp_path / "out")
    assert result.code == 2
    assert "[too-deep]" in result.err


def test_hostile_names(urdftool, write, tmp_path):
    name = "../../etc/&lt;x&gt;--&quot;"
    text = robot(
        link("base"),
        link("a", f'{INERTIAL}<visual name="--&gt;">{BOX}</visual>'),
        joint("j--", "base", "a", inside=""),
        name=name,
    )
    result = urdftool("export", "mjcf", write("r.urdf", text), "-o", tmp_path / "out")
    assert result.code == 0
    assert [name for name in files(tmp_path) if name.startswith("out")] == ["out/etc_x.xml"]
