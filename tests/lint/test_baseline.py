import json

import jsonschema
import pytest

from tests.conftest import ROOT
from tests.report.sarif import SARIF

JOINT = (
    '<joint name="{0}" type="continuous"><parent link="a"/><child link="{0}_link"/>'
    '<axis xyz="{1}"/></joint><link name="{0}_link"/>\n'
)
ONLY = ("--select", "zero-axis")


def robot(*joints, axis="0 0 0", before=""):
    inside = "".join(JOINT.format(name, axis) for name in joints)
    return f'{before}<robot name="r"><link name="a"/>\n{inside}</robot>'


@pytest.fixture
def known(write, urdftool):
    """A robot whose joint j has no axis, and a baseline that knows it."""
    path = write("urdf/r.urdf", robot("j"))
    result = urdftool("lint", path, *ONLY, "--write-baseline", "lint.json")
    assert result.code == 0
    assert result.out == ""
    assert "lint.json: written, 1 entry" in result.err
    return path


def entries(path="lint.json"):
    with open(path) as stream:
        return [
            (e["path"], e["element"]["name"], e["count"]) for e in json.load(stream)["findings"]
        ]


def test_what_was_there_passes_and_is_counted(known, urdftool):
    result = urdftool("lint", known, *ONLY, "--baseline", "lint.json")
    assert (result.code, result.out) == (0, "")
    assert "no new findings, 1 in the baseline in 1 file" in result.err
    assert urdftool("lint", known, *ONLY).code == 1


def test_what_is_new_fails(known, write, urdftool):
    write(known, robot("j", "new"))
    result = urdftool("lint", known, *ONLY, "--baseline", "lint.json", "--format", "concise")
    assert result.code == 1
    assert "axis of joint 'new'" in result.out
    assert "axis of joint 'j'" not in result.out
    assert "1 error, 1 in the baseline" in result.err


def test_lines_and_blanks_do_not_count_but_values_do(known, write, urdftool):
    write(known, robot("j", before="\n\n<!-- moved -->\n", axis="0  0 0"))
    assert urdftool("lint", known, *ONLY, "--baseline", "lint.json").code == 0
    write(known, robot("j", axis="0 0 0.0"))
    assert urdftool("lint", known, *ONLY, "--baseline", "lint.json").code == 1


def test_more_of_the_same_than_counted_fails(known, write, urdftool):
    write(known, robot("j", "j"))
    assert urdftool("lint", known, *ONLY, "--baseline", "lint.json").code == 1
    urdftool("lint", known, *ONLY, "--write-baseline", "lint.json")
    assert entries() == [("urdf/r.urdf", "j", 2)]
    assert urdftool("lint", known, *ONLY, "--baseline", "lint.json").code == 0


def test_paths_are_relative_to_the_baseline(known, urdftool, monkeypatch):
    monkeypatch.chdir("urdf")
    assert entries("../lint.json") == [("urdf/r.urdf", "j", 1)]
    assert urdftool("lint", "r.urdf", *ONLY, "--baseline", "../lint.json").code == 0


def test_an_entry_that_matches_nothing_is_said(known, write, urdftool):
    write(known, robot("j", axis="0 0 1"))
    result = urdftool("lint", known, *ONLY, "--baseline", "lint.json")
    assert result.code == 0
    assert "1 entry matches no finding (urdf/r.urdf: zero-axis of joint 'j')" in result.err
    urdftool("lint", known, *ONLY, "--write-baseline", "lint.json")
    assert entries() == []


def test_an_entry_that_was_not_looked_for_is_neither_stale_nor_lost(known, write, urdftool):
    other = write("other.urdf", robot("k"))
    for words in ([other, *ONLY], [known, "--select", "missing-name"]):
        result = urdftool("lint", *words, "--baseline", "lint.json")
        assert "matches nothing" not in result.err
        urdftool("lint", *words, "--write-baseline", "lint.json")
        assert ("urdf/r.urdf", "j", 1) in entries()


def test_a_baseline_is_not_written_where_a_file_could_not_be_read(known, urdftool):
    result = urdftool("lint", known, "absent.urdf", *ONLY, "--write-baseline", "lint.json")
    assert result.code == 2
    assert "lint.json: not written" in result.err
    assert entries() == [("urdf/r.urdf", "j", 1)]


ENTRY = {
    "path": "r.urdf",
    "rule": "zero-axis",
    "element": {"kind": "joint", "name": "j"},
    "fingerprint": "0",
    "count": 1,
}


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        "[" * 100_000,
        b"\xff\xfe",
        '{"version": 2, "findings": []}',
        '{"version": 1, "findings": [1]}',
        *(
            json.dumps({"version": 1, "findings": [ENTRY | wrong]})
            for wrong in ({"count": 0}, {"count": True}, {"path": 1}, {"element": "j"}, {"x": 1})
        ),
    ],
    ids=lambda text: repr(text[:60]),
)
@pytest.mark.parametrize("option", ["--baseline", "--write-baseline"])
def test_a_broken_baseline_is_one_message(write, urdftool, text, option):
    path = write("r.urdf", robot("j"))
    write("lint.json", text)
    result = urdftool("lint", path, option, "lint.json")
    assert (result.code, result.out) == (2, "")
    assert result.err.startswith("lint.json: ")
    assert result.err.count("\n") == 1


def test_a_baseline_that_is_absent(write, urdftool):
    result = urdftool("lint", write("r.urdf", robot("j")), "--baseline", "absent.json")
    assert result.code == 2
    assert "absent.json: cannot be read" in result.err


def test_a_robot_is_not_overwritten_by_a_baseline(write, urdftool):
    path = write("r.urdf", robot("j"))
    assert urdftool("lint", path, "--write-baseline", path).code == 2
    with open(path) as stream:
        assert stream.read() == robot("j")


def test_reports_for_machines_know_the_baseline(known, urdftool):
    words = ("lint", known, *ONLY, "--baseline", "lint.json", "--format")
    table = json.loads(urdftool(*words, "json").out)
    jsonschema.validate(table, json.loads((ROOT / "docs/schemas/lint.json").read_text()))
    assert table["summary"]["baselined"] == 1
    log = json.loads(urdftool(*words, "sarif").out)
    jsonschema.validate(log, SARIF)
    (result,) = log["runs"][0]["results"]
    assert result["suppressions"] == [{"kind": "external"}]
