"""A verdict reports findings of rules, where they matter in the run, by its own kinds."""

import pytest

from tests.simulation.robots import body, inertial, simulated
from urdftool.api.lint import check
from urdftool.lint.validate import PURPOSES
from urdftool.model.load import load
from urdftool.simulation.model_checks.description import _CAUSES, KINDS, REMARKS, WARNINGS

BOX = '<box size="0.4 0.3 0.2"/>'
TENSORS = {
    "placeholder-inertia": (1, 1, 1),
    "zero-inertia": (0, 0, 0),
    "inertia-triangle-inequality": (0.01, 0.01, 0.04),
    "inertia-exceeds-geometry": (0.5, 0.6, 0.7),
}


@pytest.mark.parametrize("rule", TENSORS)
def test_a_defect_of_the_file_has_the_sentence_of_lint(write, rule):
    path = write("r.urdf", body(BOX, 2, TENSORS[rule]))
    (fault,) = [fault for fault in simulated(path).faults if fault.is_warning]
    (finding,) = list(check(load(path), select=[rule]))
    assert fault.code in ("impossible-inertia", "inertia-too-large")
    assert (fault.rule, fault.message) == (rule, finding.message)
    assert fault.location is not None


@pytest.mark.parametrize("text", ['ignore = ["placeholder-inertia"]', "ignore = 3"])
def test_the_configuration_of_lint_does_not_change_a_verdict(write, text):
    path = write("r.urdf", body(BOX, 2, (1, 1, 1)))
    write("urdftool.toml", f"{text}\n")
    (fault,) = [fault for fault in simulated(path).faults if fault.is_warning]
    assert (fault.code, fault.rule) == ("inertia-too-large", "placeholder-inertia")


def test_every_rule_of_the_purpose_has_a_kind():
    named = {rule for rules in KINDS.values() for rule in rules}
    assert named == {requirement.rule for requirement in PURPOSES["simulate"]}
    assert set(_CAUSES) == set(KINDS)
    assert set(KINDS) >= REMARKS | WARNINGS


def test_only_links_that_matter_in_the_run_are_told(write):
    """A light link with a placeholder that is fixed to a heavy one, which lint reports."""
    light = f'<link name="b">{inertial(0.3, 0.1, 0.1, 0.1)}<visual><geometry>'
    light += '<box size="0.1 0.1 0.1"/></geometry></visual></link><joint name="j" type="fixed">'
    light += '<parent link="a"/><child link="b"/></joint></robot>'
    path = write("r.urdf", body(BOX, 20, (0.2, 0.3, 0.4)).replace("</robot>", light))
    assert check(load(path), select=["placeholder-inertia"])
    assert [fault for fault in simulated(path).faults if fault.fails or fault.is_warning] == []
