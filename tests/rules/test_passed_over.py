"""What is not looked at, because it would take too long, is said."""

import pytest

from urdftool import check
from urdftool.rules.collision import overlap

LINK = """<link name="l{0}"><collision>
<geometry><sphere radius="0.1"/></geometry></collision></link>
"""
JOINT = """<joint name="j{0}" type="continuous"><origin xyz="{2} 0 0"/><parent link="l{0}"/>
<child link="l{1}"/><axis xyz="1 0 0"/></joint>
"""


def balls(count, apart):
    """As many balls of 0.1 m in a row, each on the one before and so far from it [m]."""
    links = "".join(map(LINK.format, range(count)))
    joints = "".join(JOINT.format(n, n + 1, apart) for n in range(count - 1))
    return f"<robot name='balls'>{links}{joints}</robot>"


@pytest.fixture
def chain(write):
    return write("chain.urdf", balls(9, apart=0.3))


BOTH = ("self-collision-in-range", "analysis-incomplete")


def test_a_robot_that_is_looked_at_in_full_has_nothing_to_say(chain):
    assert check(chain, select=BOTH) == []


@pytest.mark.parametrize("bound", ["TRIES", "PAIRS"])
def test_joints_that_were_passed_over_are_counted_once(chain, bound, monkeypatch):
    monkeypatch.setattr(overlap, bound, -1 if bound == "TRIES" else 20)
    (finding,) = check(chain, select=BOTH)
    assert finding.code == "analysis-incomplete"
    expected = ("'j0'", "8 of 8") if bound == "TRIES" else ("'j2'", "6 of 8")
    assert all(word in finding.message for word in expected)
    assert check(chain, select=("analysis-incomplete",)) == []


@pytest.fixture
def heap(write):
    """Thirty balls in one place, each on the one before: 406 pairs that no joint joins."""
    return write("heap.urdf", balls(30, apart=0.001))


def test_pairs_that_were_passed_over_are_said(heap, monkeypatch):
    monkeypatch.setattr(overlap, "RESTING", 100)
    found = check(heap, select=("self-collision-at-zero", "analysis-incomplete"))
    part, rest = sorted(found, key=lambda finding: finding.code)
    assert "the first 100 pairs" in part.message
    assert rest.message.startswith("100 pairs of links overlap")
    assert "and 88 more pairs" in rest.message


def test_a_heap_is_one_finding_that_can_be_read(heap):
    (finding,) = check(heap, select=("self-collision-at-zero", "analysis-incomplete"))
    assert finding.message.startswith("406 pairs of links overlap")
    assert "and 394 more pairs" in finding.message
    assert len(finding.message) < 500
