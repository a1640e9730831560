"""The defects that simcheck plants are found; ``python -m measure.damage.peer`` has the table."""

import pytest

from measure.damage.peer import EIGHT, table, total
from measure.damage.peer_kinds import PEER_KINDS
from measure.damage.robots import of_pybullet

ROBOTS = of_pybullet(EIGHT)
needs_robots = pytest.mark.skipif(not ROBOTS, reason="needs pybullet_data, which is on PyPI")


def test_there_are_seventeen_kinds():
    assert len(PEER_KINDS) == 17


@needs_robots
def test_most_defects_of_one_robot_are_found():
    found = total(table([robot for robot in ROBOTS if robot.path.stem == "a1"]))
    assert found.tried == len(PEER_KINDS)
    assert found.found == found.tried, found.missed


@pytest.mark.slow
@needs_robots
def test_nearly_all_defects_of_eight_robots_are_found():
    rows = table(ROBOTS, seeds=3)
    found = total(rows)
    assert found.found >= 0.95 * found.tried, found.missed
    assert found.loud >= 0.85 * found.tried
    in_principle = ("axis reversed", "joint pushed into its parent")
    missed = {kind for kind, row in rows.items() if any(cell.missed for cell in row.values())}
    assert missed <= set(in_principle)
