"""MuJoCo as an engine: closed forms, what was read, holding, and the same bytes each time."""

import math

import numpy as np
import pytest

from tests.conftest import FIXTURES
from tests.simulation.robots import kinds
from urdftool.api.load import load as load_any
from urdftool.api.simulate import run_trials as simulate
from urdftool.errors import ModelError
from urdftool.model.load import load
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge

pytest.importorskip("mujoco")

ROBOTS = FIXTURES / "robots"
SPHERE = """<robot name="ball"><link name="ball">
 <inertial><mass value="{mass}"/>
  <inertia ixx="{i}" ixy="0" ixz="0" iyy="{i}" iyz="0" izz="{i}"/></inertial>
 <collision><geometry><sphere radius="{radius}"/></geometry></collision></link></robot>"""
PENDULUM = """<robot name="pendulum"><link name="world"/>
 <joint name="swing" type="{kind}"><parent link="world"/><child link="rod"/>
  <origin xyz="0 0 2"/><axis xyz="0 1 0"/>{more}</joint>
 <link name="rod"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
  <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.001"/></inertial></link></robot>"""


def _run(write, text, **settings):
    robot = load(write("robot.urdf", text))
    (run,) = simulate(robot, Settings(**{"nudge": 0.0, **settings}), engine="mujoco")
    return robot, run


def _ball(radius=0.1, mass=2.0):
    return SPHERE.format(mass=mass, radius=radius, i=0.4 * mass * radius**2)


def test_a_fall_takes_as_long_as_galilei_says(write):
    _, run = _run(write, _ball(), height=2.1, duration=1.5)
    recording = run.recording
    falling = recording.times < math.sqrt(2 * 2 / 9.81) - 0.02
    heights = 2.1 - 9.81 * recording.times**2 / 2
    assert recording.poses[falling, 0, 2] == pytest.approx(heights[falling], abs=0.02)
    touched = recording.times[np.argmax(recording.depths > 0)]
    assert touched == pytest.approx(math.sqrt(2 * 2 / 9.81), abs=recording.times[1])


def test_a_resting_ball_is_as_high_as_its_radius(write):
    for radius in (0.02, 0.1, 1.0):
        _, run = _run(write, _ball(radius))
        assert run.recording.ended == "still"
        assert run.recording.poses[-1, 0, 2] == pytest.approx(radius, rel=0.01)


def test_a_cone_carries_a_robot(write):
    """MuJoCo's geoms have no cone; the link's other shape would not touch the plane."""
    shapes = (
        ("c", "0 0 0.3 0 0 0", "<cone><radius>0.2</radius><length>0.4</length></cone>"),
        ("s", "0 0 0.3 0 0 0", "<sphere><radius>0.05</radius></sphere>"),
    )
    collisions = "".join(
        f'<collision name="{name}"><pose>{pose}</pose><geometry>{shape}</geometry></collision>'
        for name, pose, shape in shapes
    )
    inertia = "<ixx>0.02</ixx><iyy>0.02</iyy><izz>0.02</izz>"
    robot = load_any(
        write(
            "cone.sdf",
            '<sdf version="1.9"><model name="m"><link name="b"><inertial><pose>0 0 0.2 0 0 0</pose>'
            f"<mass>1</mass><inertia>{inertia}</inertia></inertial>{collisions}</link></model></sdf>",
        )
    )
    (run,) = simulate(robot, Settings(nudge=0.0), engine="mujoco")
    assert kinds(judge(robot, run)) == set()
    assert run.recording.poses[-1, 0, 2] == pytest.approx(-0.1, abs=0.005)


def test_a_pendulum_has_its_period(write):
    text = PENDULUM.format(kind="continuous", more="")
    _, run = _run(write, text, hold="none", pose={"swing": 0.1}, duration=10.0)
    angle, times = run.recording.positions[:, 0], run.recording.times
    down = np.flatnonzero((angle[:-1] > 0) & (angle[1:] <= 0))
    cross = times[down] + (times[down + 1] - times[down]) * angle[down] / (
        angle[down] - angle[down + 1]
    )
    inertia = 0.02 + 2 * 0.5**2
    small = 2 * math.pi * math.sqrt(inertia / (2 * 9.81 * 0.5))
    assert np.diff(cross).mean() == pytest.approx(small * (1 + 0.1**2 / 16), rel=0.003)


def test_energy_is_kept_by_what_nothing_brakes(write):
    text = PENDULUM.format(kind="continuous", more="")
    _, run = _run(write, text, hold="none", pose={"swing": 1.0}, duration=5.0)
    total = run.recording.kinetic + run.recording.potential
    assert np.ptp(total) < 0.01 * run.recording.kinetic.max()


@pytest.mark.parametrize("effort", [20.0, 3.0])
def test_a_servo_holds_within_its_effort(write, effort):
    limit = f'<limit effort="{effort}" velocity="1" lower="-3" upper="3"/>'
    robot, run = _run(write, PENDULUM.format(kind="revolute", more=limit), pose={"swing": 1.0})
    needed = 2 * 9.81 * 0.5 * math.sin(1.0)
    at, used = run.recording.positions[-1, 0], run.recording.efforts[-1, 0]
    if effort > needed:
        assert at == pytest.approx(1.0, abs=1e-3)
        assert abs(used) == pytest.approx(needed, rel=0.01)
    else:
        assert abs(at - 1.0) > 0.2
        assert abs(run.recording.efforts).max() == pytest.approx(effort)
        assert not judge(robot, run).stands


def test_a_slope_steeper_than_friction_lets_a_box_slide(write):
    box = """<robot name="box"><link name="box"><inertial><mass value="1"/>
      <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial>
      <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link></robot>"""
    for friction, slides in ((0.5, True), (0.7, False)):
        angle = math.radians(30)
        _, run = _run(write, box, friction=friction, slope=angle, duration=2.0)
        moved, times = run.recording.poses[:, 0, 0], run.recording.times
        if slides:
            rate = 9.81 * (math.sin(angle) - friction * math.cos(angle))
            assert moved[-1] == pytest.approx(rate * times[-1] ** 2 / 2, rel=0.01)
        else:
            assert abs(moved[-1]) < 1e-3


def test_what_was_read_is_what_was_written(write):
    for path in (
        ROBOTS / "mira_description" / "urdf" / "mira.urdf",
        ROBOTS / "my_robot" / "urdf" / "mobile_manipulator.urdf.xacro",
    ):
        (run,) = simulate(load(path), Settings(duration=0.1), engine="mujoco")
        assert run.recording.read_back == []


def test_an_impossible_tensor_is_said_to_be_taken_for_another(write):
    text = SPHERE.format(mass=2, radius=0.1, i=0.008).replace('izz="0.008"', 'izz="0.1"')
    robot, run = _run(write, text, duration=0.1)
    assert [part.what for part in run.recording.read_back] == ["principal moments"]
    assert "impossible-inertia" in kinds(judge(robot, run))


def test_a_payload_weighs(write):
    _, run = _run(write, _ball(), payloads={"ball": 3.0})
    force = sum(contact.force for contact in run.recording.contacts)
    assert force == pytest.approx(5.0 * 9.81, rel=0.01)
    assert run.recording.read_back == []


@pytest.mark.parametrize(
    "path",
    ["mira_description/urdf/mira.urdf", "my_robot/urdf/robot_base.urdf.xacro",
     "laser_bot/urdf/laser_bot.urdf.xacro", "ros2_arm/urdf/robot2_sound.urdf.xacro"],
)  # fmt: skip
def test_fixture_robots_stand(path):
    robot = load(ROBOTS / path)
    (run,) = simulate(robot, Settings(), engine="mujoco")
    verdict = judge(robot, run)
    assert verdict.stands, verdict.faults


def test_the_same_run_gives_the_same_numbers():
    robot = load(ROBOTS / "my_robot" / "urdf" / "robot_base.urdf.xacro")
    settings = Settings(duration=0.5, trials=2, seed=3)
    first, second = (simulate(robot, settings, engine="mujoco") for _ in range(2))
    for one, two in zip(first, second, strict=True):
        for name in ("poses", "velocities", "positions", "efforts", "kinetic", "depths"):
            assert getattr(one.recording, name).tobytes() == getattr(two.recording, name).tobytes()


def test_a_fixed_base_hangs_where_it_is_put():
    robot = load(ROBOTS / "my_robot" / "urdf" / "robot_base.urdf.xacro")
    (run,) = simulate(robot, Settings(fixed_base=True, height=1.0), engine="mujoco")
    assert run.recording.poses[-1, 0, :3] == pytest.approx([0, 0, 1.0])
    assert not run.recording.contacts


def test_a_joint_is_swept_until_links_overlap(write):
    """A bar of 0.5 m that turns about z runs into a post at 90° beside it."""
    robot = load(
        write(
            "robot.urdf",
            """<robot name="r"><link name="base"><collision><origin xyz="0 0.3 0"/><geometry>
  <box size="0.1 0.1 0.1"/></geometry></collision></link>
 <joint name="mid" type="revolute"><parent link="base"/><child link="hub"/><axis xyz="0 0 1"/>
  <limit lower="-0.1" upper="0.1" effort="1" velocity="1"/></joint><link name="hub"/>
 <joint name="turn" type="revolute"><parent link="hub"/><child link="bar"/><axis xyz="0 0 1"/>
  <limit lower="-1.5" upper="1.5" effort="1" velocity="1"/></joint>
 <link name="bar"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.02 0.02"/>
  </geometry></collision></link></robot>""",
        )
    )
    (run,) = simulate(robot, Settings(sweep=True, duration=0.1), engine="mujoco")
    turn = next(joint for joint in run.swept if joint.joint == "turn")
    assert turn.free_lower == -1.5
    corner = math.atan2(0.25, 0.05) - 0.01 / 0.25  # where the bar's upper edge meets the corner
    assert turn.free_upper == pytest.approx(corner, abs=3.0 / 36)
    assert [{hit.one, hit.other} for hit in turn.hits] == [{"bar", "base"}]


WORLD = """<robot name="r">
 <link name="{one}">{part}</link><link name="{other}">{part}</link>
 <joint name="j" type="{kind}"><parent link="{one}"/><child link="{other}"/>
  <origin xyz="0.3 0 0"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="9" velocity="1"/>
  <dynamics damping="-1" friction="-1"/></joint></robot>"""
PART = """<inertial><mass value="1"/>
  <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
 <collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision>"""


@pytest.mark.parametrize("kind", ["revolute", "fixed"])
@pytest.mark.parametrize(
    ("one", "other"), [("world", "b"), ("a", "world"), ("world", "world_link")]
)
def test_a_link_that_moves_may_be_called_world(write, one, other, kind):
    """MuJoCo calls the world so, which has no mass and stays; and damping is not below zero."""
    robot, run = _run(write, WORLD.format(one=one, other=other, kind=kind, part=PART))
    assert run.recording.read_back == []
    verdict = judge(robot, run)
    assert verdict.rest.settled is not None
    assert verdict.faults == []


def test_links_in_a_row_that_are_too_many_are_said(write):
    links = "".join(f'<link name="l{i}"/>' for i in range(600))
    joints = "".join(
        f'<joint name="j{i}" type="fixed"><parent link="l{i}"/><child link="l{i + 1}"/></joint>'
        for i in range(599)
    )
    text = f'<robot name="r">{links}{joints}</robot>'.replace(
        '<link name="l0"/>', f'<link name="l0">{PART}</link>'
    )
    with pytest.raises(ModelError, match="XML nesting limit") as raised:
        _run(write, text)
    assert raised.value.line == 1


def test_a_joint_with_equal_limits_is_read_as_it_is_written(write):
    limit = '<limit effort="9" velocity="1" lower="0" upper="0"/>'
    robot, run = _run(write, PENDULUM.format(kind="revolute", more=limit), duration=0.5)
    assert run.recording.read_back == []
    assert run.recording.positions.shape[1] == 1
    assert np.abs(run.recording.positions).max() < 0.01
    assert "engine-readback-mismatch" not in kinds(judge(robot, run))
