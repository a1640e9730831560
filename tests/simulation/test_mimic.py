"""Joints that mimic others are where these send them, in both engines."""

from __future__ import annotations

from importlib.util import find_spec

import pytest

from urdftool.api.simulate import run_trials as simulate
from urdftool.model.load import load
from urdftool.report.simulate import describe_holding
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge

LINK = """
  <link name="{name}">
    <inertial><mass value="0.1"/>
      <inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/></inertial>
  </link>"""
JOINT = """
  <joint name="{name}" type="revolute">
    <parent link="base"/><child link="{child}"/><origin xyz="0 {at} 0"/><axis xyz="0 0 1"/>
    <limit lower="-{limit}" upper="{limit}" effort="10" velocity="5"/>{mimic}
  </joint>"""
FOLLOWERS = {
    "double": ("2", "0.1", 3.0, 0.9),
    "back": ("-1", "0", 3.0, -0.4),
    "stopped": ("2", "0.1", 0.6, 0.6),
}
"""Multiplier, offset, limit [rad], and where it belongs with its leader at 0.4 rad."""


@pytest.fixture
def robot(write):
    text = "".join(LINK.format(name=name) for name in ("base", "l", *FOLLOWERS))
    text += JOINT.format(name="leader", child="l", at=0, limit=3, mimic="")
    for at, (name, (multiplier, offset, limit, _)) in enumerate(FOLLOWERS.items(), 1):
        mimic = f'<mimic joint="leader" multiplier="{multiplier}" offset="{offset}"/>'
        text += JOINT.format(name=f"{name}_joint", child=name, at=at, limit=limit, mimic=mimic)
    return load(write("r.urdf", f'<robot name="r">{text}\n</robot>\n'))


@pytest.mark.parametrize(("engine", "library"), [("pybullet", "pybullet"), ("mujoco", "mujoco")])
def test_followers_are_where_their_leader_sends_them(robot, engine, library):
    if find_spec(library) is None:
        pytest.skip(f"{library} is not installed")
    settings = Settings(fixed_base=True, pose={"leader": 0.4}, duration=1.0)
    (run,) = simulate(robot, settings, engine=engine)
    assert ("does not reach their leaders" in describe_holding(judge(robot, run))) is (
        engine == "pybullet"
    )
    ends = dict(zip(run.recording.joints, run.recording.positions[-1], strict=True))
    assert ends["leader"] == pytest.approx(0.4, abs=5e-3)
    for name, (_, _, _, expected) in FOLLOWERS.items():
        if name == "stopped" and engine == "mujoco":
            continue  # its equality constraint pushes through the limit
        assert ends[f"{name}_joint"] == pytest.approx(expected, abs=0.02), name
