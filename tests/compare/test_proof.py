"""An export differs from its source, unless a loss of that part explains the difference."""

from dataclasses import replace

import pytest

from tests.formats.sdf.robots import BOX, inertial, joint, link, robot
from urdftool.compare.check import is_faithful
from urdftool.compare.proof import Claims, Excuse, prove
from urdftool.compare.rows import ROWS, narrow_tolerances
from urdftool.diagnostic import Severity
from urdftool.finding import Finding
from urdftool.model.elements import Calibration
from urdftool.model.mechanism import Base
from urdftool.model.provenance import NOWHERE

LOSS = "lossy-anything"


def arm(upper=1, mass=2.0, tip=1.0, size="1 2 3", names=("b", "j")):
    limit = f'<limit lower="-1" upper="{upper}" effort="3" velocity="4"/>'
    return robot(
        link("a"),
        joint(names[1], "a", names[0], inside=limit),
        link(names[0], inertial(mass)),
        joint("w", names[0], "c", "fixed", origin="0 0 1"),
        link("c", inertial(tip) + f"<visual>{BOX.replace('1 2 3', size)}</visual>"),
        joint("k", "c", "d", "continuous", inside='<axis xyz="0 1 0"/>'),
        link("d"),
    )


def find(checks):
    return {check.name for check in checks if check.verdict == "differs"}


def claims(*rows, name, extent="part", severity=Severity.WARNING, least=Severity.INFO):
    loss = Finding(LOSS, severity, "", NOWHERE, "", name)
    return Claims([loss], {}, [Excuse(rows, frozenset((LOSS,)), extent, least=least)])


def test_equal_robots_are_faithful():
    checks = prove(arm(), arm(), Claims(), rows=narrow_tolerances(ROWS, 1e-12))
    assert is_faithful(checks)
    assert {check.tolerance for check in checks} <= {0.0, 1e-12}


def test_a_row_that_a_format_lacks_a_part_of_is_equal_in_part():
    one, two = arm(), arm()
    one.joint["j"].calibration = Calibration(None, rising=0.1)
    two.format = "sdf"
    row = next(check for check in prove(one, two, Claims()) if check.name == "limits")
    assert (row.verdict, row.shown, row.as_dict()["partial"]) == ("equal", "equal, in part", True)


@pytest.mark.parametrize(
    ("change", "row", "text"),
    [
        ({"upper": 1.5}, "limits", "joint 'j': upper limit is 1.5, not 1"),
        ({"mass": 2.5}, "mass", "link 'b': mass is 2.5, not 2"),
        ({"size": "1 2 4"}, "visuals", "link 'c': visual is box"),
    ],
)
def test_a_difference_names_part_and_values(change, row, text):
    checks = {check.name: check for check in prove(arm(), arm(**change), Claims())}
    assert checks[row].differing[0].startswith(text)


@pytest.mark.parametrize(
    ("excused", "left"),
    [
        (claims("limits", name="j"), {"visuals"}),
        (claims("limits", name="k"), {"limits", "visuals"}),
        (claims("visuals", name="j"), {"limits", "visuals"}),
        (claims("visuals", name="c"), {"limits"}),
        (claims("visuals", name="b"), {"limits", "visuals"}),
        (claims("visuals", name="b", extent="body"), {"limits"}),
        (claims("visuals", name="a", extent="body"), {"limits", "visuals"}),
        (claims("visuals", name="j", extent="below"), {"limits"}),
        (claims("visuals", name="d", extent="below"), {"limits", "visuals"}),
        (claims("visuals", "limits", name="", extent="robot"), set()),
        (
            claims("limits", name="j", severity=Severity.INFO, least=Severity.WARNING),
            {"limits", "visuals"},
        ),
        (
            Claims([Finding("other", Severity.WARNING, "", NOWHERE, "", "j")],
                   excuses=[Excuse(("limits",), frozenset((LOSS,)))]),
            {"limits", "visuals"},
        ),
    ],
)  # fmt: skip
def test_a_loss_explains_only_its_part_and_row(excused, left):
    assert find(prove(arm(), arm(upper=1.5, size="1 2 4"), excused)) == left


def test_new_names_are_known():
    renamed = {("link", "b"): "x", ("joint", "j"): "y"}
    result = arm(names=("x", "y"))
    assert find(prove(arm(), result, Claims(renamed=renamed))) == set()


def test_several_trees_are_compared():
    def trees(mass):
        return robot(link("a"), link("b", inertial(mass)), joint("j", "b", "c"), link("c"))

    assert find(prove(trees(1), trees(1), Claims())) == set()
    assert find(prove(trees(1), trees(2), Claims())) == {"mass", "mass matrix", "gravity"}


def test_what_could_not_be_compared_is_named():
    unread = [Finding("unread-light", Severity.INFO, "lights are not read: 2", NOWHERE)]
    checks = {c.name: c for c in prove(arm(), arm(), Claims(unread=unread))}
    assert checks["base"].verdict == "not compared"
    assert checks["base"].skipped
    assert checks["other data"].skipped == "not read, so not compared: lights are not read: 2"
    assert checks["other data"].as_dict()["verdict"] == "not compared"


def test_a_lone_world_is_left_out_if_that_is_declared():
    source = robot(link("world", inertial(1)), *tree())
    declared = [Finding("lossy-world", Severity.WARNING, "", NOWHERE, "", "world")]
    assert find(prove(source, robot(*tree()), Claims(declared))) == set()
    assert "mass" in find(prove(source, robot(*tree()), Claims()))
    empty = robot(link("world", ""), *tree())
    assert find(prove(empty, robot(*tree()), Claims())) == set()


@pytest.mark.parametrize(("mass", "rows"), [(2, {"tree"}), (3, {"tree", "mass"})])
def test_an_added_part_on_the_world_is_the_only_difference(mass, rows):
    source = replace(robot(*tree()), base=Base(None, True))
    on_world = [
        link("world", ""),
        *(joint(f"{name}_f", "world", name, "floating") for name in "az"),
    ]
    found = find(prove(source, robot(*on_world, *tree(mass), link("z", "")), Claims()))
    assert found - {"mass matrix", "gravity"} == rows


def tree(mass=2):
    """A tree of three links, of which the last one moves."""
    limit = '<limit lower="-1" upper="1" effort="3" velocity="4"/>'
    return (
        *(link("a", ""), link("b", inertial(mass)), joint("w", "a", "b", "fixed")),
        *(joint("k", "b", "c", "revolute", inside=limit), link("c", inertial(1))),
    )
