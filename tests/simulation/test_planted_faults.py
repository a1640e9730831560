"""A sound robot with one fault planted does not pass; each fault on at least three robots."""

# ruff: noqa: E501 -- a table

import math

import pytest

from tests.conftest import FIXTURES
from tests.simulation import planted
from tests.simulation.robots import kinds, simulated


@pytest.fixture(autouse=True)
def trusted(monkeypatch):
    """Let copies of a robot in other folders read its meshes."""
    monkeypatch.setenv("URDFTOOL_TRUST", "1")


ROBOTS = FIXTURES / "robots"
MIRA = ROBOTS / "mira_description" / "urdf" / "mira.urdf"
BASE = ROBOTS / "my_robot" / "urdf" / "robot_base.urdf.xacro"
ARM = ROBOTS / "ros2_arm" / "urdf" / "robot2_sound.urdf.xacro"
LASER = ROBOTS / "laser_bot" / "urdf" / "laser_bot.urdf.xacro"
TILTED = {"slope": math.radians(10)}

slow = pytest.mark.slow

CASES = [
    pytest.param(BASE, "no_collision", ("front_left_wheel_link",), {}, "missing-contact-geometry"),
    pytest.param(BASE, "no_collision", ("rear_right_wheel_link",), {}, "missing-contact-geometry", marks=slow),
    pytest.param(LASER, "no_collision", ("link_left_wheel",), {}, "missing-contact-geometry", marks=slow),
    pytest.param("husky/husky.urdf", "no_collision", ("front_left_wheel_link",), {}, "missing-contact-geometry",
                 marks=slow),
    pytest.param(MIRA, "identity_inertia", ("yaw_M3_link",), {}, "inertia-too-large"),
    pytest.param(BASE, "identity_inertia", ("front_left_wheel_link",), {}, "inertia-too-large", marks=slow),
    pytest.param(LASER, "identity_inertia", ("link_chassis",), {}, "inertia-too-large", marks=slow),
    pytest.param(ARM, "thousandfold_mass", ("link_03",), {}, "too-dense", marks=slow),
    pytest.param(MIRA, "thousandfold_mass", ("pitch_M2_link",), {}, "too-dense", marks=slow),
    pytest.param(LASER, "thousandfold_mass", ("link_left_wheel",), {}, "too-dense", marks=slow),
    pytest.param(MIRA, "millimetres", ("base_link",), {}, "too-large", marks=slow),
    pytest.param(BASE, "millimetres", ("front_left_wheel_link",), {}, "too-large", marks=slow),
    pytest.param("husky/husky.urdf", "collision_in_millimeters", ("base_link",), {}, "too-large", marks=slow),
    pytest.param("a1/a1.urdf", "collision_in_millimeters", ("trunk",), {}, "too-large", marks=slow),
    pytest.param(ARM, "overlapping", ("link_04", (0.0, 0.0, -1.2)), {}, "interpenetration", marks=slow),
    pytest.param(BASE, "overlapping", ("front_left_wheel_link", (0.0, -0.48, 0.0)), {}, "interpenetration",
                 marks=slow),
    pytest.param("a1/a1.urdf", "overlapping", ("FR_lower", (0.0, 0.26, 0.0)), {}, "interpenetration", marks=slow),
    pytest.param(LASER, "no_friction", (), TILTED, "slid", marks=slow),
    pytest.param(BASE, "no_friction", (), TILTED, "slid", marks=slow),
    pytest.param(MIRA, "no_friction", (), TILTED, "slid", marks=slow),
    pytest.param(BASE, "overlapping", ("front_left_wheel_link", (0.0, -0.25, 0.05)), {}, "interpenetration"),
    pytest.param("laikago/laikago_toes_zup.urdf", "overlapping", ("RL_lower_leg", (0.0, 0.25, 0.0)), {},
                 "interpenetration", marks=slow),
    pytest.param("laikago/laikago_toes_zup.urdf", "no_collision", ("toeRL",), {}, "missing-contact-geometry",
                 marks=slow),
    pytest.param("laikago/laikago_toes_zup.urdf", "identity_inertia", ("chassis",), {},
                 "inertia-too-large", marks=slow),
    pytest.param("quadruped/minitaur_derpy.urdf", "no_inertia", ("base_chassis_link",), {}, "no-mass",
                 marks=slow),
    pytest.param("quadruped/spirit40.urdf", "no_inertia", ("lower0",), {}, "no-mass", marks=slow),
    pytest.param("r2d2.urdf", "no_inertia", ("base_link",), {}, "no-mass", marks=slow),
    pytest.param(BASE, "no_inertia", ("base_link",), {}, "no-mass"),
    pytest.param(ARM, "no_inertia", ("base_link",), {}, "no-mass", marks=slow),
    pytest.param(MIRA, "no_inertia", ("base_link",), {}, "no-mass", marks=slow),
]  # fmt: skip


def source(name):
    if not isinstance(name, str):
        return name
    data = pytest.importorskip("pybullet_data")
    return f"{data.getDataPath()}/{name}"


@pytest.mark.parametrize(("robot", "fault", "where", "settings", "kind"), CASES)
def test_a_planted_fault_does_not_pass(tmp_path, robot, fault, where, settings, kind):
    path = source(robot)
    tree = planted.expanded(path, tmp_path)
    planted.absolute(tree, path)
    getattr(planted, fault)(tree, *where)
    tree.write(tmp_path / "planted.urdf")
    verdict = simulated(tmp_path / "planted.urdf", **settings)
    assert kind in kinds(verdict)


@pytest.mark.parametrize(
    "robot", [BASE, pytest.param(LASER, marks=slow), pytest.param(MIRA, marks=slow)]
)
def test_the_same_robots_stand_on_the_slope_with_the_friction_they_have(robot):
    verdict = simulated(robot, slope=math.radians(5))
    assert verdict.stands, verdict.faults
