"""Which groups, end effectors, states and joints are found in a robot."""

from __future__ import annotations

from pathlib import Path

import pytest

from urdftool.errors import ConfigError
from urdftool.model.semantic import Group
from urdftool.srdf.groups import GivenGroup, find_groups

from .small_robots import ARM, FINGERS, WHEELS, load_lines, prefix_lines


def describe(group: Group) -> str:
    """Describe a group as text: its chain, its links or its subgroups."""
    chains = [f"{chain.base}>{chain.tip}" for chain in group.chains]
    return f"{group.name}: {' '.join([*chains, *group.links, *group.groups])}"


TORSO = "lift: base > chest prismatic limit=0,0.3\n"
HEAD = "head_pan: chest > pan revolute\nhead_tilt: pan > head revolute\n"
TWO_ARMS = prefix_lines(ARM, "left_") + "\n" + prefix_lines(ARM, "right_")
MOUNTS = "ml: chest > left_base fixed\nmr: chest > right_base fixed\n"
HAND = """
f1: l3 > t1 revolute xyz=0.01,0,0
f2: l3 > t2 revolute xyz=-0.01,0,0
f3: l3 > t3 revolute xyz=0,0.01,0
"""
PARALLELOGRAM = """
j1: base > l1 revolute
j2: l1 > l2 revolute
j3: l2 > l3 revolute
p1: l1 > bar revolute mimic=j2,1
p2: bar > bar2 revolute mimic=j2,-1
"""


@pytest.mark.parametrize(
    ("lines", "groups"),
    [
        pytest.param("", [], id="no joints"),
        pytest.param(WHEELS, [], id="wheels only"),
        pytest.param("j: base > door revolute", ["arm: base>door"], id="one joint"),
        pytest.param(ARM, ["arm: base>tool0"], id="arm"),
        pytest.param(WHEELS + ARM, ["arm: base>tool0"], id="arm on a mobile base"),
        pytest.param(
            ARM + FINGERS, ["arm: base>tool0", "gripper: palm left_tip right_tip"], id="gripper"
        ),
        pytest.param(
            prefix_lines(ARM, "fr3_"), ["fr3_arm: fr3_base>fr3_tool0"], id="name from a prefix"
        ),
        pytest.param(
            ARM.replace("tool0", "camera") + "jaw: l3 > jaw revolute",
            ["arm: base>l3", "gripper: jaw"],
            id="one moving jaw",
        ),
        pytest.param(ARM + HAND, ["arm: base>l3", "gripper: t1 t2 t3"], id="fingers by structure"),
        pytest.param(PARALLELOGRAM, ["arm: base>l3"], id="parallelogram of mimic joints"),
        pytest.param(
            TORSO + HEAD + MOUNTS + TWO_ARMS,
            [
                "torso: base>chest",
                "head: chest>head",
                "left_arm: left_base>left_tool0",
                "right_arm: right_base>right_tool0",
                "arms: left_arm right_arm",
            ],
            id="two arms on a torso",
        ),
        pytest.param(
            TORSO + HEAD + ARM.replace("base >", "chest >"),
            [
                "torso: base>chest",
                "head: chest>head",
                "arm: chest>tool0",
                "arm_with_torso: base>tool0",
            ],
            id="one arm on a torso",
        ),
        pytest.param(
            "hip_1: base > hip revolute\nknee_1: hip > shin revolute\n"
            "hip_2: base > hip2 revolute\nknee_2: hip2 > shin2 revolute",
            ["leg: base>shin", "leg_2: base>shin2"],
            id="legs",
        ),
        pytest.param(
            ARM + prefix_lines(FINGERS.replace("tool0", "l2"), "x_", keep=["l2"]),
            ["arm: base>tool0", "gripper: x_palm x_left_tip x_right_tip"],
            id="a gripper in the middle of an arm",
        ),
    ],
)
def test_groups(tmp_path: Path, lines: str, groups: list[str]) -> None:
    lines = lines or "only: base > part fixed"
    found = find_groups(load_lines(tmp_path, lines, bare=["tool0", "left_tool0", "right_tool0"]))
    assert [describe(group) for group in found.groups] == groups


def test_base_is_the_last_bare_frame_before_geometry(tmp_path: Path) -> None:
    lines = "a: world > base_link fixed\nb: base_link > inertia fixed\n" + ARM.replace(
        "base >", "inertia >"
    )
    found = find_groups(load_lines(tmp_path, lines, bare=["world", "base_link", "tool0"]))
    assert [describe(group) for group in found.groups] == ["arm: base_link>tool0"]
    assert found.virtual_joints == []  # the root is the world


def test_end_effector_and_passive_joints(tmp_path: Path) -> None:
    found = find_groups(load_lines(tmp_path, ARM + FINGERS + WHEELS, bare=["tool0"]))
    (effector,) = found.end_effectors
    assert (effector.name, effector.parent_link, effector.group, effector.parent_group) == (
        "gripper",
        "tool0",
        "gripper",
        "arm",
    )
    assert [joint.name for joint in found.passive_joints] == ["right", "wl", "wr"]
    assert found.ungrouped == ["wl", "wr"]
    (virtual,) = found.virtual_joints
    assert (virtual.type, virtual.parent_frame, virtual.child_link) == ("fixed", "world", "base")


def test_wheels_that_ros2_control_moves_are_not_passive(tmp_path: Path) -> None:
    control = (
        '<ros2_control name="c" type="system"><joint name="wl"/><joint name="wr"/></ros2_control>'
    )
    found = find_groups(load_lines(tmp_path, ARM + WHEELS, more=control))
    assert found.passive_joints == []


def list_states(folder: Path, lines: str, more: str = "") -> dict[str, dict[str, float | None]]:
    found = find_groups(load_lines(folder, lines, bare=["tool0"], more=more))
    return {
        f"{state.group}/{state.name}": {joint.name: joint.value for joint in state.joints}
        for state in found.states
    }


def test_state_zero(tmp_path: Path) -> None:
    assert list_states(tmp_path, ARM) == {"arm/zero": {"j1": 0.0, "j2": 0.0, "j3": 0.0}}


def test_state_where_a_joint_cannot_be_at_zero(tmp_path: Path) -> None:
    lines = ARM.replace("l2 revolute", "l2 revolute limit=0.5,1.5")
    assert list_states(tmp_path, lines) == {"arm/default": {"j1": 0.0, "j2": 1.0, "j3": 0.0}}


def test_joint_with_crossed_limits_has_no_state(tmp_path: Path) -> None:
    lines = ARM.replace("l2 revolute", "l2 revolute limit=1.5,-1.5")
    assert list_states(tmp_path, lines) == {"arm/zero": {"j1": 0.0, "j3": 0.0}}


def test_state_home_is_what_ros2_control_starts_with(tmp_path: Path) -> None:
    control = (
        '<ros2_control name="c" type="system"><joint name="j2"><state_interface name="position">'
        '<param name="initial_value">-0.7</param></state_interface></joint></ros2_control>'
    )
    states = list_states(tmp_path, ARM, control)
    assert states["arm/home"] == {"j1": 0.0, "j2": -0.7, "j3": 0.0}
    outside = list_states(tmp_path, ARM, control.replace("-0.7", "-1.7"))
    assert list(outside) == ["arm/zero"]


@pytest.mark.parametrize(("sign", "opened"), [(1, 0.04), (-1, 0.0)], ids=["outward", "inward"])
def test_gripper_is_open_where_its_fingers_are_far_apart(
    tmp_path: Path, sign: int, opened: float
) -> None:
    left = f"left: palm > lt prismatic xyz=0,0.05,0 axis=0,{sign},0 limit=0,0.04\n"
    right = f"right: palm > rt prismatic xyz=0,-0.05,0 axis=0,{-sign},0 mimic=left,1\n"
    states = list_states(tmp_path, ARM + "mount: tool0 > palm fixed\n" + left + right)
    assert states["gripper/open"] == {"left": opened}
    assert states["gripper/close"] == {"left": 0.04 - opened}


def test_fingers_that_stay_as_far_apart_have_neutral_states(tmp_path: Path) -> None:
    lines = FINGERS.replace("axis=0,-1,0", "axis=0,1,0")
    assert {"gripper/lower", "gripper/upper"} < set(list_states(tmp_path, ARM + lines))


def test_given_group_replaces_what_shares_its_joints(tmp_path: Path) -> None:
    robot = load_lines(tmp_path, ARM + FINGERS, bare=["tool0"])
    found = find_groups(robot, [GivenGroup("manipulator", "l1", "palm")])
    assert [describe(group) for group in found.groups] == [
        "manipulator: l1>palm",
        "gripper: palm left_tip right_tip",
    ]
    assert found.end_effectors[0].parent_group == "manipulator"


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (GivenGroup("a", "bse", "tool0"), "no link 'bse'; did you mean 'base'"),
        (GivenGroup("a", "tool0", "base"), "write a=base:tool0"),
        (GivenGroup("a", "l3", "tool0"), "no actuated joint"),
        (GivenGroup("--", "base", "tool0"), "is not a name"),
    ],
)
def test_wrong_given_group(tmp_path: Path, given: GivenGroup, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        find_groups(load_lines(tmp_path, ARM), [given])


def test_group_given_twice(tmp_path: Path) -> None:
    given = GivenGroup("a", "base", "tool0")
    with pytest.raises(ConfigError, match="twice"):
        find_groups(load_lines(tmp_path, ARM), [given, given])


def test_leader_elsewhere_makes_no_gripper(tmp_path: Path) -> None:
    lines = ARM + "f1: tool0 > t1 revolute mimic=j1,1\nf2: tool0 > t2 revolute mimic=j1,-1"
    found = find_groups(load_lines(tmp_path, lines, bare=["tool0"]))
    assert [describe(group) for group in found.groups] == ["arm: base>tool0"]
    assert [joint.name for joint in found.passive_joints] == ["f1", "f2"]


def test_leader_that_does_not_exist(tmp_path: Path) -> None:
    lines = ARM.replace("l3 revolute", "l3 revolute mimic=nobody,1")
    found = find_groups(load_lines(tmp_path, lines))
    assert [state.name for state in found.states] == ["zero"]


def test_names_with_spaces_and_unicode(tmp_path: Path) -> None:
    lines = prefix_lines(ARM, "手-é")
    found = find_groups(load_lines(tmp_path, lines))
    assert [describe(group) for group in found.groups] == ["arm: 手-ébase>手-étool0"]
