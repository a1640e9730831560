"""What is said of joints that give way, of wheels that roll, and of what follows from either."""

import math

import pytest

from tests.conftest import FIXTURES
from tests.simulation.robots import inertial, kinds, simulated

POST = '<collision><origin xyz="0 0 1"/><geometry><box size="0.4 0.4 2"/></geometry></collision>'


def link(name, mass=0.0, shape="", at="0 0 0", moment=0.01):
    weight = inertial(mass, moment, moment, moment) if mass else ""
    touch = (
        f'<collision><origin xyz="{at}"/><geometry>{shape}</geometry></collision>' if shape else ""
    )
    return f'<link name="{name}">{weight}{touch}</link>'


def joint(name, kind, parent, child, xyz, axis="0 0 1", limit="", more=""):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}"/><axis xyz="{axis}"/>{limit and f"<limit {limit}/>"}{more}</joint>'
    )


def fault(verdict, kind):
    return next(fault for fault in verdict.faults if fault.code == kind)


@pytest.fixture
def crane(write):
    """A post and a hook, 4 t, that slides down by half a metre."""
    text = f'<link name="base">{inertial(9000, 900, 900, 900)}{POST}</link>'
    text += link("hook", 4000, '<box size="1 1 0.8"/>', moment=600)
    limit = 'lower="0" upper="0.5" effort="{effort}" velocity="1"'
    text += joint("hoist", "prismatic", "base", "hook", "1 0 1.5", "0 0 -1", limit)
    return lambda effort: write(
        "crane.urdf", f'<robot name="r">{text.replace("{effort}", str(effort))}</robot>'
    )


def test_limits_bear_what_is_heavy(crane):
    pytest.importorskip("pybullet")
    verdict = simulated(crane(100), fixed_base=True)
    assert verdict.run.recording.positions[-1, 0] == pytest.approx(0.5, abs=1e-3)
    assert kinds(verdict) == {"joint-drift"}


def test_what_nothing_holds_falls_alone(crane):
    verdict = simulated(crane(100), hold="none", fixed_base=True)
    said = fault(verdict, "collapsed")
    assert said.name == "hoist"
    assert "sank 0.5 m" in said.message


def test_wheels_are_no_collapse(write):
    """A balancer tips over, held or not: its wheels bear nothing that sank."""
    text = link("base", 2, '<box size="0.1 0.2 0.3"/>', "0 0 0.2", 0.02)
    text = text.replace('xyz="0 0 0"/><mass', 'xyz="0 0 0.2"/><mass')
    for side, y in (("l", 0.13), ("r", -0.13)):
        text += link(side, 0.3, '<sphere radius="0.06"/>', moment=4e-4)
        text += joint(f"{side}_j", "continuous", "base", side, f"0 {y} 0", "0 1 0")
    verdict = simulated(write("b.urdf", f'<robot name="r">{text}</robot>'), hold="none")
    assert kinds(verdict) == {"tipped-over"}


def car(*wheels):
    """300 kg on wheels at some places."""
    text = link("base", 300, '<box size="2 0.8 0.4"/>', "0 0 0.15", 50)
    limit = 'effort="10" velocity="20"'
    for number, (x, y) in enumerate(wheels):
        name = f"w{number}"
        text += link(name, 8, '<sphere radius="0.25"/>', moment=0.2)
        text += joint(f"{name}_j", "continuous", "base", name, f"{x} {y} 0", "0 1 0", limit)
    return text


CAR = car((0.7, 0.6), (0.7, -0.6), (-0.7, 0.6), (-0.7, -0.6))


def test_wheels_that_turned_on_the_level_do_not_sag(write):
    path = write("car.urdf", f'<robot name="car">{CAR}</robot>')
    verdict = simulated(path, start_rpy=(0.03, 0.06, 0.2))
    assert abs(verdict.run.recording.positions[-1]).max() > 0.05  # they did turn
    assert kinds(verdict) == set()
    assert "near-effort-limit" not in {fault.code for fault in verdict.faults}


def test_brakes_that_are_too_weak_for_a_slope_are_said(write):
    path = write("car.urdf", f'<robot name="car">{CAR}</robot>')
    verdict = simulated(path, slope=math.radians(10))
    assert {"slid", "joint-drift", "not-settled"} <= kinds(verdict)
    assert fault(verdict, "slid").cause.startswith(
        "the wheels turned, because the effort limit is too low"
    )
    assert "is too low to hold the load" in fault(verdict, "not-settled").cause


def test_wheels_that_roll_are_not_slick(write):
    """A slick caster is no reason to move where wheels roll."""
    caster = link("caster", 1, '<sphere radius="0.05"/>', moment=1e-3)
    caster += joint("c", "fixed", "base", "caster", "-0.7 0 -0.2")
    slick = '<gazebo reference="caster"><mu1>0</mu1><mu2>0</mu2></gazebo>'
    path = write(
        "car.urdf", f'<robot name="car">{car((0.3, 0.6), (0.3, -0.6))}{caster}{slick}</robot>'
    )
    said = fault(simulated(path, hold="none", slope=math.radians(10)), "slid")
    assert said.cause == "the wheels turned, because they are not held"
    assert said.rule == ""
    assert said.name.startswith("w")


def test_what_a_limp_joint_takes_into_another_is_no_fault_of_shapes(write):
    """An arm that falls through its table: it fell; its shapes are where they belong."""
    table = '<box size="0.8 0.8 0.5"/>'
    text = f'<link name="world"/>{link("table", 30, table, "0 0 0.25", 2)}'
    text += joint("w", "fixed", "world", "table", "0 0 0")
    text += link("post", 1, '<box size="0.05 0.05 0.1"/>', "0 0 0.05")
    text += joint(
        "turn",
        "revolute",
        "table",
        "post",
        "0 0 0.5",
        "0 0 1",
        'lower="-1" upper="1" effort="9" velocity="1"',
    )
    text += link("rod", 1, '<box size="0.4 0.04 0.04"/>', "0.25 0 0").replace(
        'xyz="0 0 0"/><mass', 'xyz="0.25 0 0"/><mass'
    )
    text += joint(
        "lean",
        "revolute",
        "post",
        "rod",
        "0 0 0.3",
        "0 1 0",
        'lower="0" upper="1.5" effort="9" velocity="1"',
    )
    verdict = simulated(write("arm.urdf", f'<robot name="r">{text}</robot>'), hold="none")
    assert "collapsed" in kinds(verdict)
    assert "interpenetration" not in kinds(verdict)
    said = [f for f in verdict.faults if f.code == "interpenetration" and "'table'" in f.message]
    assert said
    assert said[0].cause.startswith("caused by joint 'lean' moving to 1.5")
    assert said[0].rule == ""


@pytest.mark.parametrize(("multiplier", "wrong"), [(-1, False), (1, True)])
def test_joints_that_follow_beyond_their_limits_are_named(write, multiplier, wrong):
    text = link("base", 1, '<box size="0.2 0.2 0.1"/>')
    for name, limit, more in (
        ("left", 'lower="0" upper="0.04"', ""),
        ("right", 'lower="-0.04" upper="0"', f'<mimic joint="left" multiplier="{multiplier}"/>'),
    ):
        text += link(f"{name}_finger", 0.1, '<box size="0.01 0.01 0.05"/>', moment=1e-4)
        text += joint(
            name, "prismatic", "base", f"{name}_finger", "0 0 0.2", "0 1 0",
            f'{limit} effort="20" velocity="1"', more,
        )  # fmt: skip
    verdict = simulated(write("g.urdf", f'<robot name="g">{text}</robot>'), pose={"left": 0.03})
    assert ("beyond-limit" in kinds(verdict)) == wrong
    if wrong:
        assert fault(verdict, "beyond-limit").name == "right"
        assert "follows 'left' to 0.03 m" in fault(verdict, "beyond-limit").message


def wheel(collision, origin="0 0 0"):
    """A wheel of 0.25 m, and what it collides with."""
    return (
        f'<link name="{{name}}">{inertial(8, 0.2, 0.2, 0.2)}'
        '<visual><geometry><sphere radius="0.25"/></geometry></visual>'
        f'<collision><origin xyz="{origin}"/><geometry>{collision}</geometry></collision></link>'
    )


@pytest.mark.parametrize(
    ("written", "rule"),
    [
        (wheel('<sphere radius="0.00025"/>'), "collision-much-smaller-than-visual"),
        (wheel('<sphere radius="0.25"/>', "0 0 1.57"), "collision-off-visual"),
        (wheel('<sphere radius="0.25"/>'), None),
    ],
)
def test_wheels_that_are_seen_in_the_floor_are_no_wheels(write, written, rule):
    text = link("base", 300, '<box size="2 0.8 0.4"/>', "0 0 0.15", 50)
    for number, (x, y) in enumerate([(0.7, 0.7), (0.7, -0.7), (-0.7, 0.7), (-0.7, -0.7)]):
        text += written.replace("{name}", f"w{number}")
        text += joint(f"j{number}", "continuous", "base", f"w{number}", f"{x} {y} 0", "0 1 0")
    verdict = simulated(write("car.urdf", f'<robot name="car">{text}</robot>'))
    if rule is None:
        assert "missing-contact-geometry" not in kinds(verdict)
        return
    said = [fault for fault in verdict.faults if fault.code == "missing-contact-geometry"]
    assert {fault.name for fault in said} == {"w0", "w1", "w2", "w3"}
    assert {fault.rule for fault in said} == {rule}


CUBE = FIXTURES / "meshes" / "cube.stl"


@pytest.mark.parametrize(
    ("shape", "remedy", "rule"),
    [
        ('<box size="300 200 100"/>', 'size="0.3 0.2 0.1"', "shape-in-millimeters"),
        (
            '<mesh filename="cube.stl" scale="500 500 500"/>',
            'scale="0.5 0.5 0.5"',
            "mesh-in-millimeters",
        ),
    ],
)
def test_sizes_in_millimeters_are_told_by_how_they_are_written(write, shape, remedy, rule):
    write("cube.stl", CUBE.read_bytes())
    """A box has no mesh, and a mesh may have been scaled the wrong way."""
    text = link("base", 30, '<box size="0.4 0.4 0.2"/>') + link("head", 3, shape)
    text += link("ear", 1, '<box size="0.1 0.1 0.1"/>')
    text += joint("neck", "revolute", "base", "head", "0 0 0.5", limit='lower="0" upper="1"')
    text += joint("lobe", "fixed", "base", "ear", "0 0.3 0")
    path = write("m.urdf", f'<robot name="m">{text}</robot>')
    said = fault(simulated(path, duration=0.1), "too-large")
    assert remedy in said.message + said.cause
    assert said.rule == rule
