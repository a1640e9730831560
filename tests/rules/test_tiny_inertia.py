"""What ``tiny-moving-inertia`` and ``stiff-joint-damping`` say, against PyBullet and MuJoCo.

An arm of 1 kg carries a link of 1 g about whose joint the inertia, damping and effort vary. The
tables of the rules' pages come from here.
"""

import math

import pytest

from tests.cases import list_cases
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings

ROBOT = """<?xml version="1.0"?>
<robot name="tiny">
  <link name="world"/>
  <link name="base">
    <inertial>
      <mass value="5"/>
      <inertia ixx="0.05" ixy="0" ixz="0" iyy="0.05" iyz="0" izz="0.05"/>
    </inertial>
  </link>
  <joint name="bolted" type="fixed"><parent link="world"/><child link="base"/></joint>
  <link name="arm">
    <inertial>
      <origin xyz="0.15 0 0"/><mass value="1"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>
    </inertial>
  </link>
  <joint name="lift" type="revolute">
    <parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="50" velocity="10"/>
  </joint>
  <link name="tiny">
    <inertial>
      <mass value="0.001"/>
      <inertia ixx="{inertia}" ixy="0" ixz="0" iyy="{inertia}" iyz="0" izz="{inertia}"/>
    </inertial>
  </link>
  <joint name="turn" type="revolute">
    <parent link="arm"/><child link="tiny"/><origin xyz="0.3 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="{effort}" velocity="10"/>
    <dynamics damping="{damping}"/>
  </joint>
</robot>
"""

FASTEST = 50.0
"""Speed [rad/s] of a joint that diverges; what swings freely here stays below 10."""


def _robot(inertia, damping=0.0, effort=1.0):
    return ROBOT.format(inertia=inertia, damping=damping, effort=effort)


def _torque(effort, inertia, position, speed):
    """A controller that is critically damped and reaches full effort at an error of 0.1 rad."""
    stiffness = effort / 0.1
    torque = stiffness * (0.3 - position) - 2 * math.sqrt(stiffness * inertia) * speed
    return max(-effort, min(effort, torque))


def _pybullet(tmp_path, robot, step, effort=0.0, inertia=0.0):
    """The highest speed [rad/s] in 2 s, and that of the joint ``turn`` in the last 0.1 s."""
    bullet = pytest.importorskip("pybullet")
    path = tmp_path / "tiny.urdf"
    path.write_text(robot)
    client = bullet.connect(bullet.DIRECT)
    try:
        bullet.setGravity(0, 0, -9.81)
        bullet.setTimeStep(step)
        body = bullet.loadURDF(
            str(path), useFixedBase=True, flags=bullet.URDF_USE_INERTIA_FROM_FILE
        )
        names = [bullet.getJointInfo(body, i)[1] for i in range(bullet.getNumJoints(body))]
        lift, turn = names.index(b"lift"), names.index(b"turn")
        for joint in (lift, turn):
            bullet.setJointMotorControl2(body, joint, bullet.VELOCITY_CONTROL, force=0)
        fastest, last, count = 0.0, 0.0, round(2 / step)
        for number in range(count):
            if effort:
                state = bullet.getJointState(body, turn)
                torque = _torque(effort, inertia, *state[:2])
                bullet.setJointMotorControl2(body, turn, bullet.TORQUE_CONTROL, force=torque)
            bullet.stepSimulation()
            speeds = [abs(bullet.getJointState(body, joint)[1]) for joint in (lift, turn)]
            fastest = max(fastest, *speeds)
            if number * step > 1.9:
                last = max(last, speeds[1])
    finally:
        bullet.disconnect(client)
    return fastest, last


def _mujoco(robot, step, effort=0.0, inertia=0.0, rk4=False):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(robot)
    model.opt.timestep = step
    if rk4:
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    data = mujoco.MjData(model)
    fastest, last = 0.0, 0.0
    for number in range(round(2 / step)):
        if effort:
            data.qfrc_applied[1] = _torque(effort, inertia, data.qpos[1], data.qvel[1])
        mujoco.mj_step(model, data)
        fastest = max(fastest, float(abs(data.qvel).max()))
        if fastest > 1e6 or any(warning.number for warning in data.warning):
            return math.inf, math.inf
        if number * step > 1.9:
            last = max(last, abs(float(data.qvel[1])))
    return fastest, last


def _found(tmp_path, robot, *targets, select=("tiny-moving-inertia",)):
    path = tmp_path / "linted.urdf"
    path.write_text(robot)
    settings = Settings(select=select, targets=frozenset(targets))
    return [finding.code for finding in check_file(path, Options(settings)).findings]


@pytest.mark.parametrize("inertia", list_cases([1e-13, 1e-6, 5e-8, 1e-11], 4))
@pytest.mark.parametrize("step", [0.001, 0.004])
def test_a_small_inertia_alone_does_no_harm(tmp_path, inertia, step):
    robot = _robot(inertia, effort=0.0)
    assert _pybullet(tmp_path, robot, step)[0] < 10
    assert _mujoco(robot, step)[0] < 10
    assert _found(tmp_path, robot, "pybullet", "mujoco") == []


@pytest.mark.parametrize(
    ("damping", "step"),
    [
        *((0.001, 0.001), (0.001, 0.004), (0.1, 0.004)),
        *(pytest.param(*one, marks=pytest.mark.slow) for one in ((0.01, 0.001), (0.1, 0.001))),
    ],
)
def test_pybullet_oscillates_from_half_of_damping_times_step(tmp_path, damping, step):
    least = damping * step / 2
    assert _pybullet(tmp_path, _robot(0.98 * least, damping), step)[0] > FASTEST
    assert _pybullet(tmp_path, _robot(1.02 * least, damping), step)[0] < FASTEST
    assert _mujoco(_robot(0.01 * least, damping), step)[0] < 10
    assert _mujoco(_robot(0.34 * 2 * least, damping), step, rk4=True)[0] > FASTEST
    assert _mujoco(_robot(0.38 * 2 * least, damping), step, rk4=True)[0] < FASTEST


@pytest.mark.parametrize("damping", [1e-5, 1e-4])
def test_the_rule_speaks_of_damping_where_pybullet_oscillates(tmp_path, damping):
    least = damping * 0.001 / 2
    for factor, diverges in ((0.9, True), (1.1, False)):
        robot = _robot(factor * least, damping, effort=0.0)
        assert (_pybullet(tmp_path, robot, 0.001)[0] > FASTEST) == diverges
        assert bool(_found(tmp_path, robot, "pybullet")) == diverges
        assert not _found(tmp_path, robot, "mujoco")
        assert bool(_found(tmp_path, robot, select=("stiff-joint-damping",))) == diverges


@pytest.mark.parametrize("effort", list_cases([0.01, 1.0], 2))
def test_a_torque_that_throws_the_link_in_one_step_does_not_settle(tmp_path, effort):
    """At 0.01 rad of E·Δt²/I a controller settles, at 0.1 rad it does not."""
    for thrown, settles in ((0.01, True), (0.1, False), (1.0, False)):
        inertia = effort * 0.001**2 / thrown
        robot = _robot(inertia, effort=effort)
        for _, last in (
            _pybullet(tmp_path, robot, 0.001, effort, inertia),
            _mujoco(robot, 0.001, effort, inertia),
        ):
            assert (last < 0.01) == settles, (thrown, last)


def test_the_rule_speaks_of_effort_where_one_step_passes_the_range(tmp_path):
    """The range of the joint is 2 rad; 5e-8 kg·m² go 20 rad with 1 N·m, and 1 rad with 0.05."""
    assert _found(tmp_path, _robot(5e-8, effort=1.0), "mujoco") == ["tiny-moving-inertia"]
    assert _found(tmp_path, _robot(5e-8, effort=0.05), "mujoco") == []
    assert _mujoco(_robot(5e-8, effort=1.0), 0.001, 1.0, 5e-8)[0] > 1000
