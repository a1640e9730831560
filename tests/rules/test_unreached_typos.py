"""Typos in parts of xacro files that no robot expands."""

import pytest

from tests.conftest import XACRO
from urdftool.api.lint import check

RULE = "unreached-typo"
UNCALLED = '<xacro:macro name="never">{}</xacro:macro>'
BRANCH = '<xacro:if value="${{1 == 2}}">{}</xacro:if>'
JOINT = '<joint name="j" type="{}"><parent link="a"/><child link="b"/></joint>'


def _find(tmp_path, inside, around=UNCALLED, link='<link name="a"/>'):
    path = tmp_path / "r.urdf.xacro"
    path.write_text(XACRO.format(around.format(inside) + link))
    return [finding.message for finding in check(path, select=[RULE])]


@pytest.mark.parametrize("around", [UNCALLED, BRANCH])
@pytest.mark.parametrize(
    ("inside", "expected"),
    [
        (JOINT.format("revolut"), "<joint> has the unknown type 'revolut'; write revolute"),
        (
            JOINT.format("fixed").replace("child link", "child lnk"),
            "<child> has the unknown attribute 'lnk'; write link",
        ),
        (
            '<link name="x"><colision/></link>',
            "<link> has the unknown element <colision>; write <collision>",
        ),
        (
            '<link name="${{x}"/>',
            "${{x} is not a Python expression: '{' was never closed; nothing expands it here",
        ),
        (
            '<xacro:propety name="x" value="1"/>',
            "<xacro:propety> is neither a tag of xacro nor a macro here; write <xacro:property>",
        ),
        (JOINT.format("fixed"), None),
        (JOINT.format("${kind}"), None),
        ('<link name="${$(arg x)}"/>', None),
        ('<link name="$${{x}"/>', None),  # a dollar, not an expression
        ('<gazebo reference="a"><plugin name="p"><child lnk="a"/></plugin></gazebo>', None),
        ('<ros2_control name="c" type="system"><joint name="j" typ="a"/></ros2_control>', None),
        ("<xacro:included/>", None),  # a macro of another file
    ],
)
def test_a_typo_is_reported_where_nothing_expands_it(tmp_path, around, inside, expected):
    assert _find(tmp_path, inside, around) == ([] if expected is None else [expected])


def test_an_unused_property_is_checked(tmp_path):
    (message,) = _find(tmp_path, '<xacro:property name="x" value="${2 *}"/>', "{}")
    assert message.startswith("${2 *} is not a Python expression: invalid syntax")


def test_what_is_expanded_is_left_to_the_other_rules(tmp_path):
    path = tmp_path / "r.urdf.xacro"
    macro = UNCALLED.format('<link name="a"><colision/></link>')
    path.write_text(XACRO.format(f"{macro}<xacro:never/>"))
    assert {f.code for f in check(path)} & {RULE, "unknown-element"} == {"unknown-element"}


PART = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
STOPS = '<xacro:arg name="kind" default=""/><xacro:include filename="{}"/><link name="${{1/0}}"/>'


@pytest.mark.parametrize("name", ["part.xacro", "part.urdf.xacro"])
@pytest.mark.parametrize("is_included", [True, False])
def test_the_files_of_a_robot_that_stops_are_checked(urdftool, write, name, is_included):
    write("a/r.urdf.xacro", XACRO.format(STOPS.format(name if is_included else "gone.xacro")))
    write(f"a/{name}", PART.format(UNCALLED.format(JOINT.format("revolut"))))
    done = urdftool("lint", "a", "--format", "concise")
    assert done.code == 2
    found = [line for line in done.out.splitlines() if RULE in line]
    assert len(found) == 1
    assert all(line.startswith(f"a/{name}:1:") for line in found)


def test_a_typo_that_one_robot_expands_is_one_finding(urdftool, write):
    write("a/part.xacro", PART.format(UNCALLED.format('<link name="b"><colision/></link>')))
    include = '<xacro:include filename="part.xacro"/><link name="a"/>'
    write("a/one.urdf.xacro", XACRO.format(include))
    write("a/two.urdf.xacro", XACRO.format(f"{include}<xacro:never/>"))
    done = urdftool("lint", "a", "--format", "concise", "--select", f"{RULE},unknown-element")
    assert done.out.count("colision") == 1
    assert RULE not in done.out
