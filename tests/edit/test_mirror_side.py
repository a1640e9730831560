"""The mirror image of one arm, added to a robot with its files, or in place of the other arm."""

import re

import numpy as np
import pytest

import urdftool
from tests.edit.robots import ARM, ARM_SRDF, CONTROLLERS
from urdftool.compare.correspondence import parse_correspondence
from urdftool.compare.declared import compare_declared
from urdftool.compare.rows import ROWS, narrow_tolerances
from urdftool.errors import ModelError
from urdftool.model.kinematics import link_poses

SIDE = {
    name: f"l_{name}"
    for name in ("upper", "tool", "wheel", "camera", "tip", "shoulder", "slide", "follower")
} | {"camera_mount": "l_camera_mount", "tip_mount": "l_tip_mount"}


def rename(text):
    """Return a text with the part of the left side before the names of all but the base."""
    names = "|".join(sorted(SIDE, key=len, reverse=True))
    return re.sub(rf"(?<![\w/])({names})(?![\w=])", lambda match: SIDE[match[1]], text)


TURNED = (
    '<link name="pole"/><joint name="stand" type="revolute"><parent link="base"/>'
    '<child link="pole"/><origin xyz="0.1 0.2 0.3" rpy="0.3 0.2 0.1"/><axis xyz="0 0 1"/>'
    '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>\n  <!-- the l_shoulder -->'
)
TEXT = rename(ARM)
OFF_PLANE = TEXT.replace("<!-- the l_shoulder -->", TURNED).replace(
    '<parent link="base"/>\n    <child link="l_upper"/>',
    '<parent link="pole"/>\n    <child link="l_upper"/>',
)
SRDF = rename(ARM_SRDF).replace(
    "</robot>",
    '  <group name="l_gripper"><joint name="l_slide"/></group>\n'
    '  <end_effector name="l_end" parent_link="l_tool" group="l_gripper" parent_group="one"/>\n'
    '  <group name="body"><link name="base"/><link name="l_upper"/></group>\n</robot>',
)


@pytest.fixture
def robot(write):
    write("in/arm.srdf", SRDF)
    write("in/controllers.yaml", rename(CONTROLLERS))
    return urdftool.load(write("in/arm.urdf", TEXT))


def add(robot, **options):
    return robot.mirror(exchange=("l_", "r_"), sides="add", **options)


def list_differences(edited):
    return [d.title for proof in edited.proofs for d in proof.comparison.differences]


@pytest.mark.parametrize("text", [TEXT, OFF_PLANE], ids=["on the root", "on a turned link"])
@pytest.mark.parametrize("plane", ["xz", "yz", "xy"])
def test_the_image_is_added(write, text, plane):
    robot = urdftool.load(write("arm.urdf", text))
    edited = robot.mirror(plane, exchange=("l_", "r_"), sides="add")
    assert list_differences(edited) == []
    assert TEXT.encode()[:2000] == edited.data[:2000] or text == OFF_PLANE
    flip = np.eye(4)
    index = {"yz": 0, "xz": 1, "xy": 2}[plane]
    flip[index, index] = -1
    values = {"l_shoulder": 0.7, "l_slide": 0.1, "l_follower": 0.3}
    poses = link_poses(edited.robot, {**values, **{f"r{n[1:]}": v for n, v in values.items()}})
    for name in robot.link:
        if name.startswith("l_"):
            left, right = (make_matrix(poses[n]) for n in (name, f"r{name[1:]}"))
            assert right == pytest.approx(flip @ left @ flip, abs=1e-12)


def make_matrix(pose):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = pose.rotation, pose.translation
    return matrix


def test_all_that_is_about_the_side_is_copied(robot):
    edited = add(robot)
    assert list_differences(edited) == []
    text = edited.data.decode()
    assert '<gazebo reference="r_upper"><mu1>0.9</mu1></gazebo>' in text
    assert '<transmission name="r_shoulder_trans">' in text
    assert 'mimic joint="r_slide" multiplier="2"' in text
    assert '<ros2_control name="r_arm_system" type="system">' in text
    srdf = edited.files["arm.srdf"].decode()
    assert '<group name="r_all"><chain base_link="base" tip_link="r_tip"/></group>' in srdf
    assert '<group_state name="home" group="r_all"><joint name="r_shoulder"' in srdf
    assert '<disable_collisions link1="base" link2="r_upper" reason="Adjacent"/>' in srdf
    assert (
        '<end_effector name="r_end" parent_link="r_tool" group="r_gripper" parent_group="r_one"/>'
        in srdf
    )
    assert srdf.count('name="body"') == 1
    codes = [note.code for note in edited.notes]
    assert codes == ["edit-semantics", "edit-yaml", "edit-text"]


def test_a_hardware_component_of_other_joints_gets_the_image(write):
    other = '<joint name="waist"><command_interface name="effort"/></joint>\n    '
    text = TEXT.replace(
        '<joint name="l_shoulder">\n      <comm', other + '<joint name="l_shoulder">\n      <comm'
    )
    edited = add(urdftool.load(write("arm.urdf", text)))
    assert list_differences(edited) == []
    assert edited.data.decode().count("<ros2_control") == 1
    assert '\n    <joint name="r_shoulder">\n      <command_interface' in edited.data.decode()


def test_cut_restores_every_byte(robot, write):
    back = urdftool.load(write("two.urdf", add(robot).data.decode())).cut("r_upper")
    assert back.is_proved
    assert back.data == TEXT.encode()


def test_the_other_side_is_replaced(robot, write):
    two = add(robot).data.decode()
    wrong = two.replace('<mass value="0.2"/>', '<mass value="0.3"/>').replace(
        '<mass value="0.3"/>', '<mass value="0.2"/>', 1
    )
    worn = urdftool.load(write("two.urdf", wrong))
    with pytest.raises(ModelError, match=r"link 'r_\w+' exists; --sides replace"):
        add(worn)
    edited = worn.mirror(exchange=("l_", "r_"), sides="replace")
    assert list_differences(edited) == []
    assert edited.data.decode().count('<mass value="0.2"/>') == 2


PLANTED = {
    "frames": ('rpy="-0.3 -0.2 -0.5"', 'rpy="-0.3 -0.2 -0.501"'),
    "axes": ('<axis xyz="0.6 0 0.8"/>', '<axis xyz="0.6 0 -0.8"/>'),
    "inertia": ('ixy="-0.001" ixz="0.002"', 'ixy="0.001" ixz="0.002"'),
    "limits": ('lower="-1.0" upper="2" effort="30"', 'lower="-1.1" upper="2" effort="30"'),
    "tree": ('<mimic joint="r_slide"', '<mimic joint="l_slide"'),
    "mass": ('<mass value="0.2"/>', '<mass value="0.201"/>'),
    "surface": ('<gazebo reference="r_upper"><mu1>0.9', '<gazebo reference="r_upper"><mu1>0.8'),
    "simulator data": ('<param name="min">-1<', '<param name="min">-2<'),
    "collisions": ('<origin xyz="0 -0.01 0.2"', '<origin xyz="0 0.01 0.2"'),
}


@pytest.mark.parametrize("row", PLANTED)
def test_a_wrong_image_is_named(robot, write, row):
    edited = add(robot)
    old, new = PLANTED[row]
    text = edited.data.decode()
    begin = text.index("urdftool mirror, begin")
    at = text.index(old, begin)
    changed = text[:at] + new + text[at + len(old) :]
    result = urdftool.load(write("wrong.urdf", changed))
    declared = parse_correspondence(list(enumerate(edited.proofs[0].lines, 1)), 2)
    found = compare_declared(robot, result, declared, rows=narrow_tolerances(ROWS, 1e-8))
    assert row in {difference.row for difference in found.differences}


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"l_tip"', '"tip"', "link 'tip' of that side has no 'l_' in its name"),
        ('"l_slide"', '"slide"', "joint 'slide' of that side has no 'l_' in its name"),
        ('"l_shoulder" type="revolute"', '"l_shoulder" type="floating"', "several positions"),
        ('<box size="0.2 0.1 0.1"/>', '<box size="0.2 0.1 0.1"/>', "no link below the root has"),
    ],
)
def test_what_has_no_image_is_an_error(write, old, new, message):
    text = TEXT.replace(old, new)
    robot = urdftool.load(write("arm.urdf", text))
    part = "x_" if old == new else "l_"
    with pytest.raises(ModelError, match=re.escape(message)):
        robot.mirror(exchange=(part, "r_"), sides="add")


def test_sides_require_names(urdftool, write):
    path = write("arm.urdf", TEXT)
    result = urdftool("edit", "mirror", path, "--sides", "add")
    assert result.code == 2
    assert "--sides add requires --from and --to" in result.err


@pytest.mark.parametrize(
    ("name", "old", "new", "expected"),
    [
        ("arm_l_1", "l_", "r_", "arm_r_1"),
        ("tool_base", "l_", "r_", "tool_base"),
        ("hand_l", "_l", "_r", "hand_r"),
        ("LeftArm", "Left", "Right", "RightArm"),
        ("armLeft2", "Left", "Right", "armRight2"),
        ("pedal", "l", "r", "pedal"),
    ],
)
def test_a_part_of_a_name_begins_a_word(name, old, new, expected):
    from urdftool.edit.mirror import exchange_part

    assert exchange_part(name, old, new) == expected
