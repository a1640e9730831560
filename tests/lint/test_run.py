import json

import pytest

from tests.conftest import CORPUS, ROOT, XACRO
from urdftool import Severity, check, load
from urdftool.lint.discover import find_descriptions
from urdftool.lint.options import Options
from urdftool.lint.parallel import check_files
from urdftool.rules import get_rule

WHEEL = """<xacro:macro name="wheel" params="side">
  <joint name="${side}_joint" type="continuous">
    <parent link="base"/>
    <child link="${side}_wheel"/>
    <axis xyz="0 0 0"/>
  </joint>
  <link name="${side}_wheel"/>
</xacro:macro>"""


def test_instances_of_a_macro_are_one_finding(xacro_file):
    path = xacro_file(
        "r.urdf.xacro",
        f'{WHEEL}\n<link name="base"/>\n<xacro:wheel side="left"/>\n<xacro:wheel side="right"/>',
    )
    (finding,) = check(path, select=["zero-axis"])
    assert (finding.location.path, finding.location.line) == (path, 6)
    assert finding.expansions == 2
    assert finding.name == "left_joint"
    assert [call.what for call in finding.location.calls] == ["macro 'wheel' side=left"]
    ((name, calls),) = finding.others
    assert name == "right_joint"
    assert [call.what for call in calls] == ["macro 'wheel' side=right"]


def test_a_macro_in_a_file_included_twice_names_its_line_and_both_calls(
    xacro_file, write, urdftool
):
    part = f'{WHEEL}\n<xacro:wheel side="${{side}}"/>'
    write("wheel.xacro", XACRO.format(part))
    path = xacro_file(
        "r.urdf.xacro",
        '<link name="base"/>\n<xacro:property name="side" value="left"/>\n'
        '<xacro:include filename="wheel.xacro"/>\n<xacro:property name="side" value="right"/>\n'
        '<xacro:include filename="wheel.xacro"/>',
    )
    result = urdftool("lint", path, "--select", "zero-axis")
    assert result.out.startswith("wheel.xacro:6:11: error: axis of joint 'left_joint' is zero")
    assert "(in 2 expansions)" in result.out
    assert "from wheel.xacro:10:1: macro 'wheel' side=left" in result.out
    assert "from r.urdf.xacro:4:1: include" in result.out
    assert "also right_joint: from wheel.xacro:10:1: macro 'wheel' side=right" in result.out


def test_findings_come_in_the_order_of_the_source(write):
    joints = "".join(
        f'<joint name="{n}" type="continuous"><parent link="a"/><child link="{n}"/>'
        f'<axis xyz="0 0 0"/></joint>\n<link name="{n}"/>'
        for n in "zyx"
    )
    path = write("r.urdf", f'<robot name="r"><link name="a"/>\n{joints}</robot>')
    findings = check(path, select=["zero-axis"])
    assert [finding.name for finding in findings] == ["z", "y", "x"]


def test_a_robot_that_was_loaded_can_be_checked(write):
    path = write("r.urdf", '<robot name="r"><link name="l"/><link name="l"/></robot>')
    robot = load(path)
    assert {f.code for f in check(robot)} == {f.code for f in check(path)}


def test_a_file_that_is_not_well_formed_is_still_looked_at(write):
    path = write("r.urdf", "<!-- (c) -->\n<?xml version='1.0'?>\n<robot><link name='a'/></robot>")
    found = {f.code for f in check(path)}
    assert found == {"content-before-declaration", "missing-name"}


def test_a_file_of_macros_is_skipped(xacro_file, urdftool):
    path = xacro_file("m.urdf.xacro", '<xacro:macro name="m"><link name="a"/></xacro:macro>')
    result = urdftool("-v", "lint", path)
    assert result.code == 0
    assert "skipped, only macros" in result.err


def test_rules_run_on_a_robot_without_elements_of_urdf(write, urdftool):
    write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    meshes = '<mesh name="a" file="m.obj"/><mesh name="b" file="m.obj" scale="1 1 .0001"/>'
    geoms = '<geom type="mesh" mesh="a"/><geom type="mesh" mesh="b"/>'
    assets = f"<asset>{meshes}</asset><worldbody><body>{geoms}</body></worldbody>"
    for name, text in {"a": assets, "b": ""}.items():
        result = urdftool("lint", write(f"{name}.xml", f'<mujoco model="">{text}</mujoco>'))
        assert "failed" not in result.err
        assert result.code < 2


def test_a_rule_that_breaks_is_our_bug_and_the_others_run(write, urdftool, monkeypatch):
    def broken(robot):
        raise KeyError("oh")

    monkeypatch.setattr(get_rule("zero-axis"), "check", broken)
    path = write("r.urdf", '<robot><link name="a"/></robot>')
    result = urdftool("lint", path)
    assert result.code == 3
    assert "rule zero-axis failed because of a bug" in result.err
    assert ", 1 rule failed: zero-axis (targets" in result.err
    assert "[missing-name]" in result.out
    for style in ("json", "sarif", "github", "junit", "html"):
        again = urdftool("lint", path, "--format", style)
        assert again.code == 3
        assert "missing-name" in again.out
    notes = json.loads(urdftool("lint", path, "--format", "sarif").out)["runs"][0]["invocations"]
    assert "rule zero-axis" in notes[0]["toolExecutionNotifications"][0]["message"]["text"]
    assert urdftool("lint", path, "--exit-zero").code == 3


def test_exit_codes(write, urdftool):
    good = write("good.urdf", '<robot name="r"><link name="a"/></robot>')
    bad = write("bad.urdf", '<robot><link name="a"/></robot>')
    assert urdftool("lint", good).code == 0
    assert urdftool("lint", bad).code == 1
    assert urdftool("lint", bad, "--exit-zero").code == 0
    assert urdftool("lint", bad, "--ignore", "missing-name").code == 0
    assert urdftool("lint", bad, "absent.urdf").code == 2
    assert urdftool("lint", "absent.urdf", "--exit-zero").code == 2
    assert urdftool("lint").code == 2


def test_fail_on(write, urdftool):
    info = write(
        "r.urdf",
        '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="continuous">'
        '<parent link="a"/><child link="b"/></joint></robot>',
    )
    options = ("--select", "axis-omitted")
    assert urdftool("lint", info, *options).code == 0
    assert urdftool("lint", info, *options, "--fail-on", "info").code == 1


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--select", "zero-axes"], "did you mean 'zero-axis'?"),
        (["--ignore", "nothing-*"], "there is no rule 'nothing-*'"),
        (["--extend-select", "zero-axes"], "did you mean 'zero-axis'?"),
        (["--select", "mesh,inertai"], "did you mean 'inertia'?"),
        (["--format", "jsn"], "'jsn' is not one of 'full', 'concise', 'json'"),
        (["--fail-on", "errors"], "'errors' is not one of 'error', 'warning', 'info'"),
        (["--fromat", "json"], "Did you mean '--format'"),
        (["--target", "gazebo"], "did you mean 'gazebo-classic'?"),
        (["--explain", "zero-axes"], "did you mean 'zero-axis'?"),
    ],
)
def test_names_that_do_not_exist(urdftool, write, words, message):
    result = urdftool("lint", write("r.urdf", "<robot name='r'/>"), *words)
    assert result.code == 2
    assert message in result.err


def test_json_is_as_its_schema_says(write, urdftool, xacro_file):
    import jsonschema

    schema = json.loads((ROOT / "docs" / "schemas" / "lint.json").read_text())
    bad = xacro_file(
        "r.urdf.xacro",
        f'{WHEEL}\n<link name="base"/>\n<xacro:wheel side="left"/>\n<xacro:wheel side="right"/>',
    )
    skipped = xacro_file("m.urdf.xacro", '<xacro:macro name="m"/>')
    result = urdftool("lint", bad, skipped, "absent.urdf", "--format", "json")
    table = json.loads(result.out)
    jsonschema.validate(table, schema)
    assert table["version"] == 1
    finding = next(f for f in table["findings"] if f["rule"] == "zero-axis")
    assert finding["element"] == {"kind": "joint", "name": "left_joint"}
    assert (finding["line"], finding["column"], finding["end_column"]) == (6, 11, 22)
    assert finding["expansion"][0]["macro"] == "wheel"
    assert finding["instances"][0]["name"] == "right_joint"
    assert table["summary"]["files"] == 1


def test_several_processes_say_the_same(write):
    paths = [write(f"r{i}.urdf", f'<robot><link name="l{i}"/></robot>') for i in range(5)]
    alone = [[str(f) for f in r.findings] for r in check_files(paths, Options(), 1)]
    together = [[str(f) for f in r.findings] for r in check_files(paths, Options(), 2)]
    assert alone == together
    assert all(alone)


def test_folders_are_searched_for_descriptions(write):
    for name in ("a.urdf", "b/c.urdf.xacro", "b/macro.xacro", "b/d.sdf", ".hidden/e.urdf"):
        write(name, "<robot/>")
    assert find_descriptions(["."]) == ["a.urdf", "b/c.urdf.xacro"]
    assert find_descriptions(["b/macro.xacro", "b", "b/c.urdf.xacro"]) == [
        "b/macro.xacro",
        "b/c.urdf.xacro",
    ]


def test_list_and_explain(urdftool):
    listed = urdftool("lint", "--list-rules").out
    assert "zero-axis" in listed
    page = urdftool("lint", "--explain", "zero-axis").out
    assert "The axis of a moving joint is the zero vector." in page
    assert "Threshold: shortest" in page


@pytest.mark.corpus
def test_the_whole_corpus_is_checked_without_a_broken_rule():
    paths = find_descriptions([str(CORPUS)])
    assert len(paths) > 100
    options = Options(package_paths=(str(CORPUS),))
    for report in check_files(paths, options):
        assert report.error is None, report.path
        assert not report.failed_rules, report.path


def test_severities_are_ordered():
    assert Severity.ERROR > Severity.WARNING > Severity.INFO
