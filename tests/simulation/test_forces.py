"""Efforts of held joints against the static balance, also with gravity flags and springs."""

from importlib.util import find_spec

import numpy as np
import pytest

from tests.simulation.robots import inertial, kinds
from urdftool.api.simulate import run_trials as simulate
from urdftool.model.load import load
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge

G = 9.81
ENGINES = [
    pytest.param(engine, marks=pytest.mark.skipif(not find_spec(library), reason=library))
    for engine, library in (("pybullet", "pybullet"), ("mujoco", "mujoco"))
]


def _link(name, mass, xyz="0 0 0", more=""):
    moments = (mass * moment for moment in (0.004, 0.005, 0.006))
    return f'<link name="{name}">{inertial(mass, *moments, xyz)}{more}</link>'


def _joint(name, parent, child, xyz, axis="0 1 0", effort=500, kind="revolute"):
    return (
        f'<joint name="{name}" type="{kind}"><origin xyz="{xyz}"/><parent link="{parent}"/>'
        f'<child link="{child}"/><axis xyz="{axis}"/>'
        f'<limit lower="-2" upper="2" effort="{effort}" velocity="3"/></joint>'
    )


def _collision(xyz, size):
    return f'<collision><origin xyz="{xyz}"/><geometry><box size="{size}"/></geometry></collision>'


BASE = _link("base", 20, more=_collision("0 0 0.1", "0.2 0.2 0.2"))
# the hand reaches 0.1 m below the foot of the base
ARM = (
    '<robot name="arm">'
    + BASE
    + _link("upper", 4, "0.25 0 0", _collision("0.25 0 0", "0.5 0.06 0.06"))
    + _link("lower", 2, "0.2 0 -0.1", _collision("0.2 0 0", "0.4 0.05 0.05"))
    + _link("hand", 0.5, "0 0 -0.1", _collision("0 0 -0.2", "0.04 0.04 0.2"))
    + _joint("pan", "base", "upper", "0 0 0.2", "0 0 1")
    + _joint("elbow", "upper", "lower", "0.5 0 0")
    + _joint("slide", "lower", "hand", "0.4 0 0", "0 0 1", kind="prismatic")
    + "{more}</robot>"
)
CART = (
    '<robot name="cart">'
    + BASE
    + _link("arm", 2, "0.2 0 0", _collision("0.2 0 0", "0.3 0.04 0.04"))
    + _joint("lift", "base", "arm", "0.1 0 0.3", effort=1)
    + "{more}</robot>"
)
FLAGS = [
    "<turnGravityOff>true</turnGravityOff>",
    "<gravity>false</gravity>",
    "<gravity>0</gravity>",
]


def _run(write, text, engine, **settings):
    robot = load(write("robot.urdf", text))
    (run,) = simulate(robot, Settings(**settings), engine=engine)
    return run, judge(robot, run)


def _efforts(run):
    return dict(zip(run.recording.joints, run.recording.efforts[-1].tolist(), strict=True))


@pytest.mark.parametrize("engine", ENGINES)
def test_an_arm_on_a_fixed_base_holds_its_weight_and_no_more(write, engine):
    run, verdict = _run(write, ARM.format(more=""), engine, fixed_base=True)
    assert _efforts(run) == pytest.approx(
        {"pan": 0.0, "elbow": -G * (2 * 0.2 + 0.5 * 0.4), "slide": G * 0.5}, rel=0.01, abs=0.02
    )
    assert verdict.rest.supports == ()
    assert {fault.code for fault in verdict.faults} <= {"interpenetration"}


MASS = """<inertial><mass value="0.01"/>
  <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>"""


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("base", ["fixed", "world", "world with mass"])
def test_efforts_are_those_of_inverse_dynamics(write, engine, base):
    mujoco = pytest.importorskip("mujoco")
    text = ARM.format(more="")
    if base != "fixed":
        inside = MASS if base == "world with mass" else ""
        weld = f'<link name="world">{inside}</link><joint name="weld" type="fixed">'
        weld += '<parent link="world"/>'
        text = text.replace("</robot>", f'{weld}<child link="base"/></joint></robot>')
    pose = {"pan": 0.4, "elbow": -0.7, "slide": 0.1}
    run, _ = _run(write, text, engine, fixed_base=base == "fixed", pose=pose)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for name, value in pose.items():
        data.qpos[model.joint(name).qposadr[0]] = value
    mujoco.mj_inverse(model, data)
    expected = {name: float(data.qfrc_inverse[model.joint(name).dofadr[0]]) for name in pose}
    assert abs(expected["elbow"]) > 5
    assert _efforts(run) == pytest.approx(expected, rel=0.01, abs=0.02)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_fixed_base_without_parts_below_it_stands_on_the_plane(write, engine):
    run, _ = _run(write, CART.format(more=""), engine, fixed_base=True)
    assert run.recording.poses[0, 0, 2] == pytest.approx(1e-4)


@pytest.mark.parametrize("engine", ENGINES)
def test_an_arm_too_heavy_for_its_joint_sags(write, engine):
    _, verdict = _run(write, CART.format(more=""), engine)
    assert "joint-drift" in kinds(verdict)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("flag", FLAGS)
def test_gravity_does_not_act_where_the_file_says_so(write, engine, flag):
    more = f'<gazebo reference="arm">{flag}</gazebo>'
    run, verdict = _run(write, CART.format(more=more), engine)
    assert kinds(verdict) == set()
    assert _efforts(run)["lift"] == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_robot_without_gravity_stays_where_it_is(write, engine):
    more = "".join(f'<gazebo reference="{name}">{FLAGS[0]}</gazebo>' for name in ("base", "arm"))
    run, _ = _run(write, CART.format(more=more), engine, height=1.0, duration=2.0)
    assert np.abs(run.recording.poses[:, 0, 2] - 1.0).max() < 1e-3
    assert np.abs(run.recording.potential).max() < 1e-3


@pytest.mark.parametrize("engine", ENGINES)
def test_a_spring_carries_its_part(write, engine):
    stiffness, rest = 40.0, -2 * G * 0.2 / 40
    more = (
        f'<gazebo reference="lift"><springStiffness>{stiffness}</springStiffness>'
        f"<springReference>{rest}</springReference></gazebo>"
    )
    run, verdict = _run(write, CART.format(more=more), engine)
    assert kinds(verdict) == set()
    assert _efforts(run)["lift"] == pytest.approx(0.0, abs=0.05)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_limp_joint_swings_about_the_balance_of_its_spring(write, engine):
    more = '<gazebo reference="lift"><springStiffness>40</springStiffness></gazebo>'
    settings = {
        "hold": "none",
        "fixed_base": True,
        "duration": 3.0,
        "nudge": 0.0,
        "timestep": 0.0005,
    }
    run, _ = _run(write, CART.format(more=more), engine, **settings)
    angle = run.recording.positions[:, 0]
    assert (angle.max() + angle.min()) / 2 == pytest.approx(2 * G * 0.2 / 40, rel=0.03)
    energy = run.recording.kinetic + run.recording.potential
    assert np.ptp(energy) < 0.1 * run.recording.kinetic.max()
