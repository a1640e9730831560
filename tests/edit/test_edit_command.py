"""``urdftool edit`` on the command line: files, reports, exit codes, and nothing half written."""

import json
from pathlib import Path

import jsonschema
import pytest

from tests.conftest import ROOT
from tests.edit.robots import ARM, ARM_SRDF, CONTROLLERS, GRIPPER, GRIPPER_SRDF

SCHEMA = json.loads((ROOT / "docs" / "schemas" / "edit.json").read_text())


@pytest.fixture
def files(write):
    write("in/arm.srdf", ARM_SRDF)
    write("in/controllers.yaml", CONTROLLERS)
    write("hand/gripper.srdf", GRIPPER_SRDF)
    return write("in/arm.urdf", ARM), write("hand/gripper.urdf", GRIPPER)


LINES = {
    "prefix": (["l_"], []),
    "merge-fixed": ([], ["--keep", "tip"]),
    "mirror": ([], ["--plane", "yz"]),
    "zero": (["shoulder=0.5", "slide=0.1"], []),
    "sign": (["shoulder"], []),
    "cut": (["camera"], []),
    "round": ([], ["--tolerance", "1e-6"]),
}


@pytest.mark.parametrize("name", LINES)
def test_each_operation_writes_and_verifies(urdftool, files, tmp_path, name):
    operands, options = LINES[name]
    out = tmp_path / "out" / "robot.urdf"
    result = urdftool("edit", name, files[0], *operands, *options, "-o", out)
    assert result.code == 0, result.err
    assert "frames" in result.out
    assert out.exists()
    found = urdftool("verify", files[0], out, "--map", out.with_suffix(".map"))
    assert found.code == 0, found.out


def test_attach_writes_two_correspondences(urdftool, files, tmp_path):
    out = tmp_path / "out" / "robot.urdf"
    mount = ["--to", "tip", "--prefix", "g_", "--xyz", "0", "0", "0.1", "--rpy", "0", "0", "1.57"]
    result = urdftool("edit", "attach", *files, *mount, "-o", out, "--format", "json")
    assert result.code == 0, result.err
    report = json.loads(result.out)
    jsonschema.validate(report, SCHEMA)
    assert report["proved"]
    assert sorted(Path(path).name for path in report["files"]) == [
        *("controllers.yaml", "robot.2.map", "robot.map", "robot.srdf", "robot.urdf"),
    ]
    assert urdftool("verify", files[0], out, "--map", out.with_suffix(".map")).code == 0
    assert urdftool("verify", files[1], out, "--map", out.with_suffix(".2.map")).code == 0
    assert urdftool("edit", "attach", *files, *mount[:2], "-o", tmp_path / "no.urdf").code == 2
    assert not (tmp_path / "no.urdf").exists()


def test_another_mount_is_named(urdftool, files, tmp_path):
    out = tmp_path / "robot.urdf"
    urdftool("edit", "attach", *files, "--to", "tip", "--prefix", "g_", "-o", out)
    out.write_text(out.read_text().replace('<parent link="tip"/>', '<parent link="tool"/>'))
    result = urdftool("verify", files[0], out, "--map", out.with_suffix(".map"))
    assert result.code == 1
    assert "mount" in result.out


def test_standard_output_is_the_urdf(urdftool, files):
    result = urdftool("edit", "prefix", files[0], "l_")
    assert result.code == 0
    assert result.out.startswith("<?xml")
    assert "own mass" not in result.out
    assert "[edit-text]" in result.err


def test_a_result_that_differs_is_not_written(urdftool, files, tmp_path, monkeypatch):
    from urdftool.edit import positions

    monkeypatch.setattr(positions, "_change_mimic", lambda *arguments: None)
    out = tmp_path / "out.urdf"
    result = urdftool("edit", "zero", files[0], "slide=0.1", "-o", out)
    assert result.code == 1
    assert "mimic offset" in result.out
    assert "not written, because it differs" in result.err
    assert not out.exists()
    assert urdftool("edit", "zero", files[0], "slide=0.1", "-o", out, "--force").code == 1
    assert out.exists()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["zero", "ARM"], "the arguments are ROBOT and JOINT=VALUE"),
        (["zero", "ARM", "shoulder=up"], "'shoulder=up' is not JOINT=VALUE"),
        (["root", "ARM", "tool", "tip"], "the arguments are ROBOT and LINK"),
        (["mirror", "ARM", "--from", "l_"], "--from and --to are given together"),
        (["attach", "ARM", "--to", "tip"], "the arguments are ROBOT and PART"),
        (["cut", "ARM", "tipp"], "link 'tipp' does not exist"),
        (["turn", "ARM"], "turn"),
        (["prefix", "nowhere.urdf", "l_"], "no such file"),
    ],
)
def test_bad_usage(urdftool, files, words, message):
    result = urdftool("edit", *[files[0] if word == "ARM" else word for word in words])
    assert result.code == 2
    assert message in result.err


def test_a_result_has_no_name_of_a_xacro_file(urdftool, files, tmp_path):
    target = tmp_path / "out.urdf.xacro"
    result = urdftool("edit", "sign", files[0], "shoulder", "-o", target)
    assert result.code == 2
    assert f"{target}: the result is URDF without macros; give it the ending .urdf" in result.err
    assert not target.exists()
