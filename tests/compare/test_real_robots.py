"""Round trips and planted differences on robots of several packages."""

import pytest

from measure.benchmarks.robots import example_robots
from measure.verification.__main__ import measure
from measure.verification.round_trips import make_trip
from measure.verification.sample import draw
from urdftool.errors import UrdftoolError

ROBOTS = example_robots()
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not ROBOTS, reason="example-robot-data is not installed"),
]


@pytest.mark.parametrize(
    "through", ["sdf", pytest.param("mjcf", marks=pytest.mark.library("mujoco"))]
)
@pytest.mark.parametrize("path", ROBOTS, ids=lambda path: path.stem)
def test_round_trip(path, through, tmp_path):
    trip = make_trip(path, through, tmp_path)
    if "needs more than" in trip.refused:
        pytest.skip(trip.refused)  # a limit of memory
    assert not trip.refused
    assert not trip.differing


@pytest.mark.library("mujoco")
@pytest.mark.parametrize("group", ["example", "pybullet", "repositories", "other formats"])
def test_planted_differences_are_found(group):
    """The first two suitable robots of another random order than that of the documentation."""
    planted, equal, robots = [], [], set()
    for source in draw(5).get(group, ()):
        try:
            for result in measure(source, 5):
                (planted if "kind" in result else equal).append(result)
                robots.add(source.name)
        except (UrdftoolError, RecursionError):
            continue
        if len(robots) == 2:
            break
    if not robots:
        pytest.skip("the robots are not installed")
    assert [result for result in equal if result["invented"]] == []
    missed = [r for r in planted if not r["error"] and (not r["at_its_part"] or r["elsewhere"])]
    assert missed == []
