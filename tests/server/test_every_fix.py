"""Each rule with a fix offers it in the editor, on the robots of its fixtures."""

from pathlib import Path

import pytest

from tests.conftest import FIXTURES
from urdftool.rules.table import FIXES
from urdftool.server.session import Session


def list_offered(path, rule):
    """Return the actions for the findings of a rule, without comments that suppress it."""
    session, parts = Session(), []
    folder = str(path.parent.resolve())
    select = None if rule == "unused-suppression" else [rule]  # it looks at the other rules
    session.knowledge.configure("utf-16", [folder], {}, (), (), select, ())
    session.compute_answer("check", {"paths": [str(path)]}, parts.append, lambda: None)
    findings = {}
    for part in parts:
        for file, shown in {**(part["findings"] or {}), **part["errors"]}.items():
            findings.setdefault(file, []).extend(one for one in shown if one["code"] == rule)
    return [
        action
        for file, shown in findings.items()
        for one in shown
        for action in session.compute_answer(
            "actions", {"path": file, "range": one["range"]}, parts.append, lambda: None
        )
        if action["code"] == rule and "Suppress" not in action["title"]
    ]


FAST = (
    *("axis-not-unit", "unused-suppression", "obsolete-cli-option", "controller-unknown-joint"),
    *("srdf-unknown-link", "moveit-parameter-type"),
)
"""Rules with findings in a description, and in other files of the robot."""


@pytest.mark.parametrize(
    "rule",
    [rule if rule in FAST else pytest.param(rule, marks=pytest.mark.slow) for rule in FIXES],
)
def test_a_fix_is_offered(rule):
    folder = FIXTURES / "rules" / rule
    bad = sorted((*folder.glob("bad*.urdf*"), *folder.glob("bad*.sdf")))
    offered = [
        action
        for path in bad
        if not Path(path).name.endswith(".expected")
        for action in list_offered(path, rule)
    ]
    assert any(action["edits"] or action.get("disabled") for action in offered)
