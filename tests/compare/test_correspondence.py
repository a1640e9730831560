"""Robots that were made of others by hand, and the correspondences that declare how."""

import re

import pytest

from urdftool.compare.correspondence import parse_correspondence
from urdftool.compare.names import split_words

MASS = (
    '<inertial><origin xyz="0.01 0.02 0.03" rpy="0.1 0 0"/><mass value="{}"/><inertia ixx="0.02"'
    ' ixy="0.002" ixz="0.003" iyy="0.03" iyz="0.004" izz="0.04"/></inertial>'
)
BOX = (
    '<collision><origin xyz="0.1 0.02 0"/><geometry><box size="0.1 0.2 0.3"/></geometry>'
    "</collision>"
)
A = f"""<robot name="arm">
<link name="base">{MASS.format(4)}{BOX}</link>
<link name="upper">{MASS.format(2)}{BOX}</link>
<link name="tip">{MASS.format(1)}</link>
<link name="camera">{MASS.format(0.5)}</link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
<origin xyz="0.1 0 0.02" rpy="0 0 0.5"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="2" effort="30" velocity="3"/>
<safety_controller soft_lower_limit="-0.9" soft_upper_limit="1.9" k_velocity="1"/></joint>
<joint name="slide" type="prismatic"><parent link="upper"/><child link="tip"/>
<origin xyz="0 0 0.4"/><axis xyz="0 0 1"/><limit lower="0" upper="0.2" effort="9" velocity="1"/>
<mimic joint="shoulder" multiplier="0.1" offset="0.05"/></joint>
<joint name="mount" type="fixed"><parent link="tip"/><child link="camera"/>
<origin xyz="0 0.1 0"/></joint></robot>
"""


def replace_in(text, *pairs):
    for old, new in pairs:
        assert old in text, old
        text = text.replace(old, new)
    return text


# the slide, turned round: a link at its axis, to which the upper arm is fixed
ROOT = replace_in(
    A,
    (
        '<parent link="base"/><child link="upper"/>\n<origin xyz="0.1 0 0.02" rpy="0 0 0.5"/>'
        '<axis xyz="0 1 0"/>',
        '<parent link="upper"/><child link="m1"/><axis xyz="0 -1 0"/>',
    ),
    (
        '<parent link="upper"/><child link="tip"/>\n<origin xyz="0 0 0.4"/><axis xyz="0 0 1"/>',
        '<parent link="tip"/><child link="m2"/><axis xyz="0 0 -1"/>',
    ),
    (
        "</robot>",
        '<link name="m1"/><link name="m2"/><joint name="f2" type="fixed"><parent link="m2"/>'
        '<child link="upper"/><origin xyz="0 0 -0.4"/></joint>'
        '<joint name="f1" type="fixed"><parent link="m1"/><child link="base"/>'
        '<origin xyz="-0.08775825618903728 0.0479425538604203 -0.02" rpy="0 0 -0.5"/></joint>'
        "</robot>",
    ),
)

# the shoulder's position is -q + 0.25
VALUE = replace_in(
    A,
    ('<origin xyz="0.1 0 0.02" rpy="0 0 0.5"/>', '<origin xyz="0.1 0 0.02" rpy="0 0.25 0.5"/>'),
    ('<axis xyz="0 1 0"/>', '<axis xyz="0 -1 0"/>'),
    ('lower="-1" upper="2"', 'lower="-1.75" upper="1.25"'),
    ('lower_limit="-0.9" soft_upper_limit="1.9"', 'lower_limit="-1.65" soft_upper_limit="1.15"'),
    ('multiplier="0.1" offset="0.05"', 'multiplier="-0.1" offset="0.075"'),
)

MIRROR = replace_in(
    A,
    ('xyz="0.01 0.02 0.03" rpy="0.1 0 0"', 'xyz="0.01 -0.02 0.03" rpy="-0.1 0 0"'),
    ('ixy="0.002"', 'ixy="-0.002"'),
    ('iyz="0.004"', 'iyz="-0.004"'),
    ('xyz="0.1 0.02 0"', 'xyz="0.1 -0.02 0"'),
    ('rpy="0 0 0.5"', 'rpy="0 0 -0.5"'),
    ('xyz="0 0.1 0"', 'xyz="0 -0.1 0"'),
)

# two equal bodies 0.1 m apart along y, of 1 kg and 0.5 kg, turned by 0.1 rad about x
MERGED = replace_in(
    A,
    (f'<link name="camera">{MASS.format(0.5)}</link>\n', ""),
    (
        '<joint name="mount" type="fixed"><parent link="tip"/><child link="camera"/>\n'
        '<origin xyz="0 0.1 0"/></joint>',
        "",
    ),
    (
        f'<link name="tip">{MASS.format(1)}',
        '<link name="tip"><inertial><origin xyz="0.01 0.05333333333333333 0.03" rpy="0.1 0 0"/>'
        '<mass value="1.5"/><inertia ixx="0.04333333333333333" ixy="0.004" ixz="0.006" '
        'iyy="0.06003322222698374" iyz="0.00833111555132175" izz="0.0833001111063497"/>'
        "</inertial>",
    ),
)

EDITS = {
    "root": (ROOT, "root base tip"),
    "value": (VALUE, "joint shoulder shoulder sign -1 zero 0.25"),
    "mirror": (MIRROR, "mirror xz"),
    "merged": (MERGED, "merged tip camera"),
    "removed": (
        re.sub(r'<joint name="mount".*?</joint>|<link name="camera">.*?</link>', "", A, flags=re.S),
        "removed camera",
    ),
    "frame": (
        replace_in(
            A,
            ('<origin xyz="0 0.1 0"/></joint></robot>', "</joint></robot>"),
            (
                '<link name="camera"><inertial><origin xyz="0.01 0.02 0.03"',
                '<link name="camera"><inertial><origin xyz="0.01 0.12 0.03"',
            ),
        ),
        "frame camera xyz 0 -0.1 0 rpy 0 0 0",
    ),
}

MISTAKES = {
    "root": [
        ('<axis xyz="0 -1 0"/>', '<axis xyz="0 1 0"/>', "joint 'shoulder': axis"),
        ("-0.4", "-0.401", "link 'upper': pose"),
        ('"tip"', '"top"', "link 'tip': name"),
    ],
    "value": [
        ('offset="0.075"', 'offset="0.05"', "joint 'slide': mimic offset"),
        ('multiplier="-0.1"', 'multiplier="0.1"', "joint 'slide': mimic multiplier"),
        ('upper="1.25"', 'upper="2"', "joint 'shoulder': upper limit"),
        ('soft_upper_limit="1.15"', 'soft_upper_limit="1.9"', "soft upper limit"),
        ("0 0.25 0.5", "0 -0.25 0.5", "joint 'shoulder': origin"),
    ],
    "mirror": [
        ('<axis xyz="0 1 0"/>', '<axis xyz="0 -1 0"/>', "joint 'shoulder': axis"),
        ('iyz="-0.004"', 'iyz="0.004"', "own tensor"),
        ('xyz="0.1 -0.02 0"', 'xyz="0.1 0.02 0"', "collision"),
        ("0.01 -0.02 0.03", "0.01 0.02 0.03", "center of mass"),
    ],
    "merged": [
        ('ixy="0.004"', 'ixy="0.0041"', "link 'tip': own tensor"),
        ('value="1.5"', 'value="1"', "link 'tip': own mass"),
    ],
    "removed": [('"upper"', '"uper"', "link 'upper': name")],
    "frame": [("0.01 0.12 0.03", "0.01 0.02 0.03", "link 'camera'")],
}


@pytest.fixture
def compare(urdftool, write):
    def run(b, declared):
        files = write("a.urdf", A), write("b.urdf", b)
        return urdftool("verify", *files, "--map", write("map.txt", declared))

    return run


@pytest.mark.parametrize("name", EDITS)
def test_a_declared_edit_is_equal(compare, urdftool, name):
    text, declared = EDITS[name]
    result = compare(text, declared)
    assert result.code == 0, result.out
    if name != "merged":  # verify itself treats merged links as one body
        assert urdftool("verify", "a.urdf", "b.urdf").code == 1 or name == "frame"


@pytest.mark.parametrize(
    ("name", "old", "new", "named"),
    [(name, *mistake) for name, mistakes in MISTAKES.items() for mistake in mistakes],
)
def test_a_wrong_edit_is_named(compare, name, old, new, named):
    text, declared = EDITS[name]
    assert old in text
    result = compare(text.replace(old, new), declared)
    assert result.code == 1
    assert named in result.out


def test_a_part_of_a_larger_robot(compare):
    larger = A.replace('name="', 'name="l_').replace('link="', 'link="l_')
    larger = larger.replace('mimic joint="', 'mimic joint="l_').replace(
        'name="l_arm"', 'name="two"'
    )
    larger = larger.replace(
        "</robot>",
        '<link name="table"/><joint name="on" type="fixed"><parent link="table"/>'
        '<child link="l_base"/><origin xyz="0 1 0"/></joint></robot>',
    )
    parts = {kind: re.findall(rf'<{kind} name="(\w+)"', A) for kind in ("link", "joint")}
    names = [f"{kind} {name} l_{name}" for kind, found in parts.items() for name in found]
    declared = "\n".join(["branch base l_base", *names])
    assert compare(larger, declared).code == 0
    result = compare(larger, declared.replace("link tip l_tip", "link tip l_top"))
    assert result.code == 1
    assert "link 'tip': name" in result.out


@pytest.mark.parametrize(
    ("declared", "message"),
    [
        ("root base", "line 1 is not 'root OLD_ROOT NEW_ROOT'"),
        ("root base nowhere", "link 'nowhere' of the correspondence is not in robot 'arm'"),
        ("joint mount mount zero 1", "joint 'mount' of the correspondence does not have one"),
        ("joint shoulder shoulder sign 2", "line 1 is not"),
        ("joint shoulder shoulder zero inf", "line 1 is not"),
        ("mirror up", "line 1 is not 'mirror xy|xz|yz'"),
        ("frame tip 1 2 3", "line 1 is not 'frame LINK"),
        ("merged base upper", "link 'upper' is declared merged, but a joint moves it"),
        ("removed base", "the correspondence leaves no link"),
        ("wrong base", "line 1 is not 'joint A B' or 'link A B'"),
    ],
)
def test_a_bad_correspondence(compare, declared, message):
    result = compare(A, declared)
    assert result.code == 2
    assert message in result.err


def test_three_robots_have_names_only(urdftool, write):
    files = [write(f"{name}.urdf", A) for name in "abc"]
    result = urdftool("verify", *files, "--map", write("map.txt", "mirror xz"))
    assert result.code == 2
    assert "requires two robots, not 3" in result.err


def test_names_with_spaces_are_quoted():
    assert split_words('joint "upper arm" b  # the first') == ["joint", "upper arm", "b"]
    found = parse_correspondence([(1, ["root", "a b", "c"])], 2)
    assert found.root == "c"
    assert found.is_declared
