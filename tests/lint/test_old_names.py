"""Old names of rules and thresholds: they work, with one warning each."""

import json
from pathlib import Path

import pytest

from urdftool.api.lint import check
from urdftool.configuration import Configuration
from urdftool.lint.baseline import Baseline, read_baseline, to_text
from urdftool.lint.fingerprint import compute_fingerprint
from urdftool.lint.settings import Settings, check_selectors, read_settings
from urdftool.rules import FAMILY_OF, get_rule
from urdftool.rules.old_names import (
    RENAMED_RULES,
    RENAMED_THRESHOLDS,
    OldName,
    find_old_names,
    find_old_rules,
    resolve_selectors,
)
from urdftool.rules.table import FIXES

BAD = Path(__file__).parents[2] / "fixtures" / "rules" / "prismatic-in-millimeters" / "bad.urdf"
OLD, NEW = "prismatic-in-millimetres", "prismatic-in-millimeters"


def test_old_names_are_not_rules_and_new_ones_are():
    assert not set(RENAMED_RULES) & set(FAMILY_OF)
    assert set(RENAMED_RULES.values()) <= set(FAMILY_OF)


@pytest.mark.parametrize("rule", RENAMED_THRESHOLDS)
def test_new_thresholds_exist(rule):
    keys = {name.replace("_", "-") for name in get_rule(rule).thresholds}
    assert set(RENAMED_THRESHOLDS[rule].values()) <= keys
    assert not set(RENAMED_THRESHOLDS[rule]) & keys


def test_selectors_have_present_names():
    assert check_selectors([f"mesh, {OLD}"]) == ("mesh", NEW)
    assert resolve_selectors(["mass-out-of*", "mesh-*", "no-such*"]) == (
        "mass-outlier",
        "mesh-*",
        "no-such*",
    )
    assert list(find_old_rules([f"mesh,{OLD}"])) == [OldName("rule", OLD, NEW)]


def test_a_configuration_may_have_old_names(tmp_path):
    table = {
        "select": [OLD],
        "severity": {"mass-out-of-line": "error"},
        "per-file-ignores": {"*.urdf": ["mesh-in-millimetres"]},
        "mass-out-of-line": {"denser": 5.0, "min-links": 2},
        "stiff-joint-damping": {"step": 0.002},
    }
    found = read_settings("a.urdf", Configuration(None, lint=table), Settings())
    assert found.select == (NEW,)
    assert found.ignore == ("mesh-in-millimeters",)
    assert list(found.severity) == ["mass-outlier"]
    assert found.thresholds == {
        "mass-outlier": {"density_ratio": 5.0, "min_links": 2},
        "stiff-joint-damping": {"timestep": 0.002},
    }
    assert [(old.kind, old.old) for old in find_old_names(table)] == [
        ("rule", OLD),
        ("rule", "mass-out-of-line"),
        ("rule", "mesh-in-millimetres"),
        ("rule", "mass-out-of-line"),
        ("threshold", "mass-out-of-line.denser"),
        ("threshold", "stiff-joint-damping.step"),
    ]


def test_the_python_function_warns_once():
    with pytest.warns(DeprecationWarning, match=NEW) as caught:
        found = check(BAD, select=iter([OLD]))
    assert [finding.code for finding in found] == [NEW]
    assert len(caught) == 1


def test_a_baseline_may_have_old_names(tmp_path):
    (finding,) = check(BAD, select=[NEW])
    path = tmp_path / "baseline.json"
    entry = Baseline(str(path)).get_entry(finding)
    path.write_text(to_text(Baseline(str(path), {entry._replace(rule=OLD): 1})))
    assert read_baseline(str(path)).counts == {entry: 1}


def test_a_renamed_rule_keeps_its_fingerprints():
    (finding,) = check(BAD, select=[NEW])
    assert compute_fingerprint(finding) == "e36935ff5ecd2a98"


def test_the_command_prints_one_warning(urdftool, tmp_path, monkeypatch):
    (tmp_path / "urdftool.toml").write_text(f'[lint]\nignore = ["{OLD}"]\n')
    for name in ("a.urdf", "b.urdf"):
        (tmp_path / name).write_bytes(BAD.read_bytes())
    monkeypatch.chdir(tmp_path)
    done = urdftool("lint", "--no-cache", "-j", "2", "--extend-select", "mass-out-of-line", ".")
    assert done.code == 0
    lines = [line for line in done.err.splitlines() if " is now " in line]
    assert [line.partition(";")[0] for line in lines] == [
        "urdftool: rule 'mass-out-of-line' is now 'mass-outlier'",
        f"{tmp_path / 'urdftool.toml'}: rule '{OLD}' is now '{NEW}'",
    ]


def test_explain_shows_the_page_of_the_new_name(urdftool):
    done = urdftool("lint", "--explain", OLD)
    assert done.code == 0
    assert done.out.startswith(f"{NEW} (joint)")
    assert f"rule '{OLD}' is now '{NEW}'" in done.err


def test_sarif_names_the_old_rule(urdftool):
    done = urdftool("lint", "--no-cache", "--select", NEW, "--format", "sarif", BAD)
    rules = json.loads(done.out)["runs"][0]["tool"]["driver"]["rules"]
    assert {rule["id"]: rule.get("deprecatedIds") for rule in rules} == {NEW: [OLD]}


def test_a_comment_with_an_old_name_suppresses_and_is_reported(tmp_path):
    bad = BAD.parents[1] / "renamed-rule" / "bad.urdf"
    (finding,) = check(bad, fixes=True)
    assert (finding.code, finding.severity.label) == ("renamed-rule", "info")
    assert finding.data == {"name": OLD, "suggestion": NEW}
    assert finding.fix is not None
    assert FIXES["renamed-rule"].applicability == "safe"
