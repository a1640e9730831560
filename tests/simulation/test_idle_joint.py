"""A joint that is away from where it is held, and does not use what it may, says why."""

import pytest

from tests.simulation.robots import inertial, runs
from urdftool.simulation.checks.joints import _explain_why_idle

BOX = '<collision><geometry><box size=".1 .1 .1"/></geometry></collision>'


@pytest.mark.parametrize(
    ("largest", "said"), [(0.01, "blocked"), (0.1, "physically inconsistent inertia")]
)
def test_why_a_joint_is_idle(write, largest, said):
    text = (
        f'<robot name="r"><link name="a">{inertial(1, 0.01, 0.01, 0.01)}{BOX}</link>'
        f'<link name="b">{inertial(1, 0.01, 0.01, largest)}{BOX}</link>'
        '<joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
        '<origin xyz="0 0 .2"/><axis xyz="0 1 0"/>'
        '<limit lower="-1" upper="1" effort="9" velocity="9"/></joint></robot>'
    )
    (run,) = runs(write("r.urdf", text), duration=0.01)
    assert said in _explain_why_idle(run, 0)
