"""The bodies that an engine loads have the mass properties that the file specifies."""

import numpy as np
import pytest

from tests.simulation.robots import inertial
from urdftool.api.simulate import run_trials
from urdftool.model.load import load
from urdftool.simulation.engines.registry import REGISTRY
from urdftool.simulation.settings import Settings

PLATE = (
    f'<robot name="r"><link name="base">{inertial(5, 0.05, 0.05, 0.05)}<collision><geometry>'
    f'<box size="0.3 0.3 0.2"/></geometry></collision></link>'
    f'<link name="arm">{inertial(1, 0.002, 0.002, 0.002)}</link>'
    f'<link name="flange">{{flange}}</link>'
    '<joint name="j" type="revolute"><origin xyz="0 0 0.1"/><parent link="base"/>'
    '<child link="arm"/><axis xyz="0 0 1"/>'
    '<limit lower="-1" upper="1" effort="10" velocity="1"/></joint>'
    '<joint name="f" type="fixed"><origin xyz="0 0.3 0" rpy="0 0 1.5707963267948966"/>'
    '<parent link="arm"/><child link="flange"/></joint></robot>'
)


@pytest.mark.parametrize(
    ("flange", "expected"),
    [
        (inertial(0, 0.0002, 0.0003, 0.0004, xyz="0.5 0 0"), (0.0023, 0.0022, 0.0024)),
        (inertial(0, 0, 0, 0, xyz="0.5 0 0"), (0.002, 0.002, 0.002)),
        ("", (0.002, 0.002, 0.002)),
    ],
    ids=["tensor without mass", "zeros", "without inertial"],
)
@pytest.mark.parametrize("engine", REGISTRY)
def test_a_fixed_link_adds_its_tensor_also_without_mass(write, engine, flange, expected):
    """The tensor about the common center of mass is a sum; a mass of 0 does not shift it."""
    pytest.importorskip(engine)
    robot = load(write("r.urdf", PLATE.format(flange=flange)))
    (run,) = run_trials(robot, Settings(duration=0.1), engine=engine)
    arm = run.bodies.bodies[1].properties
    assert (arm.mass, arm.com) == (1.0, (0.0, 0.0, 0.0))
    np.testing.assert_allclose(np.diag(arm.inertia), expected, rtol=1e-12)
    assert run.recording.read_back == []
