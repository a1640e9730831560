"""Pages of rules and fingerprints of findings as JSON."""

import json

import jsonschema

from tests.conftest import ROOT
from urdftool.rules import FAMILY_OF

SCHEMA = json.loads((ROOT / "docs" / "schemas" / "rules.json").read_text())
WRONG = (
    '<robot name="r">{}<link name="a"/><link name="b"/>'
    '<joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
    '<axis xyz="0 0 0"/></joint></robot>'
)


def records(urdftool, *words):
    result = urdftool("lint", *words, "--format", "json")
    assert (result.code, result.err) == (0, "")
    table = json.loads(result.out)
    jsonschema.validate(table, SCHEMA)
    return table["rules"]


def test_page_of_a_rule(urdftool):
    [page] = records(urdftool, "--explain", "zero-axis")
    assert (page["rule"], page["family"], page["severity"]) == ("zero-axis", "joint", "error")
    assert page["thresholds"] == {"shortest": 1e-6}
    effects = {reader: one["effect"] for one in page["effects"] for reader in one["readers"]}
    assert "NaN" in effects["pybullet"]


def test_all_rules(urdftool):
    assert [page["rule"] for page in records(urdftool, "--list-rules")] == list(FAMILY_OF)


def test_unknown_rule_and_format(urdftool):
    assert "did you mean 'zero-axis'?" in urdftool("lint", "--explain", "zero-axes").err
    result = urdftool("lint", "--list-rules", "--format", "sarif")
    assert result.code == 2
    assert "not with --format sarif" in result.err


def test_fingerprint_stays_when_lines_move(urdftool, tmp_path):
    path = tmp_path / "r.urdf"
    prints = []
    for before in ("", "<!-- one -->\n\n", '<material name="m"><color rgba="0 0 0 1"/></material>'):
        path.write_text(WRONG.format(before))
        result = urdftool("lint", path, "--select", "zero-axis", "--format", "json")
        prints.append([one["fingerprint"] for one in json.loads(result.out)["findings"]])
    assert prints[0] == prints[1] == prints[2] != []
    path.write_text(WRONG.format("").replace('"j"', '"k"'))
    result = urdftool("lint", path, "--select", "zero-axis", "--format", "json")
    assert [one["fingerprint"] for one in json.loads(result.out)["findings"]] != prints[0]
