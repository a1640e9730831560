"""What lint knows of a file is said in lint's words, and by its rule."""

import pytest

from tests.simulation.robots import body, inertial, simulated
from urdftool.lint.run import check
from urdftool.model.load import load

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
    (fault,) = [fault for fault in simulated(path).faults if fault.fails]
    (finding,) = [one for one in check(load(path)) if one.rule == rule]
    assert fault.kind in ("impossible-inertia", "inertia-too-large")
    assert (fault.rule, fault.message) == (rule, finding.message)
    assert fault.place is not None


def test_a_rule_that_is_switched_off_leaves_the_own_sentence(write):
    path = write("r.urdf", body(BOX, 2, (1, 1, 1)))
    write("urdftool.toml", 'ignore = ["placeholder-inertia"]\n')
    (fault,) = [fault for fault in simulated(path).faults if fault.fails]
    assert fault.kind == "inertia-too-large"
    assert "placeholder" not in fault.message


def test_a_broken_configuration_is_not_told_by_the_judges(write):
    path = write("r.urdf", body(BOX, 2, (1, 1, 1)))
    write("urdftool.toml", "ignore = 3\n")
    (fault,) = [fault for fault in simulated(path).faults if fault.fails]
    assert fault.kind == "inertia-too-large"


def test_only_links_that_matter_in_the_run_are_told(write):
    """A light link with a placeholder that is fixed to a heavy one, which lint reports."""
    light = f'<link name="b">{inertial(0.3, 0.1, 0.1, 0.1)}<visual><geometry>'
    light += '<box size="0.1 0.1 0.1"/></geometry></visual></link><joint name="j" type="fixed">'
    light += '<parent link="a"/><child link="b"/></joint></robot>'
    path = write("r.urdf", body(BOX, 20, (0.2, 0.3, 0.4)).replace("</robot>", light))
    assert "placeholder-inertia" in {finding.rule for finding in check(load(path))}
    assert [fault for fault in simulated(path).faults if fault.fails] == []
