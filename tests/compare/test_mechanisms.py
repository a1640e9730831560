"""Differences of closed loops, actuators and other parts that URDF lacks."""

from dataclasses import replace

from tests.build import arm
from urdftool.compare.compare import compare_robots
from urdftool.compare.differences import compare
from urdftool.model.elements import Dynamics, Origin
from urdftool.model.mechanism import Closure, Configuration, ContactExclusion, Frame, JointActuator
from urdftool.model.settings import Value
from urdftool.report.compare import describe_what

LOOP = Closure(name="loop", type="weld", parent="link0", child="link2", origin=Origin(None))
MOTOR = JointActuator(name="motor", joint="j1", gain=2.0, control_range=(-1.0, 1.0))


def changed(one, two):
    a, b = (arm(2, **parts) for parts in (one, two))
    return [(c.kind, c.new_name, describe_what(c)) for c in compare(a, b)]


def test_equal_parts_do_not_differ():
    parts = {"closures": [LOOP], "joint_actuators": [MOTOR]}
    again = {"closures": [replace(LOOP)], "joint_actuators": [replace(MOTOR, gain=2.0 + 1e-13)]}
    assert changed(parts, again) == []
    frames = [Frame(name="link1", link="link1", kind="body")]
    assert changed({"frames": frames}, {}) == []


def test_a_changed_value_is_named():
    moved = replace(LOOP, origin=Origin(None, (0.0, 0.0, 1e-3)))
    assert changed({"closures": [LOOP]}, {"closures": [moved]}) == [
        ("closed loop", "loop", "origin")
    ]
    limited = replace(MOTOR, control_range=None, gain=3.0)
    assert changed({"joint_actuators": [MOTOR]}, {"joint_actuators": [limited]}) == [
        ("joint actuator", "motor", "gain"),
        ("joint actuator", "motor", "control range"),
    ]
    home = Configuration(name="home", positions={"j1": 0.0})
    other = replace(home, positions={"j1": 0.1})
    assert changed({"configurations": [home]}, {"configurations": [other]}) == [
        ("configuration", "home", "positions")
    ]


def test_added_and_removed_parts():
    pair = ContactExclusion(link="link0", other="link2")
    assert changed({"closures": [LOOP]}, {"exclusions": [pair]}) == [
        ("closed loop", "loop", "removed"),
        ("contact exclusion", "link0 – link2", "added"),
    ]


def test_armature_and_springs():
    a, b = arm(1), arm(1)
    a.joints[0].dynamics, b.joints[0].dynamics = Dynamics(), Dynamics(armature=0.1)
    b.joints[0].settings = {"spring_stiffness": Value(None, 2.0)}
    b.links[0].settings = {"gravity": Value(None, True), "wind": Value(None, True)}
    assert [c.what for c in compare(a, b)] == ["dynamics armature", "wind", "spring stiffness"]


def test_a_loop_of_another_name_is_renamed():
    other = {"closures": [replace(LOOP, name="loop_1")]}
    assert changed({"closures": [LOOP]}, other) == [("closed loop", "loop_1", "renamed")]
    robots = (replace(arm(2, **parts), format="sdf") for parts in ({"closures": [LOOP]}, other))
    assert compare_robots(*robots).differences == []
    moved = {"closures": [replace(LOOP, name="loop_1", child="link1")]}
    found = changed({"closures": [LOOP]}, moved)
    assert {what for _, _, what in found} == {"added", "removed"}
