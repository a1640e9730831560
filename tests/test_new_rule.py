"""The frame of a new rule."""

import ast

import pytest

from tests import new_rule


@pytest.fixture
def tree(tmp_path, monkeypatch):
    """A copy of one file of rules, and an empty folder of fixtures."""
    rules = tmp_path / "urdftool" / "rules"
    (rules / "joint").mkdir(parents=True)
    (tmp_path / "fixtures" / "rules").mkdir(parents=True)
    text = (new_rule.RULES / "joint" / "drive.py").read_text("utf-8")
    (rules / "joint" / "drive.py").write_text(text, "utf-8")
    monkeypatch.setattr(new_rule, "RULES", rules)
    monkeypatch.setattr(new_rule, "FIXTURES", tmp_path / "fixtures" / "rules")
    return tmp_path


def test_a_frame_is_a_function_that_uses_only_what_the_file_imports(tree):
    module, good, bad = new_rule.add("heavy-damping", "joint/drive")
    tops = ast.parse(module.read_text("utf-8")).body
    (added,) = (top for top in tops if getattr(top, "name", "") == "heavy_damping")
    assert added is tops[-1]
    known = {name.asname or name.name for top in tops for name in getattr(top, "names", ())}
    used = {node.id for node in ast.walk(added) if isinstance(node, ast.Name)}
    assert used - {"joint", "robot"} <= known
    assert "<!-- heavy-damping -->" in bad.read_text("utf-8")
    assert "<!-- heavy-damping -->" not in good.read_text("utf-8")


@pytest.mark.parametrize(
    ("name", "file", "reason"),
    [
        ("axis-not-unit", "joint/drive", "exists"),
        ("HeavyDamping", "joint/drive", "words in lower case with hyphens"),
        ("../escape-it", "joint/drive", "words in lower case with hyphens"),
        ("heavy-damping", "joint/none", "does not exist; write FAMILY/FILE"),
        ("heavy-damping", "drive", "does not exist; write FAMILY/FILE"),
    ],
)
def test_what_cannot_be_added_is_refused(tree, name, file, reason):
    assert reason in new_rule.explain_refusal(name, file)


def test_robots_of_a_frame_are_silent(tree, urdftool):
    for path in new_rule.add("heavy-damping", "joint/drive")[1:]:
        result = urdftool("lint", path)
        assert (result.code, result.out) == (0, "")
