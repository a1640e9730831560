"""Licenses that a bundle lacks, and its report as JSON."""

import json

import jsonschema
import pytest

from tests.bundle import files
from tests.conftest import ROOT

SCHEMA = json.loads((ROOT / "docs/schemas/bundle.json").read_text())


def package(declared):
    return f"<package><name>my_arm</name>{declared}</package>"


@pytest.mark.parametrize(
    ("declared", "license_file", "message"),
    [
        ("<license>MIT</license>", "", ""),
        ("", "p/LICENSE", ""),
        ("", "p/meshes/COPYING", ""),
        ("", "", "package 'my_arm' has no license"),
        ("<license>TODO: License declaration</license>", "", "'TODO: License declaration'"),
        ("<license>TODO</license>", "p/LICENSE", "the license 'TODO', which grants nothing"),
    ],
)
def test_a_package_without_a_license_is_one_line(urdftool, write, declared, license_file, message):
    write("p/package.xml", package(declared))
    write("p/meshes/a.stl", files.stl())
    if license_file:
        write(license_file, "MIT License")
    path = write("p/urdf/r.urdf", files.robot(("../meshes/a.stl", "../meshes/a.stl")))
    done = urdftool("bundle", path, "-o", "out")
    lines = [line for line in done.err.splitlines() if "[no-license]" in line]
    assert done.code == 0
    assert len(lines) == bool(message)
    assert all(message in line and line.startswith("p/package.xml:1:1: warning") for line in lines)


@pytest.mark.parametrize("words", [("--json",), ("--format", "json")])
def test_the_report_as_json(urdftool, write, words):
    write("a.stl", files.stl())
    path = write("r.urdf", files.robot(("a.stl", "a.stl")))
    done = urdftool("bundle", path, "-o", "out", *words)
    report = json.loads(done.out)
    jsonschema.validate(report, SCHEMA)
    assert (done.code, report["output"], report["complete"]) == (0, "out", None)
    assert [one["path"] for one in report["files"]] == ["arm.urdf", "meshes/a.stl"]
    assert [one["rule"] for one in report["findings"]] == ["no-license"]


def test_defects_as_json(urdftool, write, tmp_path):
    write("a.stl", files.stl())
    assert urdftool("bundle", write("r.urdf", files.robot(("a.stl", "a.stl"))), "-o", "b").code == 0
    assert json.loads(urdftool("bundle", "b", "--check", "--json").out)["complete"] is True
    (tmp_path / "b" / "meshes" / "a.stl").unlink()
    done = urdftool("bundle", "b", "--check", "--format", "json")
    report = json.loads(done.out)
    jsonschema.validate(report, SCHEMA)
    assert (done.code, report["complete"], report["files"]) == (1, False, [])
    assert {one["code"] for one in report["defects"]} == {"missing-file", "missing-reference"}


def test_a_refused_bundle_as_json(urdftool, write):
    done = urdftool("bundle", write("r.urdf", files.robot(("a.stl", "a.stl"))), "-o", "b", "--json")
    assert done.code == 2
    report = json.loads(done.out)
    jsonschema.validate(report, SCHEMA)
    assert report["findings"][0]["rule"] == "mesh-not-found"
