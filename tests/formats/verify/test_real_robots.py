"""Round trips and planted differences on the robots of example-robot-data."""

import random

import pytest

from tests.benchmarks.robots import example_robots
from tests.verification.planted import FORMATS, Harness
from tests.verification.round_trips import make_trip

ROBOTS = example_robots()
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not ROBOTS, reason="example-robot-data is not installed"),
]
SMALL = sorted(ROBOTS, key=lambda path: path.read_text(errors="replace").count("<mesh"))


@pytest.mark.parametrize("path", ROBOTS, ids=lambda path: path.stem)
def test_round_trip_through_sdf(path, tmp_path):
    trip = make_trip(path, "sdf", tmp_path)
    assert not trip.refused
    assert not trip.differing


@pytest.mark.library("mujoco")
@pytest.mark.parametrize("path", SMALL[:20], ids=lambda path: path.stem)
def test_round_trip_through_mjcf(path, tmp_path):
    trip = make_trip(path, "mjcf", tmp_path)
    assert not trip.refused
    assert not trip.differing


@pytest.mark.library("mujoco")
@pytest.mark.parametrize("path", SMALL[:12], ids=lambda path: path.stem)
def test_planted_differences_are_found(path, tmp_path):
    harness, generator = Harness(path, tmp_path), random.Random(1)
    for number, changed in enumerate(FORMATS):
        other = FORMATS[(number + 1) % 3]
        assert not harness.compare(harness.robots[changed], harness.robots[other])
        results = list(harness.plant(changed, other, generator))
        assert [result for result in results if not result.found] == []
