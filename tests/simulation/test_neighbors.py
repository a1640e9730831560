"""A collision put into the neighbour it is joined to is found; what is so by design is let be."""

import pytest

from tests.conftest import FIXTURES
from tests.simulation import planted
from tests.simulation.robots import simulated


@pytest.fixture(autouse=True)
def trusted(monkeypatch):
    """Let copies of a robot in other folders read its meshes."""
    monkeypatch.setenv("URDFTOOL_TRUST", "1")


ROBOTS = FIXTURES / "robots"
BASE = ROBOTS / "my_robot" / "urdf" / "robot_base.urdf.xacro"
ARM = ROBOTS / "ros2_arm" / "urdf" / "robot2_sound.urdf.xacro"
LASER = ROBOTS / "laser_bot" / "urdf" / "laser_bot.urdf.xacro"
MIRA = ROBOTS / "mira_description" / "urdf" / "mira.urdf"

SOUND = [
    (MIRA, ("head_link",)),
    (BASE, ("front_left_wheel_link", "rear_right_wheel_link")),
    (ARM, ("link_02", "link_04")),
    (LASER, ("link_left_wheel", "link_right_wheel")),
    ("quadruped/minitaur.urdf", ("upper_leg_front_rightR_link", "lower_leg_front_rightR_link")),
    (
        "quadruped/minitaur_derpy.urdf",
        ("upper_leg_front_rightR_link", "lower_leg_front_rightR_link"),
    ),
    ("quadruped/spirit40.urdf", ("upper0", "lower2")),
    ("quadruped/vision60.urdf", ("upper0", "lower2")),
    ("a1/a1.urdf", ("FR_upper", "RL_lower")),
    ("aliengo/aliengo.urdf", ("FR_upper", "FR_lower", "RL_lower")),
    ("mini_cheetah/mini_cheetah.urdf", ("thigh_fr", "shank_hl")),
    ("laikago/laikago_toes_zup.urdf", ("FR_upper_leg", "RL_lower_leg")),
    ("husky/husky.urdf", ("front_left_wheel_link", "rear_right_wheel_link")),
    ("racecar/racecar.urdf", ("left_rear_wheel", "right_front_wheel")),
    ("kuka_iiwa/model_free_base.urdf", ("lbr_iiwa_link_2", "lbr_iiwa_link_4")),
    ("r2d2.urdf", ("right_front_wheel", "head")),
    ("cartpole.urdf", ("pole",)),
    ("TwoJointRobot_wo_fixedJoints.urdf", ("link_1", "link_2")),
]


def source(name):
    if not isinstance(name, str):
        return name
    data = pytest.importorskip("pybullet_data")
    return f"{data.getDataPath()}/{name}"


def joined(verdict):
    """Links whose collision is said to be misplaced into a neighbour."""
    return {
        fault.name
        for fault in verdict.faults
        if fault.code == "interpenetration" and fault.is_warning and "collision of '" in fault.cause
    }


def planted_into(folder, path, name, part):
    tree = planted.expanded(path, folder)
    planted.absolute(tree, path)
    planted.overlapping(tree, name, planted.into_neighbour(path, name, part))
    target = folder / f"{name}.urdf"
    tree.write(target)
    return simulated(target, duration=0.1)


@pytest.mark.parametrize(
    ("robot", "links"),
    [
        pytest.param(robot, links, marks=() if robot == MIRA else pytest.mark.slow)
        for robot, links in SOUND
    ],
    ids=lambda value: getattr(value, "stem", None) or (value if isinstance(value, str) else ""),
)
def test_only_what_is_planted_is_found(tmp_path, robot, links):
    path = source(robot)
    assert not joined(simulated(path, duration=0.1))
    for name in links:
        assert joined(planted_into(tmp_path, path, name, 1.0)) == {name}, name


def test_a_motor_around_a_joint_is_no_fault(write):
    """A hip whose collision stands for the motor of the thigh, beside what is seen of the hip."""
    part = (
        '<inertial><mass value="1"/><inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" '
        'iyz="0"/></inertial>'
    )
    text = (
        f'<robot name="r"><link name="hip">{part}'
        '<visual><geometry><box size=".2 .1 .1"/></geometry></visual>'
        '<collision><origin xyz="0 OFF 0"/><geometry><box size=".1 .06 .1"/></geometry></collision>'
        f'</link><link name="thigh">{part}'
        '<visual><origin xyz="0 0 -.15"/><geometry><box size=".05 .05 .3"/></geometry></visual>'
        '<collision><origin xyz="0 0 -.15"/><geometry><box size=".05 .05 .3"/></geometry>'
        '</collision></link><joint name="j" type="revolute"><parent link="hip"/>'
        '<child link="thigh"/><origin xyz="0 .1 0"/><axis xyz="0 1 0"/>'
        '<limit lower="-1" upper="1" effort="90" velocity="9"/></joint></robot>'
    )
    assert not joined(simulated(write("motor.urdf", text.replace("OFF", ".1")), duration=0.05))
    away = text.replace("0 OFF 0", "0 .1 -.1")
    assert joined(simulated(write("away.urdf", away), duration=0.05)) == {"hip"}


@pytest.mark.parametrize("off", [0.0, 0.02, 0.1])
def test_a_copy_of_what_is_seen_belongs_where_that_is(write, off):
    part = (
        '<inertial><mass value="1"/><inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" '
        'iyz="0"/></inertial>'
    )
    box = '<geometry><box size=".1 .1 .3"/></geometry>'
    text = (
        f'<robot name="r"><link name="a">{part}<visual>{box}</visual><collision>{box}</collision>'
        f'</link><link name="b">{part}<visual><origin xyz="0 0 .1"/>{box}</visual>'
        f'<collision><origin xyz="0 0 {0.1 - off}"/>{box}</collision></link>'
        '<joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
        '<origin xyz="0 0 .1"/><axis xyz="0 1 0"/>'
        '<limit lower="-1" upper="1" effort="90" velocity="9"/></joint></robot>'
    )
    found = joined(simulated(write("r.urdf", text), duration=0.05))
    assert found == ({"b"} if off > 0.075 else set())
