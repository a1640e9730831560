"""Left and right: which links are a pair, and what their pairs say."""

import pytest

from urdftool import check, load
from urdftool.rules.symmetry import get_sides

LINK = '<link name="{0}"/>\n'
JOINT = (
    '<joint name="{0}_joint" type="{3}"><parent link="{1}"/><child link="{0}"/>'
    '<origin xyz="{2}"/><axis xyz="{4}"/></joint>\n'
)


def robot(*parts):
    """A robot of links with parent, place, type and axis."""
    body = LINK.format("base")
    for name, parent, place, kind, axis in parts:
        body += LINK.format(name) + JOINT.format(name, parent, place, kind, axis)
    return f"<robot name='r'>\n{body}</robot>"


def test_a_finger_whose_name_is_like_a_side_is_no_left_one(write):
    fingers = [
        (f"{side}_{finger}_l1", "base", f"0.1 {sign}0.{n}1 0", "continuous", "0 0 1")
        for side, sign in (("L", ""), ("R", "-"))
        for n, finger in enumerate(("ff", "rf", "lf"))
    ]
    found = get_sides(load(write("hands.urdf", robot(*fingers))))
    assert {(pair.left.name, pair.right.name) for pair in found.pairs} == {
        (f"L_{finger}_l1", f"R_{finger}_l1") for finger in ("ff", "rf", "lf")
    }


@pytest.mark.parametrize(("axis", "count"), [("0 1 0", 0), ("0 -1 0", 1)])
def test_steering_is_not_compared_with_rolling(write, axis, count):
    parts = [
        ("front_left_wheel", "base", "0.3 0.2 0", "continuous", "0 0 1"),
        ("front_right_wheel", "base", "0.3 -0.2 0", "continuous", "0 0 1"),
        ("rear_left_wheel", "base", "-0.3 0.2 0", "continuous", "0 1 0"),
        ("rear_right_wheel", "base", "-0.3 -0.2 0", "continuous", "0 1 0"),
        ("middle_left_wheel", "base", "0 0.2 0", "continuous", "0 1 0"),
        ("middle_right_wheel", "base", "0 -0.2 0", "continuous", axis),
    ]
    path = write("cart.urdf", robot(*parts))
    assert len(check(path, select=("axis-against-others",))) == count


@pytest.mark.parametrize(
    ("flipped", "others", "named"),
    [
        ("0 -1 0", 3, "right_leg_3_joint"),  # the one that no other is like
        ("0 -1 0", 1, None),  # either may be right
        ("0 1 0", 3, None),
    ],
)
def test_a_pair_alone_of_its_kind_is_compared_with_its_limb(write, flipped, others, named):
    parts = []
    for side, sign in (("left", ""), ("right", "-")):
        above, place = "base", f"0 {sign}0.2 0"
        for number in range(others + 1):
            axis = flipped if (side, number) == ("right", others) else "0 1 0"
            kind = "revolute" if number < others else "continuous"
            name = f"{side}_leg_{number}"
            parts.append((name, above, place, kind, axis))
            above, place = name, "0 0 -0.3"
        parts.append((f"{side}_foot", above, place, "continuous", "1 0 0"))
    found = check(write("legs.urdf", robot(*parts)), select=("axis-against-others",))
    assert [finding.name for finding in found] == ([named] if named else [])


def test_links_in_a_circle_end_the_search(write):
    """A limb whose links carry each other has no pair above the first, and no last one."""
    parts = [
        (f"{side}_{name}", f"{side}_{above}" if above else "base", f"0 {sign}0.2 0.1")
        for side, sign in (("left", ""), ("right", "-"))
        for name, above in (
            *(("hip", ""), ("knee", "hip"), ("ankle", "knee")),
            *(("arm", "hand"), ("elbow", "arm"), ("hand", "elbow")),
        )
    ]
    parts += [(f"{side}_claw", "ring", "0 0 0.1") for side in ("left", "right")]
    parts += [("ring", "hoop", "0 0 0"), ("hoop", "ring", "0 0 0")]
    path = write("circle.urdf", robot(*((*part, "revolute", "0 1 0") for part in parts)))
    assert check(path, select=("axis-against-others", "com-not-mirrored")) == []


@pytest.mark.parametrize(
    ("names", "kind", "count"),
    [
        (("left_c", "right_c"), "revolute", 1),
        (("left_c", "right_c"), "fixed", 0),
        (("FL_LEG", "FR_LEG"), "revolute", 1),  # the L of LEG is not a side
        (("left_l", "left_r"), "revolute", 0),  # two side words, and no place tells which counts
    ],
)
def test_a_joint_that_may_lie_elsewhere_is_not_reported(write, names, kind, count):
    parts = [
        (f"{side}_{limb}", "base", f"{x} {sign}0.2 0", "revolute", "0 1 0")
        for side, sign in (("left", ""), ("right", "-"))
        for limb, x in (("a", 0.3), ("b", -0.3), ("d", 0.1))
    ]
    for name, place in zip(names, ("0 0.2 0", "0.05 -0.2 0"), strict=True):
        parts.append((name, "base", place, kind, "0 1 0"))
        parts.append((f"{name}_tip", name, "0 0 0.1", "revolute", "0 1 0"))
    found = check(write("r.urdf", robot(*parts)), select=("joint-not-mirrored",))
    assert len(found) == count


def test_of_two_pairings_the_places_choose(write):
    """Two claws, each with a left and a right jaw, which mirror in their own claw."""
    parts = []
    for side, sign in (("left", ""), ("right", "-")):
        parts.append((f"{side}_claw", "base", f"0 {sign}0.2 0", "revolute", "0 1 0"))
        for jaw, x in (("left", "0.02"), ("right", "-0.05")):
            name = f"{side}_{jaw}_jaw"
            parts.append((name, f"{side}_claw", f"{x} 0 0.1", "revolute", "0 1 0"))
    found = get_sides(load(write("claws.urdf", robot(*parts))))
    assert {(pair.left.name, pair.right.name) for pair in found.pairs} == {
        ("left_claw", "right_claw"),
        ("left_left_jaw", "right_left_jaw"),
        ("left_right_jaw", "right_right_jaw"),
    }
    assert found.off == []


def test_letters_of_a_series_are_no_sides(write):
    letters = "abcdelrst"
    parts = [
        (f"left_hand_{letter}", "base", f"0.1 0.{n}1 0", "revolute", "0 0 1")
        for n, letter in enumerate(letters)
    ]
    assert get_sides(load(write("hand.urdf", robot(*parts)))).pairs == []
    named = [(f"hand_{side}", "base", f"0 {y} 0", "revolute", "0 0 1") for side, y in SIDES]
    (pair,) = get_sides(load(write("hands.urdf", robot(*named)))).pairs
    assert (pair.left.name, pair.right.name) == ("hand_l", "hand_r")


SIDES = (("l", "0.2"), ("r", "-0.2"))

HANDS = """<robot name="r"><link name="base"/>{links}
{arms}</robot>"""
ARM = """<link name="{0}_arm"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>
<joint name="{0}_shoulder" type="revolute"><parent link="base"/><child link="{0}_arm"/>
<origin xyz="0 {1} 0"/><axis xyz="0 1 0"/>
<limit lower="{2}" upper="{3}" effort="1" velocity="1"/></joint>"""
HAND = """<link name="{0}_grip"/><link name="{0}_finger"><visual><geometry><sphere radius="0.1"/>
</geometry></visual></link>
<joint name="{0}_hand" type="revolute"><parent link="{0}_arm"/><child link="{0}_grip"/>
<origin xyz="0 {1} 0"/><axis xyz="1 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/>
</joint>
<joint name="{0}_curl" type="revolute"><parent link="{0}_arm"/><child link="{0}_finger"/>
<origin xyz="0 {1} 0"/><axis xyz="0 1 0"/><limit lower="0" upper="1" effort="1" velocity="1"/>
{2}</joint>"""


@pytest.mark.parametrize("followed", [True, False])
def test_the_opening_of_a_hand_is_no_limb(write, followed):
    text = "".join(
        ARM.format(side, y, -1, 2)
        + HAND.format(side, y, f'<mimic joint="{side}_hand"/>' if followed else "")
        + (f'<visual name="{side}"/>' if not followed else "")
        for side, y in SIDES
    )
    if not followed:  # then the joint is one that moves a shape
        shape = "<visual><geometry><sphere radius='0.1'/></geometry></visual></link>"
        for side, _ in SIDES:
            text = text.replace(f'<link name="{side}_grip"/>', f'<link name="{side}_grip">{shape}')
            text = text.replace(f'<visual name="{side}"/>', "")
    path = write("hands.urdf", HANDS.format(links="", arms=text))
    found = check(path, select=["limits-not-mirrored"])
    assert len(found) == (0 if followed else 1)


@pytest.mark.parametrize(
    ("right", "by_default", "count"),
    [((-1, 2), 0, 0), ((-0.9, 2.1), 0, 1), ((-0.9, 2), 1, 1), ((-2, 1), 1, 1)],
)
def test_ranges_of_equal_width_are_a_calibration(write, right, by_default, count):
    arms = ARM.format("left", 0.2, -1, 2) + ARM.format("right", -0.2, *right)
    arms += ARM.format("left_leg", 0.1, -1, 1) + ARM.format("right_leg", -0.1, -1, 1)
    path = write("arms.urdf", HANDS.format(links="", arms=arms))
    for select, expected in ((None, by_default), (["limits-not-mirrored"], count)):
        found = [f for f in check(path, select=select) if f.code == "limits-not-mirrored"]
        assert len(found) == expected


FACING = """<robot name="r"><link name="base"/>{0}</robot>"""
MOUNT = """<link name="{0}_mount"/><joint name="{0}_fixed" type="fixed"><parent link="base"/>
<child link="{0}_mount"/><origin xyz="0 {1} 0" rpy="0 0 {2}"/></joint>"""
STEP = """<link name="{0}_{1}"/><joint name="{0}_{1}_joint" type="continuous">
<parent link="{0}_{2}"/><child link="{0}_{1}"/><origin xyz="0 0.1 0.1"/><axis xyz="{3}"/></joint>"""


@pytest.mark.parametrize("flip", [0, 1])
def test_two_equal_arms_that_face_each_other_are_copies(write, flip):
    steps = (("waist", "mount", 2), ("shoulder", "waist", 0), ("elbow", "shoulder", 0))
    text = MOUNT.format("left", 0.5, 3.14159265) + MOUNT.format("right", -0.5, 0)
    for side in ("left", "right"):
        for name, above, axis in steps:
            vector = [0, 0, 0]
            vector[axis] = -1 if flip and side == "right" and name == "elbow" else 1
            text += STEP.format(side, name, above, " ".join(map(str, vector)))
    path = write("facing.urdf", FACING.format(text))
    found = check(path, select=["axis-against-others"])
    assert get_sides(load(path)).normal is not None
    assert len(found) == flip


def test_slides_without_a_range_are_not_compared(tmp_path):
    pytest.importorskip("mujoco")
    sides = "".join(
        f'<body name="{side}_arm" pos="0 {y} 0"><joint name="{side}_turn" axis="0 1 0" '
        f'range="-1 1"/><geom size=".1 .1 .1" type="box"/><body name="{side}_hand" pos="0 {y} 1">'
        f'<joint name="{side}_slide" type="slide" axis="0 0 1" actuatorfrcrange="-5 5"/>'
        '<geom size=".1 .1 .1" type="box"/></body></body>'
        for side, y in (("left", 1), ("right", -1))
    )
    path = tmp_path / "m.xml"
    body = f'<body name="base"><geom size=".1 .1 .1" type="box"/>{sides}</body>'
    path.write_text(f"<mujoco><worldbody>{body}</worldbody></mujoco>")
    found = check(path, select=["limits-not-mirrored", "mimic-limits-inconsistent"])
    assert [finding.message for finding in found] == []
