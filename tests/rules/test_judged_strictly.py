"""Kinds of findings that a strict reader judged as noise or wrong, beside those that remain."""

from pathlib import Path

import pytest

from tests.rules.test_judged_after_the_scale import HEAVY, JOINT, LIMIT, MASS, find, shape

LINK = '<link name="{}">{}</link>'


def slide(parent, child, at):
    """Write a prismatic joint."""
    return (
        f'<joint name="to_{child}" type="prismatic"><parent link="{parent}"/>'
        f'<child link="{child}"/><origin xyz="{at}"/><axis xyz="0 1 0"/>{LIMIT}</joint>'
    )


def turn(parent, child, at):
    """Write a revolute joint."""
    return slide(parent, child, at).replace("prismatic", "revolute")


@pytest.mark.parametrize(
    ("right", "found"),
    [
        ((-0.05, 0.05), []),  # the same gripper on both arms
        ((-0.0500000001, 0.05), []),
        ((0.15, 0.05), ["to_right_finger_1"]),
    ],
)
def test_a_gripper_that_is_mounted_twice_is_not_mirrored(tmp_path, right, found):
    names = ["base"]
    joints = ""
    for side, y, fingers in (("left", 0.3, (-0.05, 0.05)), ("right", -0.3, right)):
        above = "base"
        for part in ("arm", "elbow", "wrist", "hand"):
            names.append(f"{side}_{part}")
            joints += turn(above, names[-1], f"0.2 {y if above == 'base' else 0} 0.1")
            above = names[-1]
        for number, at in enumerate(fingers, 1):
            names.append(f"{side}_finger_{number}")
            joints += slide(above, names[-1], f"0 {at} 0.1")
    links = "".join(LINK.format(name, HEAVY) for name in names)
    text = f'<robot name="r">{links}{joints}</robot>'
    assert [f.name for f in find(tmp_path, text, "joint-not-mirrored")] == found


@pytest.mark.parametrize(("value", "count"), [("0 0 0", 0), ("0 0 1.57", 1)])
def test_a_misspelled_attribute_with_the_value_of_the_default_is_off(tmp_path, value, count):
    visual = shape("visual", "1 1 1").replace('xyz="0 0 0"', f'ryp="{value}"')
    text = f'<robot name="r"><link name="a">{visual}</link></robot>'
    assert len(find(tmp_path, text, "unknown-attribute")) == count


@pytest.mark.parametrize(("kind", "count"), [("prismatic", 0), ("revolute", 1)])
def test_a_body_that_only_slides_uses_no_inertia(tmp_path, kind, count):
    inside = MASS.format(3, 3, 3) + "</inertial>" + shape("collision", "0.1 0.1 0.1")
    links = LINK.format("world", "") + LINK.format("z", inside)
    text = f'<robot name="r">{links}{JOINT.format("world", "z", kind, LIMIT)}</robot>'
    assert len(find(tmp_path, text, "inertia-exceeds-geometry")) == count


@pytest.mark.parametrize(("xx", "pedantic", "count"), [(0.0419, False, 0), (0.0819, False, 1)])
def test_published_numbers_of_an_arm_are_off(tmp_path, xx, pedantic, count):
    six = f'ixx="{xx}" ixy="0" ixz="0" iyy="0.02514" iyz="0" izz="0.06175"'
    inertial = (
        '<inertial><origin xyz="0.003182886 -0.074322164 0.008814608"/>'
        f'<mass value="2.9355370338"/><inertia {six}/></inertial>'
    )
    inside = inertial + shape("collision", "0.1 0.1 0.1", "0 -0.05 0")
    links = LINK.format("a", HEAVY) + LINK.format("b", inside)
    text = f'<robot name="r">{links}{JOINT.format("a", "b", "revolute", LIMIT)}</robot>'
    assert len(find(tmp_path, text, "inertia-exceeds-geometry")) == count


@pytest.mark.parametrize(
    ("comment", "count"),
    [
        ("", 1),
        ("<!-- the second finger -->", 1),
        ("<!-- the axis is in the frame of the hand, because the viewer does not turn it -->", 0),
    ],
)
def test_a_comment_directly_above_that_gives_a_reason(tmp_path, comment, count):
    links = "".join(LINK.format(name, HEAVY) for name in ("hand", "left_finger", "right_finger"))
    left = slide("hand", "left_finger", "0 0.05 0.1").replace("-1", "0")
    right = slide("hand", "right_finger", "0 -0.05 0.1").replace('lower="-1"', 'lower="0"')
    text = f'<robot name="r">{links}{left.replace("to_", "finger_joint_")}\n{comment}\n'
    text += right.replace("to_", "finger_joint_") + "</robot>"
    assert len(find(tmp_path, text, "fingers-move-together")) == count


@pytest.mark.parametrize(("size", "count"), [("1 1 0.1", 0), ("0.1 0.1 0.01", 1)])
def test_scenery_does_not_move(tmp_path, size, count):
    inside = MASS.format(9000, 9000, 9000) + "</inertial>"
    inside += shape("visual", size) + shape("collision", size)
    text = f'<robot name="r">{LINK.format("table", inside)}</robot>'
    assert len(find(tmp_path, text, "inertia-exceeds-geometry")) == count


@pytest.mark.parametrize(("size", "count"), [("1 1 1", 0), ("0.9 0.9 0.9", 1)])
def test_a_unit_box_is_scaled_by_the_code_that_loads_it(tmp_path, size, count):
    inside = MASS.format(0.01, 0.01, 0.01).replace('value="1"', 'value="0.1"') + "</inertial>"
    inside += shape("visual", size) + shape("collision", size)
    cube = LINK.format("a", HEAVY) + LINK.format("cube", inside)
    text = f'<robot name="r">{cube}{JOINT.format("a", "cube", "revolute", LIMIT)}</robot>'
    assert len(find(tmp_path, text, "implausible-density")) == count


@pytest.mark.parametrize(("tag", "count"), [("ros2_control", 0), ("gazebo", 1)])
def test_an_expression_for_controllers_matters_to_ros_alone(tmp_path, tag, count):
    inside = '<joint name="j"><command_interface name="position"><param name="max">{pi}</param>'
    inside += "</command_interface></joint>"
    text = f'<robot name="r">{LINK.format("a", HEAVY)}<{tag}>{inside}</{tag}></robot>'
    assert len(find(tmp_path, text, "unexpanded-expression", targets=frozenset())) == count
    found = find(tmp_path, text, "unexpanded-expression", targets=frozenset({"ros2"}))
    assert [f.severity.label for f in found] == ["error"]


@pytest.mark.parametrize(("distance", "count"), [(0.06, 0), (0.09, 1)])
def test_slight_differences_of_left_and_right_are_off(tmp_path, distance, count):
    def side(name, x):
        inertial = HEAVY.replace("<mass", f'<origin xyz="{x} 0 0"/><mass')
        return LINK.format(name, inertial + shape("visual", "0.4 0.1 0.1"))

    links = LINK.format("base", HEAVY) + side("left_arm", 0.05) + side("right_arm", distance)
    joints = turn("base", "left_arm", "0 0.3 0") + turn("base", "right_arm", "0 -0.3 0")
    text = f'<robot name="r">{links}{joints}</robot>'
    assert len(find(tmp_path, text, "left-right-asymmetry")) == count


@pytest.mark.parametrize(("far", "count"), [("0", 0), ("0.1", 1)])
def test_a_sphere_around_a_drone_may_have_a_box_inside(tmp_path, far, count):
    ball = f'<collision><origin xyz="0 0 {far}"/><geometry><sphere radius="0.09"/></geometry>'
    body = shape("visual", "0.12 0.12 0.03") + ball + "</collision>"
    body += shape("collision", "0.1 0.1 0.03")
    text = f'<robot name="r">{LINK.format("drone", HEAVY + body)}</robot>'
    assert len(find(tmp_path, text, "collision-much-larger-than-visual")) == count


@pytest.mark.parametrize(("folder", "count"), [("robots", 1), ("test_data", 0)])
def test_values_of_inputs_of_tests_are_meant(tmp_path, monkeypatch, folder, count):
    monkeypatch.chdir(tmp_path)
    (tmp_path / folder).mkdir()
    inside = MASS.format(3, 3, 3) + "</inertial>" + shape("collision", "0.1 0.1 0.1")
    links = LINK.format("a", HEAVY) + LINK.format("b", inside)
    text = f'<robot name="r">{links}{JOINT.format("a", "b", "revolute", LIMIT)}</robot>'
    assert len(find(Path(folder), text, "inertia-exceeds-geometry")) == count
