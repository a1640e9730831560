"""What carries a robot is all of a shape that is down there, not only where an engine says."""

from dataclasses import replace

import pytest

from tests.simulation.robots import body, runs
from urdftool.simulation.checks.final_state import measure_final_state
from urdftool.simulation.run import Run


@pytest.mark.parametrize("count", [1, 4])
def test_a_box_stands_on_its_whole_side_whatever_contacts_are_told(write, count):
    text = body('<box size=".4 .2 .1"/>', 1, (0.01, 0.01, 0.01))
    (run,) = runs(write("box.urdf", text), duration=0.5)
    told = replace(run.recording, carrying=run.recording.carrying[:count])
    margin = measure_final_state(Run(run.settings, run.bodies, told)).margin
    assert margin == pytest.approx(0.1, abs=1e-3)


def test_a_ball_stands_on_a_point(write):
    (run,) = runs(write("ball.urdf", body('<sphere radius=".1"/>', 1, (0.004,) * 3)), duration=0.5)
    assert measure_final_state(run).margin == pytest.approx(0.0, abs=1e-3)
