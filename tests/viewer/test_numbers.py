from tests.conftest import FIXTURES
from urdftool.api.lint import check
from urdftool.model.load import load
from urdftool.viewer import panels
from urdftool.viewer.marks import find_highest_severity, format_counts, group_by_link
from urdftool.viewer.properties import (
    escape_html,
    format_table,
    link_rows,
    list_joint_rows,
    shorten_name,
)

from .robots import ARM, joint, limit, link, read, urdf


def test_nothing_that_a_file_says_is_markup():
    hostile = "<script>alert(1)</script>\"'&{x}"
    for text in (
        escape_html(hostile),
        format_table([(hostile, hostile)]),
        panels.format_notices([hostile]),
    ):
        assert "<script" not in text
        assert "&lt;script&gt;alert(1)&lt;/script&gt;&quot;&#x27;&amp;{x}" in text


def test_names_are_short_and_visible():
    long = "a" * 500 + "b" * 500
    assert len(shorten_name(long)) <= 60
    assert shorten_name(long).startswith("aaa")
    assert shorten_name(long).endswith("bbb")
    assert shorten_name("left\u202eright\n") == "left\\u202eright\\n"


def test_the_numbers_of_a_joint_and_a_link(tmp_path):
    body = (
        '<inertial><origin xyz="0 0 0.1"/><mass value="2.5"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="3"/></inertial>'
    )
    text = urdf(
        link("a", body), link("b", ""),
        joint("j", "revolute", "a", "b", '<axis xyz="0 1 0"/>' + limit(-1.5707963, 0)),
    )  # fmt: skip
    robot = read(tmp_path / "r.urdf", text)
    rows = dict(link_rows(robot, robot.link["a"]))
    assert rows["mass"] == "2.5 kg"
    assert rows["center of mass"] == "0 0 0.1 m"
    assert rows["ixx iyy izz"] == "1 2 3 kg·m²"
    assert rows["children"] == "b"
    assert rows["parent"] == "none (root link)"
    moved = dict(list_joint_rows(robot.joint["j"]))
    assert moved["limits"] == "-1.5708 … 0 rad (−90° … 0°)"
    assert moved["axis"] == "0 1 0"
    assert moved["parent"] == "a"
    assert moved["child"] == "b"
    assert "frame" in dict(link_rows(robot, robot.link["b"]))["note"]


def test_a_finding_is_on_the_links_it_is_about():
    robot = load(FIXTURES / "robots" / "demo_arm" / "urdf" / "arm.urdf.xacro")
    findings = check(robot)
    found = group_by_link(robot, findings)
    rules = {link: {finding.code for finding in those} for link, those in found.items()}
    # a joint's finding is on its child; of one macro called thrice each instance is on its link
    assert "unknown-attribute" in rules["forearm"]
    assert "mesh-not-found" in rules["tool"]
    for name in ("shoulder", "upper_arm", "forearm"):
        assert "inertia-triangle-inequality" in rules[name]
    assert set(found) <= set(robot.link)
    text = panels.format_findings(findings, found)
    assert all(escape_html(finding.message) in text for finding in findings)


def test_counts():
    robot = load(FIXTURES / "robots" / "demo_arm" / "urdf" / "arm.urdf.xacro")
    findings = check(robot)
    assert format_counts(findings).startswith("3 errors")
    assert format_counts([]) == ""
    assert find_highest_severity([]) is None


def test_all_parts_of_three_hundred_joints_are_there(tmp_path):
    from .robots import chain

    text = panels.format_parts(read(tmp_path / "r.urdf", chain(300)), {})
    assert text.count("<details>") == 601


def test_arm_is_summed_up(tmp_path):
    assert "5 links · 4 joints (4 moving) · 0 kg" in panels.format_summary(
        read(tmp_path / "r.urdf", ARM), None
    )
