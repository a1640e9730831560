"""Update and check of an existing SRDF, byte by byte."""

import pytest

pytest.importorskip("fcl")

from tests.srdf.test_adjacent import BOX

# a and b turn at one joint; c is far from a; d hits a
ARM = f"""<robot name="arm">
  <link name="a">{BOX}</link><link name="b">{BOX}</link>
  <link name="c">{BOX}</link><link name="d">{BOX}</link>
  <joint name="ab" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.2 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="bc" type="fixed"><parent link="b"/><child link="c"/><origin xyz="0.2 0 0"/></joint>
  <joint name="cd" type="prismatic"><parent link="c"/><child link="d"/><origin xyz="0.2 0 0"/>
    <axis xyz="1 0 0"/><limit lower="-0.6" upper="0" effort="1" velocity="1"/></joint>
</robot>
"""
HEAD = '<?xml version="1.0"?>\n<!-- by hand -->\n<robot name="arm">\n'
AB = '  <disable_collisions link1="a" link2="b" reason="Adjacent"/>\n'
BC = AB.replace('"a"', '"c"')
CD = AB.replace('"a"', '"c"').replace('"b"', '"d"')
AC = '  <disable_collisions link1="c" link2="a" reason="Never"/>\n'
AD = '  <disable_collisions link1="a" link2="d" reason="Never"/>\n'


@pytest.mark.parametrize(
    ("before", "after", "code"),
    [
        (AB + BC + AC + CD, AB + BC + AC + CD, 0),
        (AB + BC + AC + AD + CD, AB + BC + AC + CD, 0),  # the pair that can touch is removed
        (AB + BC + CD, None, 0),  # a proved pair is added after the last one
        (AD.replace("Never", "User") + AB + BC + AC + CD, ..., 0),  # kept
        (AD.replace("\n", " <!-- why -->\n") + AB + BC + AC + CD, ..., 1),  # kept, reported
        (AB + AB.replace('"a"', '"x"') + BC + AC + CD, AB + BC + AC + CD, 0),  # vanished link
    ],
    ids=["same", "touches", "missing", "user", "comment", "vanished"],
)
def test_update_changes_only_its_pairs(urdftool, write, tmp_path, before, after, code):
    write("arm.urdf", ARM)
    write("arm.srdf", HEAD + before + "</robot>\n")
    result = urdftool("srdf", "arm.urdf", "--update", "arm.srdf", "-j", "1")
    text = (tmp_path / "arm.srdf").read_text("utf-8")
    assert result.code == code, result.err
    if after is None:
        start, end = text.split("</robot>")[0].rsplit("\n  <", 1)
        assert start + "\n" == HEAD + before
        assert end.startswith('disable_collisions link1="a" link2="c" reason="Never"/> <!-- proved')
    else:
        assert text == HEAD + (before if after is ... else after) + "</robot>\n"


@pytest.mark.parametrize("option", ["--check", "--update"])
@pytest.mark.parametrize("reason", ["User", "Adjacent"])
def test_a_pair_that_touches_on_purpose_is_named(urdftool, write, option, reason):
    write("arm.urdf", ARM)
    write("arm.srdf", HEAD + AD.replace("Never", reason) + AB + BC + AC + CD + "</robot>\n")
    result = urdftool("srdf", "arm.urdf", option, "arm.srdf", "-j", "1")
    named = "1 pair disabled on purpose can touch, and counts as right: 'a' and 'd' (User)"
    assert (named in result.err) == (reason == "User")
    assert result.code == int(reason != "User" and option == "--check")


MACRO = """<robot name="arm" xmlns:xacro="http://ros.org/wiki/xacro">
  <xacro:arg name="prefix" default="{default}"/>
  <xacro:macro name="pairs" params="p">
    <disable_collisions link1="${{p}}a" link2="${{p}}b" reason="Adjacent"/>
    <disable_collisions link1="${{p}}a" link2="${{p}}d" reason="Never"/>
  </xacro:macro>
  <xacro:pairs p="$(arg prefix)"/>{more}
</robot>
"""


def test_update_edits_a_macro_at_its_source(urdftool, write, tmp_path):
    write("arm.urdf", ARM)
    write("arm.srdf.xacro", MACRO.format(default="", more=""))
    result = urdftool("srdf", "arm.urdf", "--update", "arm.srdf.xacro", "-j", "1")
    text = (tmp_path / "arm.srdf.xacro").read_text("utf-8")
    assert result.code == 0, result.err
    assert 'link1="${p}a" link2="${p}d"' not in text
    assert '    <disable_collisions link1="${p}a" link2="${p}c" reason="Never"/>' in text


def test_update_refuses_a_macro_that_other_calls_need(urdftool, write, tmp_path):
    text = MACRO.format(default="", more='\n  <xacro:pairs p=""/>')
    write("arm.urdf", ARM)
    write("arm.srdf.xacro", text.replace("Adjacent", "User"))
    result = urdftool("srdf", "arm.urdf", "--update", "arm.srdf.xacro", "-j", "1")
    assert result.code == 1
    assert "not added: 'a' and 'c'" in result.err


def test_check_reports_the_pose(urdftool, write):
    write("arm.urdf", ARM)
    write("arm.srdf", HEAD + AB + BC + AD + CD + "</robot>\n")
    result = urdftool("srdf", "arm.urdf", "--check", "arm.srdf", "-j", "1")
    assert result.code == 1
    assert "arm.srdf:6:3: 'a' and 'd' are disabled (Never), but touch at ab " in result.out
    assert "1 missing, proved" in result.err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<robot name='q'><disable_collisions link1='x' link2='y'/></robot>", "another robot"),
        ("<robot name='arm'><disable_coll", "truncated"),
        ("<sdf/>", "the root element is <sdf>"),
    ],
)
def test_an_srdf_that_is_not_one(urdftool, write, text, message):
    write("arm.urdf", ARM)
    write("arm.srdf", text)
    for option in ("--check", "--update"):
        result = urdftool("srdf", "arm.urdf", option, "arm.srdf")
        assert result.code == 2
        assert message in result.err
