"""Controllers of YAML files: what they do to joints, and what is said of files that are wrong."""

import math
from importlib.util import find_spec

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.conftest import FIXTURES
from tests.simulation.robots import kinds
from urdftool import cli
from urdftool.api.simulate import run_trials as simulate
from urdftool.errors import UrdftoolError
from urdftool.model.load import load
from urdftool.simulation.control import NONE, POSITION, SERVO, VELOCITY, Control, Pid, Pids
from urdftool.simulation.controllers import read_controllers
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import judge

ROBOTS = FIXTURES / "robots"
ENGINES = [
    pytest.param(engine, marks=pytest.mark.skipif(not find_spec(library), reason=library))
    for engine, library in (("pybullet", "pybullet"), ("mujoco", "mujoco"))
]
ARM = """<robot name="arm"><link name="world"/>
 <joint name="swing" type="revolute"><parent link="world"/><child link="rod"/>
  <origin xyz="0 0 2"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="50" velocity="9"/>
  <dynamics damping="{damping}"/></joint>
 <link name="rod"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
  <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial>
  <collision><origin xyz="0.5 0 0"/><geometry><sphere radius="0.3"/></geometry></collision></link>
 {more}</robot>"""
ROS1 = """\
arm:
  swing_controller:
    type: effort_controllers/JointPositionController
    joint: swing
    pid: {gains}
"""


@pytest.fixture
def arm(write):
    def make(damping=1.0, more=""):
        return load(write("arm.urdf", ARM.format(damping=damping, more=more)))

    return make


def _held(robot, path, engine, **settings):
    controls = read_controllers(path, robot).joints
    settings = {"nudge": 0.0, "duration": 5.0, **settings}
    (run,) = simulate(robot, Settings(controls=controls, **settings), engine=engine)
    return run, judge(robot, run)


def test_mira_is_driven_by_effort():
    robot = load(ROBOTS / "mira_description" / "urdf" / "mira.urdf")
    controls = read_controllers(str(ROBOTS / "mira_description" / "config" / "mira.yaml"), robot)
    assert list(controls.joints) == ["roll_joint", "pitch_joint", "yaw_joint"]
    assert {(c.kind, c.pid) for c in controls.joints.values()} == {(POSITION, Pid(1.0, 1.0))}


def test_the_mobile_manipulator_is_driven_by_velocity_and_position():
    robot = load(ROBOTS / "my_robot" / "urdf" / "mobile_manipulator.urdf.xacro")
    joints = read_controllers(str(ROBOTS / "my_robot" / "config" / "control.yaml"), robot).joints
    assert joints["front_left_wheel_joint"].kind == VELOCITY
    assert joints["front_left_wheel_joint"].pid == Pid(20.0, 0.01)
    assert joints["elbow_joint"].kind == SERVO
    assert len(joints) == 9


def test_ros2_names_types_apart_from_parameters():
    robot = load(ROBOTS / "ros2_arm" / "urdf" / "robot2_sound.urdf.xacro")
    joints = read_controllers(str(ROBOTS / "ros2_arm" / "config" / "control.yaml"), robot).joints
    assert {name: control.kind for name, control in joints.items()} == {
        f"joint_{number}": SERVO for number in range(1, 6)
    }


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("c:\n  type: effort_controllers/JointVelocityController\n  joint: swing\n"
         "  pid: {p: 3}\n", VELOCITY),
        ("c:\n  type: effort_controllers/JointGroupEffortController\n  joints: [swing]\n", NONE),
        ("c:\n  type: effort_controllers/JointGroupPositionController\n  joints: [swing]\n"
         "  swing/pid: {p: 3}\n", POSITION),
        ("c:\n  type: velocity_controllers/JointVelocityController\n  joint: swing\n", SERVO),
        ("c:\n  type: effort_controllers/JointTrajectoryController\n  joints: [swing]\n"
         "  gains:\n    swing: {p: 3, i_clamp: 2}\n", POSITION),
        ("/**:\n  c:\n    ros__parameters:\n"
         "      type: joint_trajectory_controller/JointTrajectoryController\n"
         "      joints: [swing]\n      command_interfaces: [effort]\n"
         "      gains.swing.p: 3.0\n", POSITION),
        ("/ns/controller_manager:\n  ros__parameters:\n    c:\n"
         "      type: pid_controller/PidController\n"
         "/ns/c:\n  ros__parameters:\n    dof_names: [swing]\n    command_interface: effort\n"
         "    reference_and_state_interfaces: [velocity]\n    gains: {swing: {p: 3}}\n", VELOCITY),
        ("x: &x {p: 3}\nc:\n  type: effort_controllers/JointPositionController\n"
         "  joint: swing\n  pid:\n    <<: *x\n    d: 1\n", POSITION),
        ("c:\n  type: position_controllers/JointPositionController\n  joint: swing\n"
         "gazebo_ros_control:\n  pid_gains:\n    swing: {p: 3}\n", POSITION),
    ],
)  # fmt: skip
def test_what_controllers_do(arm, write, text, kind):
    control = read_controllers(write("c.yaml", text), arm()).joints["swing"]
    assert control.kind == kind
    assert control.pid is None or control.pid.p == 3.0


_C = "c:\n  type: effort_controllers/JointPositionController\n"


@pytest.mark.parametrize(
    ("text", "where", "said"),
    [
        ("", "1", "is empty"),
        ("- a\n", "1", "is not a mapping"),
        ("a: [\n", "2:1", "is not valid YAML"),
        ("a: \x00\n", "c.yaml", "is not valid YAML"),
        ("a: 1\n", "1", "has no controller"),
        (_C + "  joint: swng\n  pid: {p: 1}\n", "3:10", "did you mean 'swing'?"),
        (_C + "  joint: $(var side)_swing\n", "3:10", "write the name"),
        (_C + "  joint: [swing]\n", "2:9", "has no gains of joint 'swing'; write pid"),
        (_C + "  joint: swing\n  pid: 3\n", "4:8", "gains are '3'"),
        (_C + "  joint: swing\n  pid: {i: 3}\n", "4:8", "gains have no p"),
        (_C + "  joint: swing\n  pid: {p: big}\n", "4:12", "p is 'big', not a finite"),
        (_C + "  joint: swing\n  pid: {p: '1'}\n", "4:12", "not a finite number"),
        (_C + "  joint: swing\n  pid: {p: .nan}\n", "4:12", "not a finite number"),
        (_C + "  joint: {a: b}\n", "3:10", "joint is a mapping"),
        (_C, "2:9", "names no joint"),
        ("c:\n  type: diff_drive_controller/DiffDriveController\n", "2:9", "names no wheels"),
        ("c:\n  type: forward_command_controller/ForwardCommandController\n  joints: [swing]\n",
         "2:9", "has no command interface"),
        ("a: &a [x, x, x, x, x, x, x, x, x]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a]\n"
         "c: &c [*b,*b,*b,*b,*b,*b,*b,*b,*b]\nd: &d [*c,*c,*c,*c,*c,*c,*c,*c,*c]\n"
         "e: &e [*d,*d,*d,*d,*d,*d,*d,*d,*d]\nf: [*e,*e,*e,*e,*e,*e,*e,*e,*e]\n", "",
         "aliases"),
        ("a: &a [*a]\n", "", "deep"),
        ("[" * 5000, "", "nested too deeply"),
        ("a: 1\n---\n- b\n", "1", "is not a mapping"),
        ("a: " + "x" * 300_000, "", "has 300003 bytes"),
        ("!!python/object/apply:os.system [ls]\n", "1", "is not a mapping"),
    ],
)  # fmt: skip
def test_a_wrong_file_is_one_message_with_its_place(arm, write, text, where, said):
    path = write("c.yaml", text)
    with pytest.raises(UrdftoolError) as caught:
        read_controllers(path, arm())
    assert said in str(caught.value)
    assert where in str(caught.value)


_MANAGER = """\
/**:
  controller_manager:
    ros__parameters:
      update_rate: 100
      arm:
        type: joint_trajectory_controller/JointTrajectoryController
"""
_ARM = """\
/**:
  arm:
    ros__parameters:
      joints: [swing]
      command_interfaces: [effort]
      gains: {swing: {p: 3.0}}
"""


@pytest.mark.parametrize("between", ["", "---\n", "/**:\n  other: {ros__parameters: {}}\n"])
@pytest.mark.parametrize("order", [1, -1])
def test_keys_and_documents_of_ros2_are_merged(arm, write, between, order):
    text = between.join((_MANAGER, _ARM)[::order]) + "---\n"
    controls = read_controllers(write("c.yaml", text), arm())
    assert controls.joints["swing"].pid == Pid(3.0)
    assert controls.notes == ()


def test_the_last_value_of_a_key_counts_and_is_told(arm, write):
    text = _C + "  joint: other\n  joint: swing\n  pid: {p: 3}\n"
    controls = read_controllers(write("c.yaml", text), arm())
    assert list(controls.joints) == ["swing"]
    (note,) = controls.notes
    assert "c.yaml:4:10: 'joint' replaces the value in line 3" in note


def test_ros1_takes_the_last_mapping_whole(arm, write):
    text = "c: {pid: {p: 3}}\n" + _C + "  joint: swing\n"
    with pytest.raises(UrdftoolError, match="has no gains of joint 'swing'"):
        read_controllers(write("c.yaml", text), arm())


_UNKNOWN = "c:\n  type: x/JointPositonController\n  joint: swing\n"


def test_a_controller_of_an_unknown_type_leaves_its_joints_alone(arm, write):
    controls = read_controllers(write("c.yaml", _UNKNOWN), arm())
    assert controls.joints == {}
    (note,) = controls.notes
    assert "c.yaml:2:9: controller 'c' is of type 'x/JointPositonController'" in note
    assert "did you mean 'JointPositionController'?; its joints are not actuated" in note


def test_it_is_an_error_where_that_is_asked_for(arm, write):
    with pytest.raises(UrdftoolError, match="of type 'x/JointPositonController'"):
        read_controllers(write("c.yaml", _UNKNOWN), arm(), strict=True)


def test_the_command_simulates_with_an_unknown_controller(write, capsys):
    robot = write("arm.urdf", ARM.format(damping=1.0, more=""))
    path = write("c.yaml", _UNKNOWN)
    words = ["simulate", robot, "--controllers", path, "--duration", "0.5"]
    assert cli.call(words) == 1
    out, err = capsys.readouterr()
    assert "not actuated" in err
    assert "no controller holds joint 'swing'" in out
    assert cli.call([*words, "--strict"]) == 2


def test_an_interface_that_the_joint_has_not_is_refused(arm, write):
    robot = arm(
        more='<transmission name="t"><joint name="swing"><hardwareInterface>'
        "hardware_interface/VelocityJointInterface</hardwareInterface></joint></transmission>"
    )
    path = write("c.yaml", ROS1.format(gains="{p: 1}"))
    with pytest.raises(UrdftoolError, match="commands the effort of joint 'swing'"):
        read_controllers(path, robot)


def test_of_two_controllers_of_a_joint_the_first_is_used(arm, write):
    one = "{}:\n  type: {}_controllers/JointPositionController\n  joint: swing\n"
    path = write("c.yaml", one.format("a", "position") + one.format("b", "velocity"))
    controls = read_controllers(path, arm())
    assert controls.joints["swing"].controller == "a"
    assert len(controls.notes) == 1


def test_the_loop_is_that_of_ros_control():
    """Against the loop written out as control_toolbox documents it, for random numbers."""
    chance = np.random.default_rng(1)
    for windup in (False, True):
        pid = Pid(*chance.uniform(0.1, 5, 3), -0.5, 0.7, windup)
        loop = Pids([Control("c", POSITION, pid, ("", 0, 0))], [0.3], [4.0], [False], 0.01)
        total, last = 0.0, None
        for position in chance.uniform(-1, 1, 200):
            error = 0.3 - position
            total += error * 0.01
            if windup:
                total = min(max(total, -0.5 / pid.i), 0.7 / pid.i)
            integral = min(max(pid.i * total, -0.5), 0.7)
            slope = 0.0 if last is None else (error - last) / 0.01
            last = error
            wanted = min(max(pid.p * error + integral + pid.d * slope, -4.0), 4.0)
            got = loop.step(np.array([position]), np.array([0.0]))
            assert got[0] == pytest.approx(wanted, abs=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_weak_p_sags_as_far_as_statics_says(arm, write, engine):
    """P (0 − q) = m g l cos q, the rod being level at zero and falling to positive q."""
    path = write("c.yaml", ROS1.format(gains="{p: 20, i: 1, d: 4}"))
    run, verdict = _held(arm(), path, engine)
    expected = brentq(lambda q: 20 * q - 2 * 9.81 * 0.5 * math.cos(q), 0, 2)
    assert run.recording.positions[-1, 0] == pytest.approx(expected, rel=0.01)
    assert abs(run.recording.efforts[-1, 0]) == pytest.approx(20 * expected, rel=0.01)
    (fault,) = (fault for fault in verdict.faults if fault.code == "joint-drift")
    assert fault.fails
    assert "holding it requires 9.81 N·m" in fault.cause
    assert "i has no effect, because i_clamp is zero" in fault.cause
    assert (fault.location.path, fault.location.line) == ("c.yaml", 5)


@pytest.mark.parametrize("engine", ENGINES)
def test_an_integral_with_a_clamp_holds(arm, write, engine):
    path = write("c.yaml", ROS1.format(gains="{p: 40, i: 40, d: 8, i_clamp: 20}"))
    run, verdict = _held(arm(), path, engine, duration=10.0)
    assert run.recording.positions[-1, 0] == pytest.approx(0.0, abs=0.02)
    assert verdict.stands, verdict.faults


@pytest.mark.parametrize("engine", ENGINES)
def test_gains_beyond_what_the_timestep_bears_are_said_to_be(arm, write, engine):
    path = write("c.yaml", ROS1.format(gains="{p: 100, i: 0, d: 2000}"))
    _, verdict = _held(arm(damping=0), path, engine, duration=2.0)
    (fault,) = (fault for fault in verdict.faults if fault.code == "unstable-gains")
    assert "gain d = 2000 is unstable for a moved inertia of 0.52 kg·m²" in fault.cause
    assert "use a value below 520" in fault.cause


@pytest.mark.parametrize("engine", ENGINES)
def test_what_nothing_damps_swings_on(arm, write, engine):
    path = write("c.yaml", ROS1.format(gains="{p: 500}"))
    _, verdict = _held(arm(damping=0), path, engine, duration=4.0)
    assert "unstable-gains" in kinds(verdict)
    assert "damping is too low" in verdict.faults[0].cause or any(
        "damping is too low" in fault.cause for fault in verdict.faults
    )


@pytest.mark.parametrize("engine", ENGINES)
def test_a_joint_without_a_controller_is_limp(arm, write, engine):
    path = write("c.yaml", "c:\n  type: effort_controllers/JointEffortController\n  joint: swing\n")
    run, verdict = _held(arm(damping=5), path, engine)
    assert run.recording.positions[-1, 0] == pytest.approx(math.pi / 2, abs=0.1)
    assert not run.recording.efforts.any()
    assert {"not-controlled"} <= {fault.code for fault in verdict.faults}


def test_the_command_takes_a_file(urdftool, write):
    write("arm.urdf", ARM.format(damping=1, more=""))
    write("c.yaml", ROS1.format(gains="{p: 20, d: 4}"))
    result = urdftool("simulate", "--engine", "mujoco", "arm.urdf", "--controllers", "c.yaml")
    assert result.code == 1
    assert "c.yaml:5:10: error: controller " in result.out
    assert "leaves joint 'swing' at" in result.out
    result = urdftool("simulate", "--engine", "mujoco", "arm.urdf", "--controllers", "none.yaml")
    assert (result.code, result.err) == (2, "none.yaml: no such file\n")
    result = urdftool(
        "simulate", "--engine", "mujoco", "arm.urdf", "--limp", "--controllers", "c.yaml"
    )
    assert result.code == 2
