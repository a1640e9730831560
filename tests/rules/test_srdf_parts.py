"""What is reported of parts of an SRDF that MoveIt drops."""

import pytest

from urdftool import check
from urdftool.model.read import read_robot
from urdftool.model.semantic import read_semantic
from urdftool.model.semantic_groups import list_joints_of_group
from urdftool.source.document import parse
from urdftool.source.location import SourceFile

LINK = '<link name="{}"/>'
JOINT = """<joint name="{}" type="revolute"><parent link="{}"/><child link="{}"/>
  <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>"""
ROBOT = (
    '<robot name="arm">'
    + "".join(map(LINK.format, ("base", "a", "b", "c")))
    + JOINT.format("j1", "base", "a")
    + JOINT.format("j2", "a", "b")
    + JOINT.format("j3", "a", "c")
    + "</robot>"
)
GROUP = '<group name="arm"><chain base_link="base" tip_link="b"/></group>'
STATE = '<group_state name="home" group="arm"><joint name="j1" value="{}"/></group_state>'


@pytest.fixture
def lint(write, monkeypatch, tmp_path):
    """Check an arm with an SRDF of some parts: rule, severity and effects of each finding."""
    monkeypatch.chdir(tmp_path)

    def run(*parts):
        write("arm.urdf", ROBOT)
        write("arm.srdf", f'<robot name="arm">{GROUP}{"".join(parts)}</robot>')
        rules = ("srdf-unknown-group", "srdf-part-not-read", "group-state-not-taken")
        found = check("arm.urdf", select=(*rules, "srdf-unknown-joint"), targets=("moveit",))
        return [(f.code, f.severity.label, f.effects["moveit"]) for f in found]

    return run


def test_parts_that_moveit_reads_are_no_finding(lint):
    assert (
        lint(
            *(STATE.format(text) for text in ("0.5", " -1e-1 ", ".5")),
            '<group name="all"><group name="arm"/><joint name="j3"/></group>',
            '<virtual_joint name="v" type="Floating" parent_frame="map" child_link="base"/>',
            '<virtual_joint name="w" type="fixed" parent_frame="map" child_link="a"/>',
            '<disable_collisions link1="a" link2="b" reason="Never"/>',
            '<joint_property joint_name="v" property_name="x" value="1"/>',
            '<gripper name="tool" clearance="0.1"><link name="c"/></gripper>',
            '<link_sphere_approximation link="a"><sphere center="0 0 0" radius="1"/>'
            "</link_sphere_approximation>",
        )
        == []
    )


@pytest.mark.parametrize(
    ("part", "rule", "severity", "effect"),
    [
        (STATE.format("0").replace('"arm"', '"arms"'), "srdf-unknown-group", "error", "the state"),
        ('<group name="x"><group name="y"/></group>', "srdf-unknown-group", "error", "contains it"),
        (
            '<group name="t"><link name="c"/></group>'
            '<end_effector name="t" group="t" parent_link="a" parent_group="ar"/>',
            "srdf-unknown-group",
            "warning",
            "another group",
        ),
        ('<group name="x"/>', "srdf-part-not-read", "warning", "adds no such group"),
        (GROUP, "srdf-part-not-read", "error", "second group"),
        (
            '<group name="x"><chain base="base" tip_link="b"/></group>',
            "srdf-part-not-read",
            "error",
            "ignores the element",
        ),
        (
            '<disable_collision link1="a" link2="b"/>',
            "srdf-part-not-read",
            "error",
            "not read it",
        ),
        (
            '<disable_collisions link1="a" link2="b" resaon="Never"/>',
            "srdf-part-not-read",
            "warning",
            "not read it",
        ),
        (
            f'<group name="x"><link name="a"/>{STATE.format("0")}</group>',
            "srdf-part-not-read",
            "error",
            "not read it",
        ),
        (
            '<virtual_joint name="v" type="float" parent_frame="map" child_link="base"/>',
            "srdf-part-not-read",
            "error",
            "takes a fixed joint",
        ),
        (
            '<virtual_joint name="v" type="planar" parent_frame="map" child_link="a"/>',
            "srdf-part-not-read",
            "warning",
            "skips",
        ),
        (STATE.format("zero"), "group-state-not-taken", "error", "takes 0"),
        (STATE.format("0.5rad"), "group-state-not-taken", "error", "leaves the joint out"),
        (STATE.format("0.5 1"), "group-state-not-taken", "error", "leaves the joint out"),
        (STATE.format("0").replace("j1", "j3"), "group-state-not-taken", "warning", "leaves"),
        (
            '<joint_property joint_name="j7" property_name="x" value="1"/>',
            "srdf-unknown-joint",
            "error",
            "ignores that part",
        ),
    ],
)
def test_a_part_that_moveit_drops_is_a_finding(lint, part, rule, severity, effect):
    ((code, label, said),) = lint(part)
    assert (code, label) == (rule, severity)
    assert effect in said


@pytest.mark.parametrize(
    ("content", "joints"),
    [
        ('<chain base_link="base" tip_link="b"/>', {"j1", "j2"}),
        ('<chain base_link="b" tip_link="c"/>', {"j1", "j2", "j3"}),
        ('<chain base_link="b" tip_link="a"/>', {"j1", "j2"}),
        ('<link name="c"/><link name="base"/>', {"j3"}),
        ('<joint name="j2"/><group name="arm"/>', {"j2"}),
    ],
)
def test_joints_of_a_group_are_those_of_moveit(content, joints):
    robot = read_robot(parse(SourceFile("arm.urdf", ROBOT.encode())).root)
    srdf = f'<robot name="arm"><group name="arm">{content}</group></robot>'
    semantic = read_semantic(parse(SourceFile("arm.srdf", srdf.encode())).root)
    assert list_joints_of_group(semantic, "arm", robot) == joints
