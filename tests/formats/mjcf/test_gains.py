"""Gains that the inertia bounds, and those that an actuator file sets."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

import urdftool
from tests.formats.test_standing_pose import quadruped
from urdftool.errors import ConfigError
from urdftool.formats.common.actuator_config import read_actuator_config
from urdftool.formats.common.joint_loads import GRAVITY, JointLoad, compute_joint_loads
from urdftool.formats.common.servo_gains import (
    FREQUENCY,
    LONGER,
    PART,
    POSITION_GAIN,
    SAG,
    TIMESTEP,
    choose_position_gain,
)
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.structure import create_structure
from urdftool.formats.mjcf.verify import verify_copy
from urdftool.formats.mjcf.write import write as write_mjcf
from urdftool.mechanics.spatial_inertia import link_inertia
from urdftool.model.load import load

from .robots import INERTIAL, export, find, joint, link, robot, rules, tree

TINY = (
    '<inertial><origin xyz="0.1 0 0"/><mass value="0.05"/>'
    '<inertia ixx="1e-5" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="1e-5"/></inertial>'
)
LIMIT = '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1000" velocity="3"/>'
FINGERS = robot(
    link("base"), link("one", TINY), link("two", TINY),
    joint("left_knee", "base", "one", inside=LIMIT),
    joint("right_knee", "base", "two", inside=LIMIT),
)  # fmt: skip


def test_the_sag_of_a_robot_on_its_feet_is_said_to_be_that_at_rest(write):
    dog = export(write("dog.urdf", quadruped()))
    for written, rocks in ((dog, True), (export(write("r.urdf", FINGERS)), False)):
        (gains,) = [one for one in written.losses if one.code == "lossy-gains"]
        assert "at rest, they sag by at most" in gains.message
        assert ("the robot may rock by more, which --verify steps" in gains.message) is rocks


def test_a_placeholder_effort_is_bounded_by_the_inertia(write):
    written = export(write("r.urdf", FINGERS), actuators="position")
    inertia = 0.05 * 0.1**2 + 1e-5
    gain = float(next(e.get("kp") for e in tree(written).iter("position") if e.get("kp")))
    assert gain == pytest.approx(PART * inertia / TIMESTEP**2, rel=6e-3)
    assert gain < POSITION_GAIN["hinge"] * 1000
    assert "lossy-gains" in rules(written)


@pytest.mark.parametrize(
    ("effort", "load", "value", "force"),
    [
        (3.0, JointLoad(1.0), 3 * POSITION_GAIN["hinge"], None),
        (3.0, JointLoad(1.0, stiffness=500.0), 500.0, None),  # twice m·g·h
        (1e6, JointLoad(0.5), PART * 0.5 / TIMESTEP**2, None),
        (None, JointLoad(0.5), 0.5 * FREQUENCY**2, 0.5 * FREQUENCY**2 * 0.1),
        (None, JointLoad(0.5, force=5.0), 5.0 / SAG, 5.0 / SAG * 0.1),
        (None, JointLoad(), 100.0, None),  # nothing is known
    ],
)
def test_the_gain_of_a_position_servo(effort, load, value, force):
    gain = choose_position_gain("hinge", effort, load)
    assert gain.value == pytest.approx(value)
    assert gain.force == (None if force is None else pytest.approx(force))


@pytest.mark.parametrize(("carried", "load", "weak"), [(0, 9, 0), (0, 11, 1), (1, 11, 0)])
def test_a_servo_that_is_too_weak_is_known(carried, load, weak):
    moved = JointLoad(1.0, 1.0, load, is_carried=bool(carried))
    assert choose_position_gain("hinge", 10, moved).is_weak == bool(weak)


def test_joints_that_are_too_weak_for_the_load_at_home_are_named(urdftool, tmp_path):
    """A bar of 2 kg, 0.5 m beside its horizontal axis, loads it with 9.8 N·m."""
    base = '<link name="a"><inertial><mass value="1"/>{}</inertial></link>'
    arm = '<link name="b"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>{}</inertial></link>'
    tensor = '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/>'
    turn = '<parent link="a"/><child link="b"/><axis xyz="0 1 0"/>'
    for effort, found in ((9, True), (11, False)):
        limit = f'<limit lower="-1" upper="1" effort="{effort}" velocity="1"/>'
        joint = f'<joint name="j" type="revolute">{turn}{limit}</joint>'
        path = tmp_path / f"r{effort}.urdf"
        path.write_text(f'<robot name="r">{(base + arm).format(tensor, tensor)}{joint}</robot>')
        result = urdftool("export", "mjcf", path, "-o", tmp_path / f"{effort}.xml")
        text = "the load at home is above the effort limit, so that the servo does not hold it: 'j'"
        assert (text in result.err) == found


def test_a_longer_step_has_a_lower_bound():
    short, long = (choose_position_gain("hinge", 1e6, JointLoad(1.0), dt) for dt in (0.002, 0.004))
    assert short.value == pytest.approx(4 * long.value)


@given(seed=st.integers(0, 2**32 - 1), size=st.integers(1, 6), step=st.floats(0.1, LONGER))
def test_servos_of_a_carried_chain_are_stable_at_longer_steps(seed, size, step):
    """Integrate M a = -K x - D v with implicit damping, as MuJoCo does, for any mass matrix M."""
    factor = np.random.default_rng(seed).normal(size=(size, size))
    mass = factor @ factor.T + 1e-3 * np.eye(size)
    free = 1 / np.diag(np.linalg.inv(mass))
    gains = [
        choose_position_gain("hinge", 1e9, JointLoad(held, held, is_carried=True, free=other))
        for held, other in zip(np.diag(mass), free, strict=True)
    ]
    stiffness = np.diag([gain.value for gain in gains])
    h, damping = (
        step * TIMESTEP,
        np.diag(
            [
                2 * np.sqrt(gain.value * other) if gain.kd is None else gain.kd
                for gain, other in zip(gains, free, strict=True)
            ]
        ),
    )
    change = np.linalg.solve(mass + h * damping, np.hstack([-h * stiffness, mass]))
    one = np.hstack([np.eye(size), np.zeros((size, size))]) + h * change
    radius = abs(np.linalg.eigvals(np.vstack([one, change]))).max()
    assert radius <= 1 + 1e-6


def test_damping_is_that_of_the_inertia_that_bounds_the_gain():
    carried = choose_position_gain("hinge", 1e9, JointLoad(0.5, 0.5, is_carried=True, free=0.1))
    assert carried.kd == pytest.approx(2 * np.sqrt(carried.value * 0.5), rel=6e-3)
    assert choose_position_gain("hinge", 1e9, JointLoad(0.5, 0.1)).kd is None
    mild = JointLoad(0.5, 0.5, is_carried=True, free=0.25)
    assert choose_position_gain("hinge", 1e9, mild).kd is None


def test_the_load_at_home_is_that_of_statics(write):
    """A bar of 2 kg, whose center is 0.5 m from its horizontal axis, and a slide that lifts it."""
    inertial = (
        '<inertial><origin xyz="0.5 0 0"/><mass value="2"/>'
        '<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>'
    )
    text = robot(
        link("base"), link("car"), link("bar", inertial),
        joint("lift", "base", "car", kind="prismatic", inside=LIMIT.replace("0 1 0", "0 0 1")),
        joint("turn", "car", "bar", inside=LIMIT),
    )  # fmt: skip
    loaded = load(write("r.urdf", text))
    masses = {one.name: link_inertia(one) for one in loaded.links}
    loads = compute_joint_loads(create_structure(loaded), masses, {})
    carried = 2 + masses["car"].mass
    assert loads["turn"].inertia == pytest.approx(0.1 + 2 * 0.5**2)
    assert loads["turn"].force == pytest.approx(2 * GRAVITY * 0.5)
    assert loads["lift"].inertia == pytest.approx(carried)
    assert loads["lift"].force == pytest.approx(carried * GRAVITY)


@pytest.mark.library("mujoco")
def test_inertias_of_a_chain_are_those_of_mujoco(write, tmp_path):
    """Three parallel axes and a slide: elements of the mass matrix, and of its inverse."""
    import mujoco

    inertial = (
        '<inertial><origin xyz="0.1 0.02 -0.03"/><mass value="{}"/>'
        '<inertia ixx="0.1" ixy="0.01" ixz="0.02" iyy="0.2" iyz="0" izz="0.25"/></inertial>'
    )
    place = '<origin xyz="0.3 0.1 0" rpy="0.2 0.1 {}"/>' + LIMIT
    text = robot(
        link("base"), *(link(f"l{n}", inertial.format(n + 1)) for n in range(4)),
        joint("j0", "base", "l0", inside=place.format(0)),
        joint("j1", "l0", "l1", inside=place.format(0.1)),
        joint("j2", "l1", "l2", inside=place.format(-0.1)),
        joint("j3", "l1", "l3", kind="prismatic", inside=place.format(0.5)),
    )  # fmt: skip
    path = write("r.urdf", text)
    loaded = load(path)
    masses = {one.name: link_inertia(one) for one in loaded.links}
    home = {"j0": 0.3, "j1": -0.4, "j2": 0.5, "j3": 0.1}
    loads = compute_joint_loads(create_structure(loaded), masses, home)
    made = tmp_path / "model.xml"
    made.write_text(export(path, base="fixed").text)
    model = mujoco.MjModel.from_xml_path(str(made))
    data = mujoco.MjData(model)
    for name, value in home.items():
        data.joint(name).qpos[0] = value
    mujoco.mj_forward(model, data)
    units = np.eye(model.nv)
    inverse, matrix = np.zeros((model.nv, model.nv)), np.zeros((model.nv, model.nv))
    mujoco.mj_solveM(model, data, inverse, units)
    for row in range(model.nv):
        mujoco.mj_mulM(model, data, matrix[row], units[row])
    for name in home:
        held = loads[name]
        dof = int(model.jnt_dofadr[model.joint(name).id])
        assert held.inertia == pytest.approx(matrix[dof, dof])
        assert held.reduced == pytest.approx(max(1 / inverse[dof, dof], 0.1 * held.inertia))
        assert held.reduced < held.inertia


def test_axes_on_one_line_keep_a_gain(write):
    """Two axes on one line with a link without mass between: the mass matrix is singular."""
    text = robot(
        link("base"), link("a", ""), link("b"),
        joint("i", "base", "a", inside=LIMIT), joint("j", "a", "b", inside=LIMIT),
    )  # fmt: skip
    loaded = load(write("r.urdf", text))
    loads = compute_joint_loads(create_structure(loaded), {"b": link_inertia(loaded.link["b"])}, {})
    for held in loads.values():
        assert held.inertia == pytest.approx(0.1)
        assert 0.01 <= held.reduced <= 0.1


@pytest.mark.parametrize(("light", "is_singular"), [(1e-3, False), (1e-5, True)])
def test_axes_on_one_line_with_a_light_link_between_keep_a_stable_gain(write, light, is_singular):
    """Without an armature, a gain is at most 2.56 times that of the free chain."""
    inside = INERTIAL.replace("0.1", f"{light:g}")
    text = robot(
        link("base"), link("a", inside), link("b"),
        joint("i", "base", "a", inside=LIMIT), joint("j", "a", "b", inside=LIMIT),
    )  # fmt: skip
    loaded = load(write("r.urdf", text))
    masses = {name: link_inertia(loaded.link[name]) for name in ("a", "b")}
    loads = compute_joint_loads(create_structure(loaded), masses, {})
    free = {"i": light, "j": light * 0.1 / (light + 0.1)}
    for name, held in loads.items():
        assert held.is_singular == is_singular
        if not is_singular:
            assert held.reduced == pytest.approx((4 / LONGER) ** 2 * free[name], rel=1e-6)


@pytest.mark.library("mujoco")
def test_bounded_gains_run_and_those_of_the_effort_do_not(write, tmp_path):
    from urdftool.formats.mjcf.verify_runs import run_at_home

    written = export(write("r.urdf", FINGERS), actuators="position", exclude="touching")
    text = written.text
    model = tmp_path / "model.xml"
    model.write_text(text)
    assert run_at_home(model, 0.005).list_faults() == []
    gain = next(e.get("kp") for e in tree(written).iter("position") if e.get("kp"))
    model.write_text(text.replace(f'kp="{gain}"', 'kp="1000000"'))
    assert run_at_home(model, 0.005).list_faults()


@pytest.mark.library("mujoco")
@pytest.mark.parametrize("stiff", [False, True])
def test_verify_steps_the_model(write, stiff):
    found, options = load(write("r.urdf", FINGERS)), Options(actuators="position")
    written = write_mjcf(found, options)
    if stiff:
        gain = next(e.get("kp") for e in tree(written).iter("position") if e.get("kp"))
        text = written.text.replace(f'kp="{gain}"', 'kp="1000000"')
        written.files[written.main] = text.encode()
    (runs,) = (c for c in verify_copy(found, options, written) if c.name == "runs")
    assert runs.verdict == ("differs" if stiff else "equal"), runs.differing


def test_a_follower_gets_no_servo(write):
    text = robot(
        link("base"), link("a"), link("b"),
        joint("lead", "base", "a", inside=LIMIT),
        joint("follow", "base", "b", inside=LIMIT + '<mimic joint="lead"/>'),
        '<ros2_control name="c" type="system">'
        '<joint name="lead"><command_interface name="position"/></joint>'
        '<joint name="follow"><command_interface name="position"/></joint></ros2_control>',
    )  # fmt: skip
    written = export(write("r.urdf", text))
    assert [e.get("joint") for e in tree(written).find("actuator")] == ["lead"]
    assert "lossy-mimic-actuator" in rules(written)


CONFIG = """
[joints."*_knee"]
kp = 12
kd = 0.5
armature = 0.01
force-range = 30

[joints.left_knee]
kp = 20
damping = 0.1
"""


@pytest.mark.library("mujoco")
def test_an_actuator_file_by_name_and_pattern(write):
    path = write("r.urdf", FINGERS)
    options = Options(actuator_config=Path(write("a.toml", CONFIG)))
    found = load(path)
    written = write_mjcf(found, options)
    model = tree(written)
    left, right = (find(model, "position", name) for name in ("left_knee", "right_knee"))
    assert (left.get("kp"), left.get("kv"), left.get("forcerange")) == ("20", "0.5", "-30 30")
    assert right.get("kp") == "12"
    assert find(model, "joint", "left_knee").get("damping") == "0.1"
    assert find(model, "joint", "right_knee").get("actuatorfrcrange") is None
    checks = verify_copy(found, options, written)
    assert [c.name for c in checks if c.verdict == "differs"] == []


@pytest.mark.library("mujoco")
def test_armature_of_all_joints_bounds_gains_less(write):
    plain = export(write("r.urdf", FINGERS), actuators="position").text
    written = export(write("r.urdf", FINGERS), actuators="position", armature=0.02)
    (default,) = (e for e in tree(written).iter("joint") if e.get("armature"))
    assert default.get("armature") == "0.02"
    gains = [
        float(next(e.get("kp") for e in tree(w).iter("position") if e.get("kp")))
        for w in (export(write("r.urdf", FINGERS), actuators="position"), written)
    ]
    assert gains[0] < gains[1]
    assert "armature" not in plain


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[joints.x", "not valid TOML"),
        ("[joint.x]", r"unknown table \[joint\]"),
        ("[joints.left_knee]\nkpp = 1", "unknown key 'kpp'; did you mean 'kp'"),
        ("[joints.left_knee]\nkp = -1", "kp must be a number, zero or above"),
        ("[joints.left_knee]\nkp = true", "kp must be a number"),
        ("[joints.left_knee]\nforce-range = [2, 1]", "force-range must be"),
        ("[joints.left_knee]\ntype = 'servo'", "type must be position, velocity or motor"),
        ("[joints]\nleft_knee = 3", "must be a table"),
        ("[joints.left_nee]\nkp = 1", "did you mean 'left_knee'"),
        ('[joints."*_hip"]\nkp = 1', "no joint that moves has this pattern"),
    ],
)
def test_errors_of_an_actuator_file_name_the_key(write, text, message):
    path = write("a.toml", text)
    with pytest.raises(ConfigError, match=message) as caught:
        read_actuator_config(Path(path)).match_joints(["left_knee", "right_knee"])
    assert caught.value.path == str(path)


def test_a_name_counts_before_a_pattern_and_a_later_pattern_before_an_earlier(write):
    text = '[joints.ab]\nkp = 1\n[joints."*"]\nkp = 2\nkd = 2\n[joints."a*"]\nkp = 3\n'
    found = read_actuator_config(Path(write("a.toml", text))).match_joints(["ab", "ac", "b"])
    assert [(s.kp, s.kd) for s in found.values()] == [(1, 2), (3, 2), (2, 2)]


def test_a_file_of_gains_is_refused_from_the_command_line(urdftool, write, tmp_path):
    path = write("r.urdf", robot(link("a", INERTIAL), link("b"), joint("j", "a", "b")))
    config = write("a.toml", "[joints.k]\nkp = 1\n")
    result = urdftool("export", "mjcf", path, "-o", tmp_path / "o", "--actuator-config", config)
    assert result.code == 2
    assert 'a.toml: [joints."k"]: no joint that moves has this name' in result.err
    assert not (tmp_path / "o").exists()


@pytest.mark.library("mujoco")
@pytest.mark.parametrize(("limit", "expected"), [("1e9", ("10.0", None)), ("2", ("50.0", "-2 2"))])
def test_a_limit_that_stands_for_none_gives_no_gain(tmp_path, limit, expected):
    path = tmp_path / "r.urdf"
    body = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    path.write_text(
        f'<robot name="r"><link name="a">{body}</inertial></link><link name="b">{body}</inertial>'
        '</link><joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
        f'<limit effort="{"10" if limit == "2" else limit}" velocity="{limit}"/></joint></robot>'
    )
    written = urdftool.export_mjcf(urdftool.load(path), actuators="velocity", verify=True)
    assert {check.verdict for check in written.checks} <= {"equal", "announced", "none"}
    (servo,) = etree.fromstring(written.text.encode()).find("actuator")
    assert (f"{float(servo.get('kv')):.1f}", servo.get("ctrlrange")) == expected


@pytest.mark.parametrize(
    ("choices", "stop"),
    [
        ({}, "0.004 1"),
        ({"timestep": 0.001}, "0.002 1"),
        ({"actuators": "motor"}, None),
        ({"actuators": "none"}, None),
    ],
)
def test_stops_are_as_stiff_as_the_step_allows_beside_assumed_servos(write, choices, stop):
    written = export(write("r.urdf", robot(link("a"), link("b"), joint("j", "a", "b"))), **choices)
    assert find(tree(written), "joint", "j").get("solreflimit") == stop


@pytest.mark.library("mujoco")
def test_a_servo_that_is_pushed_against_its_stop_stays_within_it(write, tmp_path):
    """The target of a light arm is far beyond its stop, which MuJoCo's own stop does not hold."""
    import mujoco

    limit = '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="10" velocity="9"/>'
    path = write("r.urdf", robot(link("a"), link("b", INERTIAL.replace("0.1", "0.001")),
                                 joint("j", "a", "b", inside=limit)))  # fmt: skip
    text = export(path).files["r.xml"].decode()
    excess = []
    for one in (text, text.replace('solreflimit="0.004 1"', "")):
        model = mujoco.MjModel.from_xml_string(one.replace('inheritrange="1"', 'ctrlrange="-2 2"'))
        data = mujoco.MjData(model)
        data.ctrl[:] = 2
        reached = []
        while data.time < 0.3:
            mujoco.mj_step(model, data)
            reached.append(data.qpos[0] - 1)
        excess.append(max(reached))
    assert excess[0] < 0.25 * excess[1]


def test_a_joint_that_others_follow_has_the_gain_of_the_longest_step(write):
    """MuJoCo couples mimic joints without the servo's damping: at 5 ms a stiff one diverges."""
    alone = robot(link("base"), link("a"), joint("lead", "base", "a", inside=LIMIT))
    led = robot(
        link("base"), link("a"), link("b"),
        joint("lead", "base", "a", inside=LIMIT),
        joint("follow", "base", "b", inside=LIMIT + '<mimic joint="lead"/>'),
    )  # fmt: skip
    gains = [
        float(
            find(tree(export(write("r.urdf", text), actuators="position")), "position", "lead").get(
                "kp"
            )
        )
        for text in (alone, led)
    ]
    assert gains[0] / gains[1] == pytest.approx(LONGER**2, rel=0.01)
