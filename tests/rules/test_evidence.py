"""Each rule that is on by default has evidence: a run, a source or a judged finding."""

import pytest
from generator.rule_evidence import count_effects, count_verdicts, list_evidence

from urdftool.rules import get_all_rules, get_rule

OF_LINT = "lint"
"""Family of the rules about comments of lint itself."""


@pytest.mark.parametrize("rule", get_all_rules(), ids=lambda rule: rule.name)
def test_a_rule_on_by_default_has_evidence(rule):
    assert not rule.default or rule.family == OF_LINT or list_evidence(rule)


@pytest.mark.parametrize("rule", get_all_rules(), ids=lambda rule: rule.name)
def test_a_rule_is_off_if_its_findings_were_never_useful(rule):
    """Three judged findings of which none is useful, and no reader that rejects the robot.

    A rule may be on if the cases of it that were noise are off. Effects are those on readers of
    URDF: a rule of other formats only states in its evidence that their readers reject the file.
    """
    verdicts = count_verdicts().get(rule.name, {})
    judged = sum(verdicts.values())
    rejects = count_effects(rule)[1] or ("urdf" not in rule.formats and rule.evidence)
    assert not rule.default or judged < 3 or verdicts["useful"] or rejects or rule.pedantic


def test_kinds_of_evidence_are_told_apart():
    run, rejecting, _ = count_effects(get_rule("missing-limit"))
    assert run > 0
    assert rejecting > 0
    assert "declared" in list_evidence(get_rule("tiny-moving-inertia"))
