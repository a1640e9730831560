"""A simulation diverged if values are not finite, the robot is far away, or energy increased."""

from types import SimpleNamespace

import numpy as np
import pytest

from urdftool.simulation.checks.settling import has_diverged
from urdftool.simulation.checks.thresholds import Thresholds
from urdftool.simulation.engines.driver import RUNAWAY, _has_diverged


def _sample(x=0.0, kinetic=0.0):
    poses = np.zeros((2, 7))
    poses[1, 0] = x
    return {"poses": poses, "kinetic": kinetic}


@pytest.mark.parametrize(
    ("sample", "expected"),
    [
        (_sample(), False),
        (_sample(RUNAWAY * 1.9), False),
        (_sample(-RUNAWAY * 2.1), True),
        (_sample(np.nan), True),
        (_sample(kinetic=np.inf), True),
    ],
)
def test_a_sample_that_is_not_finite_or_far_away_has_diverged(sample, expected):
    assert _has_diverged(sample, SimpleNamespace(size=2.0)) is expected


@pytest.mark.parametrize(
    ("ended", "gain", "expected"),
    [("time", 9.0, False), ("time", 11.0, True), ("lost", 0.0, True)],
)
def test_a_run_whose_energy_increased_has_diverged(ended, gain, expected):
    """The bound is half the energy that lifts 2 kg by 1 m at 10 m/s²: 10 J."""
    run = SimpleNamespace(
        bodies=SimpleNamespace(size=1.0, mass=2.0),
        settings=SimpleNamespace(gravity=10.0),
        thresholds=Thresholds(),
        recording=SimpleNamespace(ended=ended),
    )
    assert has_diverged(run, SimpleNamespace(gain=gain)) is expected
