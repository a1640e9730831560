"""JSON of ``srdf``, ``--check`` and ``--update``, by their schemas."""

import json

import jsonschema
import pytest

pytest.importorskip("fcl")

from tests.conftest import ROOT
from tests.srdf.test_prove import sphere_arm
from tests.srdf.test_update import AB, AC, AD, ARM, HEAD


def validate(text, name):
    data = json.loads(text)
    schema = json.loads((ROOT / "docs" / "schemas" / f"{name}.json").read_text())
    jsonschema.validate(data, schema)
    return data


@pytest.mark.parametrize(
    ("gap", "boxes", "verdict"),
    [(0.01, 40000, "never"), (-0.001, 40000, "can-touch"), (0.00002, 100, "open")],
)
def test_verdicts(urdftool, write, gap, boxes, verdict):
    write("r.urdf", sphere_arm(gap))
    result = urdftool("srdf", "r.urdf", "--format", "json", "--boxes", boxes, "-j", "1")
    data = validate(result.out, "srdf")
    (pair,) = data["pairs"]
    assert (pair["links"], pair["verdict"]) == (["post", "tip"], verdict)
    assert bool(pair["positions"]) == (verdict != "never")
    assert data["summary"][verdict] == 1
    assert data["ranges"]["out"] == [-0.1, 0.1]


def test_a_missing_mesh_is_a_problem(urdftool, write):
    text = sphere_arm(0.01).replace('<sphere radius="0.1"/>', '<mesh filename="no.stl"/>', 1)
    write("r.urdf", text)
    data = validate(urdftool("srdf", "r.urdf", "--format", "json", "-j", "1").out, "srdf")
    assert list(data["problems"]) == ["post"]
    assert data["pairs"][0]["reason"] == "the shape of 'post' is unknown"


def test_check_and_update(urdftool, write):
    write("arm.urdf", ARM)
    unknown = AB.replace('"a"', '"x"')
    write("arm.srdf", HEAD + AB + AB + AD + unknown + "</robot>\n")
    result = urdftool("srdf", "arm.urdf", "--check", "arm.srdf", "--format", "json", "-j", "1")
    assert result.code == 1
    data = validate(result.out, "srdf-check")
    found = [(*pair["links"], pair["code"], pair["line"]) for pair in data["pairs"]]
    assert found[:4] == [
        ("a", "b", "proved", 4),
        ("a", "b", "repeated", 5),
        ("a", "d", "disabled-pair-can-touch", 6),
        ("x", "b", "unknown-link", 7),
    ]
    assert {pair["path"] for pair in data["pairs"][4:]} == {None}
    assert data["summary"]["pair-never-touches"] == len(data["pairs"]) - 4
    result = urdftool("srdf", "arm.urdf", "--update", "arm.srdf", "--format", "json", "-j", "1")
    data = validate(result.out, "srdf-update")
    assert ["a", "d"] in [pair["links"] for pair in data["removed"]]
    assert ["a", "c"] in [pair["links"] for pair in data["added"]]


def test_update_says_why_a_pair_stays(urdftool, write):
    write("arm.urdf", ARM)
    write("arm.srdf", HEAD + AB + AC + AD.replace("\n", " <!-- why -->\n") + "</robot>\n")
    result = urdftool("srdf", "arm.urdf", "--update", "arm.srdf", "--format", "json", "-j", "1")
    (kept,) = validate(result.out, "srdf-update")["kept"]
    assert kept["links"] == ["a", "d"]
    assert "comment" in kept["why"]


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("--check", "arm.srdf", "--format", "usd"), "--check has no --format usd"),
        (("--update", "arm.srdf", "--format", "pyroki"), "--update has no --format pyroki"),
        (("--update", "arm.srdf", "--format", "json", "-o", "-"), "exclude each other"),
    ],
)
def test_formats_that_a_report_does_not_have_are_refused(urdftool, write, words, error):
    write("arm.urdf", ARM)
    write("arm.srdf", HEAD + AB + "</robot>\n")
    result = urdftool("srdf", "arm.urdf", *words)
    assert (result.code, error in result.err) == (2, True)
