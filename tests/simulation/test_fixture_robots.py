"""The robots of the fixtures, at the stages of their courses, give the verdicts they deserve."""

import pytest

from tests.conftest import FIXTURES
from tests.simulation.robots import kinds, simulated

ROBOTS = FIXTURES / "robots"


def test_mira_without_collision_and_inertia_is_said_to_have_none():
    verdict = simulated(ROBOTS / "mira_description" / "urdf" / "mira_geometric.urdf")
    assert {"no-collision-geometry", "no-mass"} <= kinds(verdict)


@pytest.mark.parametrize("name", ["mira", "mira_simple_collisions_inertias"])
def test_finished_mira_stands(name):
    verdict = simulated(ROBOTS / "mira_description" / "urdf" / f"{name}.urdf")
    assert verdict.stands, verdict.faults
    assert verdict.rest.supports == ("base_link",)


def test_the_mobile_base_rests_on_four_wheels():
    verdict = simulated(ROBOTS / "my_robot" / "urdf" / "robot_base.urdf.xacro")
    assert verdict.stands, verdict.faults
    assert len(verdict.rest.supports) == 4
    assert all("wheel" in name for name in verdict.rest.supports)


def test_the_mobile_base_stays_where_it_is_when_nothing_holds_its_wheels():
    verdict = simulated(ROBOTS / "my_robot" / "urdf" / "robot_base.urdf.xacro", hold="none")
    assert verdict.stands, verdict.faults
    assert verdict.rest.drift < 0.002
    assert verdict.run.recording.kinetic[-1] < 1e-4
