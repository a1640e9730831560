"""Results of ``attach`` and ``prefix`` as xacro files, which include their sources."""

import pytest

from tests.edit.robots import ARM, GRIPPER

XMLNS = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LINK = (
    '<link name="{}{}"><inertial><mass value="{}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" '
    'iyz="0" izz="1"/></inertial></link>'
)
HINGE = (
    '<joint name="{0}hinge" type="continuous"><parent link="{0}{1}"/><child link="{0}{2}"/>'
    '<axis xyz="0 0 1"/></joint>'
)


def make_xacro(body, name="robot"):
    return f'<robot name="{name}" {XMLNS}>{body}</robot>'


def make_arm(argument="prefix", default=""):
    """Return an arm whose names begin with an argument."""
    start = f"$(arg {argument})"
    links = LINK.format(start, "base", 3) + LINK.format(start, "tool", 2)
    head = f'<xacro:arg name="{argument}" default="{default}"/>'
    return make_xacro(head + links + HINGE.format(start, "base", "tool"), "arm")


MACRO = make_xacro(
    '<xacro:macro name="hand" params="prefix parent *origin">'
    '<joint name="${prefix}mount" type="fixed"><parent link="${parent}"/>'
    '<child link="${prefix}palm"/><xacro:insert_block name="origin"/></joint>'
    + LINK.format("${prefix}", "palm", 1)
    + LINK.format("${prefix}", "finger", 0.5)
    + HINGE.format("${prefix}", "palm", "finger")
    + "</xacro:macro>"
)
CALL = make_xacro(
    '<xacro:arg name="prefix" default="{0}"/><xacro:arg name="stage" default="world"/>'
    '<xacro:include filename="hand_macro.xacro"/>'
    '<link name="world"/>'
    '<xacro:hand prefix="$(arg prefix)" parent="$(arg stage)"><origin xyz="0 0 1"/></xacro:hand>',
    "hand",
)


@pytest.fixture
def sources(write):
    write(".git/HEAD", "ref: refs/heads/main\n")
    write("part/hand_macro.xacro", MACRO)
    return {
        "arm": write("arm/arm.urdf.xacro", make_arm()),
        "hand": write("part/hand.urdf.xacro", CALL.format("")),
        "call": write("part/call.urdf.xacro", CALL.replace('"$(arg prefix)"', '""').format("")),
        "second": write("part/second.urdf.xacro", CALL.format("x_")),
        "named": write("part/named.urdf.xacro", make_arm("id", "left_")),
        "plain": write("part/plain.urdf", GRIPPER.replace('<material name="gray"/>', "")),
        "urdf": write("arm/plain_arm.urdf", ARM),
    }


TO = ("--to", "tool", "--xyz", "0", "0", "0.5")
CASES = {
    "an argument": (("prefix", "arm", "l_"), ['name="prefix" default="l_"']),
    "a macro": (("prefix", "call", "l_"), ['prefix="l_"', 'name="world"']),
    "a name before all others": (("prefix", "named", "g_"), ['name="id" default="g_left_"']),
    "two arguments": (("attach", "arm", "named", *TO, "--prefix", "g_"), ['default="g_left_"']),
    "a macro with parent": (
        ("attach", "arm", "hand", *TO, "--prefix", "g_"),
        ['prefix="g_" parent="tool"', 'xyz="0 0 0.5"'],
    ),
    "an argument of both": (
        ("attach", "arm", "second", *TO, "--prefix", "g_"),
        ['prefix="g_x_" parent="tool"'],
    ),
    "an arm without macros": (("attach", "urdf", "hand", *TO, "--prefix", "g_"), ["<xacro:hand"]),
    "an argument that is given": (
        ("attach", "arm", "prefix:=a_", "hand", "--to", "a_tool", "--prefix", "g_"),
        ['name="prefix" default="a_"', 'prefix="g_" parent="a_tool"'],
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_the_xacro_file_is_the_urdf_of_the_same_operation(urdftool, sources, tmp_path, name):
    words, expected = CASES[name]
    words = [sources.get(word, word) for word in words]
    out = tmp_path / "new" / "robot.urdf.xacro"
    result = urdftool("edit", *words, "-o", out)
    assert result.code == 0, result.err
    text = out.read_text()
    for part in expected:
        assert part in text
    assert "<inertial>" not in text, "content of a source was copied"
    assert (out.parent / "robot.map").exists()
    joint = ("--joint", "g_mount") if words[0] == "attach" and "hand" in text else ()
    assert urdftool("edit", *words, *joint, "-o", tmp_path / "robot.urdf").code == 0
    again = urdftool("verify", tmp_path / "robot.urdf", out)
    assert again.code == 0, again.out


BROKEN = {
    "a joint without prefix": (
        {"arm/arm.urdf.xacro": make_arm().replace('"$(arg prefix)hinge"', '"hinge"')},
        ("prefix", "arm", "l_"),
        "joint 'l_hinge' is missing",
    ),
    "a mass that the prefix changes": (
        {
            "arm/arm.urdf.xacro": make_arm().replace(
                '<mass value="2"/>', "<mass value=\"${2 if '$(arg prefix)' == '' else 5}\"/>"
            )
        },
        ("prefix", "arm", "l_"),
        "mass differs",
    ),
    "a plain URDF": ({}, ("prefix", "urdf", "l_"), 'declare <xacro:arg name="prefix" default=""/>'),
    "an argument with two values": (
        {"part/named.urdf.xacro": make_arm("prefix", "x_")},
        ("attach", "arm", "named", *TO, "--prefix", "g_"),
        "both declare xacro argument 'prefix': '' and 'g_x_'",
    ),
    "a world that cannot go": (
        {},
        ("attach", "arm", "plain", *TO, "--prefix", "g_"),
        "write a URDF: -o robot.urdf",
    ),
    "a relative mesh": (
        {
            "arm/arm.urdf.xacro": make_arm().replace(
                "</link>",
                '<visual><geometry><mesh filename="../a.stl"/></geometry></visual></link>',
                1,
            )
        },
        ("prefix", "arm", "l_"),
        "path '../a.stl' would refer to the folder of",
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_cannot_be_included_is_an_error(urdftool, sources, write, tmp_path, name):
    files, words, message = BROKEN[name]
    for path, text in files.items():
        write(path, text)
    out = tmp_path / "new" / "robot.urdf.xacro"
    result = urdftool("edit", *[sources.get(word, word) for word in words], "-o", out)
    assert result.code == 2, result.err
    assert message in result.err
    assert not out.parent.exists()
