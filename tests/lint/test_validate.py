import pytest

from tests.conftest import FIXTURES
from tests.graph.robots import robot, tree
from urdftool.lint.validate import PURPOSES, validate
from urdftool.model.load import load
from urdftool.rules import FAMILY_OF, get_rule

RULES = FIXTURES / "rules"


def rules_of(model, purpose="export"):
    return [finding.rule for finding in validate(model, purpose)]


def test_purposes_are_made_of_rules_that_take_a_robot():
    for requirements in PURPOSES.values():
        for name in (requirement.rule for requirement in requirements):
            assert name in FAMILY_OF
            rule = get_rule(name)
            assert rule.full_check is not None or rule.needs == ("robot",)


@pytest.mark.parametrize("rule", sorted({r.rule for r in PURPOSES["export"]} - {"missing-name"}))
def test_the_bad_robot_of_a_rule_is_not_exported_and_the_good_one_is(rule):
    folder = RULES / rule
    bad = [path for path in folder.glob("bad*.urdf") if path.is_file()]
    assert any(rule in rules_of(load(path)) for path in bad)
    for path in folder.glob("good*.urdf"):
        assert rule not in rules_of(load(path))


@pytest.mark.parametrize(
    ("inside", "rule"),
    [
        ('<joint name="j" type="fixed"><parent link="a "/><child link="b"/></joint>', "unknown-pa"),
        ('<joint name="j" type="fixed"><parent link="${a}"/><child link="b"/></joint>', "unknown-"),
        ('<joint name="j" type="fixed"><parnt link="a"/><child link="b"/></joint>', "missing-pa"),
        ('<joint name="j" type="FIXED"><parent link="a"/><child link="b"/></joint>', "unknown-jo"),
        ('<jiont name="j" type="fixed"/>', "multiple-roots"),
    ],
)
def test_what_lint_leaves_to_another_rule_is_reported_too(inside, rule):
    model = robot(f'<robot name="r"><link name="a"/><link name="b"/>{inside}</robot>')
    assert any(name.startswith(rule) for name in rules_of(model))


def test_a_robot_without_a_name_is_exported_and_a_link_without_one_is_not():
    assert rules_of(load(RULES / "missing-name" / "bad.urdf")) == []
    model = robot('<robot name="r"><link/><joint type="fixed"><child link=""/></joint></robot>')
    assert rules_of(model).count("missing-name") == 2


def test_a_chain_of_followers_that_ends_at_no_joint_is_no_circle():
    mimic = '<mimic joint="{}"/></joint>'
    text = (
        '<robot name="r"><link name="a"/><link name="b"/><link name="c"/>'
        '<joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
        + mimic.format("k")
        + '<joint name="k" type="continuous"><parent link="a"/><child link="c"/>'
        + mimic.format("no")
        + "</robot>"
    )
    assert rules_of(robot(text)) == ["mimic-unknown-joint"]
    assert rules_of(robot(text.replace("no", "j"))) == ["mimic-cycle"] * 2


def test_data_decides_what_a_purpose_accepts():
    ball = tree("ab", [("j", "a", "b")])
    ball.joints[0].type = "ball"
    assert rules_of(ball) == []
    ball.joints[0].type = "universal"
    assert rules_of(ball) == ["unknown-joint-type"]
    loops = [("bc", "b", "c"), ("cb", "c", "b"), ("de", "d", "e"), ("ed", "e", "d")]
    assert rules_of(tree("abcde", loops)) == ["detached-cycle"]
    assert rules_of(tree("abcde", loops), "graph") == ["detached-cycle"] * 4
