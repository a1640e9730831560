"""Robots of example-robot-data and pybullet_data run in MuJoCo as they are exported."""

import pytest

from .runs import outcomes, robots

KNOWN = ("simple_humanoid", "tiago_pro")
"""Robots that do not hold still in any case: docs/formats/mjcf.md says why."""


@pytest.mark.slow
@pytest.mark.library("mujoco")
def test_robots_run_at_home_with_the_base_held():
    paths = robots()
    if not paths:
        pytest.skip("neither example-robot-data nor pybullet_data is installed")
    failed = [
        f"{outcome.name}: {outcome.faults}"
        for outcome in outcomes(paths, {"base": "fixed"}, jobs=2)
        if not outcome.refused and not outcome.runs and not any(k in outcome.name for k in KNOWN)
    ]
    assert failed == []
