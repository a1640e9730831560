"""What carries a robot: the ground below its center of mass, and wheels where it has some."""

from dataclasses import replace

import numpy as np
import pytest

from tests.simulation.robots import body, inertial, kinds, runs
from urdftool.api.simulate import run_trials as simulate
from urdftool.model.load import load
from urdftool.report.simulate import format_text
from urdftool.simulation.checks.final_state import measure_final_state
from urdftool.simulation.checks.support import check_support
from urdftool.simulation.recording import Contact
from urdftool.simulation.run import Run
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge

BOX = body('<box size="0.4 0.4 0.1"/>', 4, (0.06, 0.06, 0.1))
WHEEL = (
    '<link name="{side}_wheel"><inertial><mass value="0.3"/><inertia ixx="2e-4" ixy="0" ixz="0" '
    'iyy="3.7e-4" iyz="0" izz="2e-4"/></inertial><collision><origin rpy="1.5708 0 0"/><geometry>'
    '<cylinder radius="0.05" length="0.02"/></geometry></collision></link>'
    '<joint name="{side}_wheel_joint" type="continuous"><origin xyz="-0.05 {y} {z}"/>'
    '<parent link="base_link"/><child link="{side}_wheel"/><axis xyz="0 1 0"/></joint>'
)


def _rover(wheels, caster, chassis=0.1):
    """A base of two wheels and a caster, which ends as high as said above the axles' plane [m]."""
    parts = "".join(
        WHEEL.format(side=side, y=y, z=0.05 + wheels)
        for side, y in (("left", 0.14), ("right", -0.14))
    )
    return (
        f'<robot name="rover"><link name="base_link">{inertial(3, 0.03, 0.04, 0.05, "0 0 0.08")}'
        f'<collision><origin xyz="0 0 {chassis}"/><geometry><box size="0.3 0.2 0.1"/></geometry>'
        f"</collision></link>"
        '<link name="caster"><inertial><mass value="0.05"/><inertia ixx="1e-5" ixy="0" ixz="0" '
        'iyy="1.1e-5" iyz="0" izz="1.2e-5"/></inertial><collision><geometry>'
        '<sphere radius="0.02"/></geometry></collision></link><joint name="caster_joint" '
        f'type="fixed"><origin xyz="0.1 0 {0.02 + caster}"/><parent link="base_link"/>'
        f'<child link="caster"/></joint>{parts}</robot>'
    )


def _judged(write, text, **settings):
    robot = load(write("robot.urdf", text))
    (run,) = simulate(robot, Settings(**settings))
    return judge(robot, run)


def _support(run, robot, **changes):
    altered = Run(run.settings, run.bodies, replace(run.recording, **changes))
    return list(check_support(robot, altered, measure_final_state(altered)))


def _moved(contacts, along):
    """Contacts elsewhere, of a part that the file does not have."""
    x, y = along
    return [replace(c, point=(c.point[0] + x, c.point[1] + y, 0.0)) for c in contacts]


@pytest.mark.parametrize("text", [BOX, _rover(0, 0)], ids=["box", "rover"])
def test_the_ground_carries_the_whole_weight(write, text):
    (run,) = runs(write("robot.urdf", text))
    weight = 9.81 * run.bodies.mass
    assert run.recording.carried == pytest.approx(weight, rel=0.02)
    assert run.recording.carrying


def test_a_steep_slope_carries_what_presses_on_it(write):
    assert _judged(write, BOX, slope=0.8, friction=2.0).stands  # cos 0.8 is 0.7


@pytest.mark.parametrize(("height", "narrow"), [(1.7, True), (0.8, False)])
def test_a_small_tilt_that_tips_a_robot_over_is_named(write, height, narrow):
    column = body(f'<box size="0.05 0.05 {height}"/>', 1, (height**2 / 12, height**2 / 12, 0.0005))
    robot = load(write("robot.urdf", column))
    (run,) = simulate(robot, Settings())
    verdict = judge(robot, run)
    assert verdict.stands
    text = format_text(robot, [verdict])
    assert ("tips the robot over" in text) is narrow


def test_a_robot_beside_its_support_is_not_supported(write):
    path = write("ball.urdf", body('<sphere radius=".1"/>', 1, (0.004,) * 3))
    (run,) = runs(path)
    robot = load(path)
    assert _support(run, robot) == []
    far = _moved(run.recording.carrying, (0.05, 0.0))
    (fault,) = _support(run, robot, carrying=far)
    assert (fault.code, fault.fails, fault.fell) == ("unsupported", True, True)
    assert "50 mm outside the support polygon of 'a'" in fault.message


def test_contacts_inside_the_robot_do_not_carry_it(write):
    path = write("rover.urdf", _rover(0, 0))
    (run,) = runs(path, self_collision=True)
    inner = Contact("left_wheel", "base_link", 0.055, 0.0, (0.0, 0.0, 0.0))
    changes = {"carried": 0.5 * run.recording.carried, "contacts": [inner]}
    (fault,) = _support(run, load(path), **changes)
    assert fault.code == "unsupported"
    assert "N of the" in fault.message
    assert "'left_wheel' and 'base_link' (55 mm)" in fault.cause


def test_wheels_in_the_air_are_reported(write):
    verdict = _judged(write, _rover(0.02, 0, chassis=0.05))
    assert kinds(verdict) == {"wheels-off-ground"}
    (fault,) = [fault for fault in verdict.faults if fault.fails]
    assert fault.what == "link"
    assert "'base_link'" in fault.message
    assert not verdict.fell


def test_a_chassis_on_the_ground_is_a_remark(write):
    verdict = _judged(write, _rover(0, 0, chassis=0.05))
    (fault,) = [fault for fault in verdict.faults if fault.code == "body-on-ground"]
    assert (fault.name, fault.fails) == ("base_link", False)


def test_a_rover_on_wheels_and_caster_has_neither(write):
    verdict = _judged(write, _rover(0, 0))
    assert not {"wheels-off-ground", "body-on-ground", "unsupported"} & {
        fault.code for fault in verdict.faults
    }


@pytest.mark.parametrize("height", [None, 1.0])
def test_without_gravity_nothing_stands(write, height):
    more = '<gazebo reference="a"><turnGravityOff>1</turnGravityOff></gazebo></robot>'
    verdict = _judged(write, BOX.replace("</robot>", more), height=height)
    assert kinds(verdict) == {"unsupported"}
    assert "no gravity acts on the robot" in verdict.faults[0].message
    assert np.isfinite(verdict.run.recording.poses).all()


@pytest.mark.parametrize("engine", ["pybullet", "mujoco"])
def test_a_collision_without_extent_is_left_out_as_in_an_export(write, engine):
    flat = '<collision><geometry><box size="0.4 0 0.4"/></geometry></collision></link>'
    robot = load(write("robot.urdf", BOX.replace("</link>", flat)))
    (run,) = simulate(robot, Settings(), engine=engine)
    verdict = judge(robot, run)
    (fault,) = verdict.faults
    assert (fault.code, fault.fails) == ("no-extent", False)
    assert run.recording.poses[-1, 0, 2] == pytest.approx(0.05, abs=1e-3)
