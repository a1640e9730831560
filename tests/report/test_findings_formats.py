import json
import os
import re
from xml.etree import ElementTree

import jsonschema
import pytest

from tests.report.sarif import SARIF

WHEELS = """<xacro:macro name="wheel" params="side">
  <joint name="${side}_joint" type="continuous">
    <parent link="base"/>
    <child link="${side}_wheel"/>
    <axis xyz="0 0 0"/>
  </joint>
  <link name="${side}_wheel"/>
</xacro:macro>
<link name="base"/>
<xacro:wheel side="left"/>
<xacro:wheel side="right"/>"""
NAMELESS = '<robot><link name="a"/></robot>'
HOSTILE = "<robot name='r'><link name=\"a&quot;]]>\x01&lt;script>%0A,::error::\"/>{}</robot>"
HOSTILE_NAMES = ["a,b:c%d.urdf", "a--><script>alert(1)</script>.urdf", "line\nbreak\x1b.urdf"]


@pytest.fixture
def lint(urdftool):
    def call(style, *words):
        return urdftool("lint", *words, "--format", style)

    return call


def sarif(result):
    log = json.loads(result.out)
    jsonschema.validate(log, SARIF)
    return log["runs"][0]


def test_sarif_has_rules_places_and_the_macro_chain(lint, xacro_file):
    run = sarif(lint("sarif", xacro_file("r.urdf.xacro", WHEELS), "--select", "zero-axis"))
    (rule,) = run["tool"]["driver"]["rules"]
    assert rule["id"] == "zero-axis"
    assert rule["defaultConfiguration"]["level"] == "error"
    assert "The axis of a moving joint is the zero vector." in rule["help"]["text"]
    (result,) = run["results"]
    assert (result["ruleId"], result["ruleIndex"], result["level"]) == ("zero-axis", 0, "error")
    (location,) = result["locations"]
    place = location["physicalLocation"]
    assert place["artifactLocation"]["uri"] == "r.urdf.xacro"
    assert place["region"] == {"startLine": 6, "startColumn": 11, "endLine": 6, "endColumn": 22}
    related = [(r["id"], r["message"]["text"]) for r in result["relatedLocations"]]
    assert related == [
        (1, "from macro 'wheel' side=left"),
        (2, "also right_joint, from macro 'wheel' side=right"),
    ]


def test_sarif_has_the_includes(lint, xacro_file, write):
    xacro_file("wheel.xacro", WHEELS)
    path = xacro_file("r.urdf.xacro", '<xacro:include filename="wheel.xacro"/>')
    run = sarif(lint("sarif", path, "--select", "zero-axis"))
    related = run["results"][0]["relatedLocations"]
    assert [r["message"]["text"] for r in related][1] == "from include"
    assert related[1]["physicalLocation"]["artifactLocation"]["uri"] == "r.urdf.xacro"


def test_sarif_keeps_what_comments_excuse(lint, write):
    comment = "<!-- urdftool-ignore[missing-name] it is a test -->"
    path = write("r.urdf", f'<robot> {comment}<link name="a"/><link name="a"/></robot>')
    run = sarif(lint("sarif", path, "--select", "missing-name,duplicate-link-name"))
    excused = {r["ruleId"]: r["suppressions"] for r in run["results"]}
    assert excused == {
        "duplicate-link-name": [],
        "missing-name": [{"kind": "inSource", "justification": "it is a test"}],
    }


def test_fingerprints_stay_when_lines_move_and_tell_twins_apart(lint, write):
    def prints(text):
        run = sarif(lint("sarif", write("r.urdf", text), "--select", "zero-axis"))
        return [r["partialFingerprints"]["primaryLocationLineHash"] for r in run["results"]]

    joint = (
        '<joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
        '<axis xyz="{}"/></joint>'
    )
    before = prints(f'<robot name="r">{joint.format("0 0 0")}</robot>')
    assert (
        prints(f'<robot name="r">\n\n<link name="a"/> {joint.format("0  0 0")}</robot>') == before
    )
    assert prints(f'<robot name="r">{joint.format("0 0 0.0")}</robot>') != before
    assert len(set(prints(f'<robot name="r">{joint.format("0 0 0") * 3}</robot>'))) == 3


def test_sarif_says_what_could_not_be_read(lint):
    result = lint("sarif", "absent.urdf")
    assert result.code == 2
    (invocation,) = sarif(result)["invocations"]
    assert invocation["executionSuccessful"] is False
    assert invocation["toolExecutionNotifications"][0]["level"] == "error"


def test_json_has_the_values_of_a_rule(lint, write):
    joint = "<joint name='j' type='fixed'><parent link='bas'/><child link='arm'/></joint>"
    links = "<link name='base'/><link name='arm'/>"
    path = write("r.urdf", f"<robot name='r'>{links}{joint}</robot>")
    (found,) = [
        finding
        for finding in json.loads(lint("json", path).out)["findings"]
        if finding["rule"] == "unknown-parent-link"
    ]
    assert found["data"]["suggestion"] == "base"


def test_github_annotations(lint, xacro_file):
    result = lint("github", xacro_file("r.urdf.xacro", WHEELS), "--select", "zero-axis")
    (line,) = result.out.splitlines()
    assert line.startswith(
        "::error file=r.urdf.xacro,line=6,endLine=6,col=11,endColumn=22,title=zero-axis::"
        "axis of joint 'left_joint' is zero"
    )
    assert "(in 2 expansions)%0A" in line
    assert "%0Afrom r.urdf.xacro:11:1: macro 'wheel' side=left" in line


def test_github_is_chosen_only_when_asked(urdftool, write, monkeypatch):
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    assert "::" not in urdftool("lint", write("r.urdf", NAMELESS)).out


def test_junit_has_a_suite_a_file(lint, write):
    bad = write("bad.urdf", NAMELESS)
    good = write("good.urdf", '<robot name="r"><link name="a"/></robot>')
    result = lint("junit", bad, good, "absent.urdf", "--select", "missing-name")
    root = ElementTree.fromstring(result.out)
    assert [suite.get("name") for suite in root] == ["bad.urdf", "good.urdf", "absent.urdf"]
    assert (root.get("tests"), root.get("failures"), root.get("errors")) == ("3", "1", "1")
    case = root.find("testsuite[1]/testcase")
    assert (case.get("classname"), case.get("name")) == ("bad.urdf", "missing-name")
    failure = case.find("failure")
    assert failure.get("type") == "error"
    assert failure.text.startswith("bad.urdf:1:1: error: ")
    assert len(root.find("testsuite[2]/testcase")) == 0


def test_junit_passes_what_does_not_fail_the_run(lint, write):
    joint = '<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>'
    path = write("r.urdf", f'<robot name="r"><link name="a"/><link name="b"/>{joint}</robot>')
    result = lint("junit", path, "--select", "axis-omitted")
    root = ElementTree.fromstring(result.out)
    assert (result.code, root.get("failures")) == (0, "0")
    assert "axis-omitted" in [case.get("name") for case in root.iter("testcase")]
    assert root.find(".//system-out") is not None
    failing = lint("junit", path, "--select", "axis-omitted", "--fail-on", "info")
    assert ElementTree.fromstring(failing.out).get("failures") == "1"


@pytest.mark.parametrize("name", HOSTILE_NAMES)
@pytest.mark.parametrize("text", [NAMELESS, HOSTILE.format(""), HOSTILE.format("<link/>")])
def test_hostile_names_are_escaped(lint, write, name, text):
    path = write(name, text)
    sarif(lint("sarif", path))
    ElementTree.fromstring(lint("junit", path).out)
    lines = lint("github", path).out.splitlines()
    assert lines
    for line in lines:
        assert re.fullmatch(
            r"::(error|warning|notice) file=[^:,]*,line=\d+,endLine=\d+"
            r"(,col=\d+,endColumn=\d+)?,title=[a-z0-9-]+::[^\r\n\x1b]*",
            line,
        )


@pytest.mark.skipif(os.name == "nt", reason="names are not bytes there")
@pytest.mark.parametrize("style", ["full", "concise", "json", "sarif", "github", "junit", "html"])
def test_a_name_that_is_no_utf_8(lint, write, style):
    path = write(os.fsdecode(b"caf\xe9.urdf"), NAMELESS)
    assert lint(style, path).code == 1


def test_no_findings_are_a_valid_report(lint, write):
    path = write("r.urdf", '<robot name="r"><link name="a"/></robot>')
    assert sarif(lint("sarif", path, "--select", "zero-axis"))["results"] == []
    assert lint("github", path, "--select", "zero-axis").out == ""
    assert ElementTree.fromstring(lint("junit", path).out).get("failures") == "0"


def test_html_is_one_page_that_asks_for_nothing_else(lint, xacro_file):
    page = lint("html", xacro_file("r.urdf.xacro", WHEELS), "--select", "zero-axis").out
    assert not re.search(r"(src|href|url)\s*[=(](?!\"#|\"data:)", page)
    assert 'href="#rule-zero-axis"' in page
    assert 'id="rule-zero-axis"' in page
    assert "axis of joint &#x27;left_joint&#x27; is zero" in page
    assert "<mark>xyz=&quot;0 0 0&quot;</mark>" in page
    assert "macro &#x27;wheel&#x27; side=right" in page


def test_html_begins_with_errors_and_names_files_by_relative_paths(lint, write, tmp_path):
    boxes = '<visual><geometry><box size="1 1 1"/></geometry></visual>'
    path = write(
        "r.urdf",
        f'<robot name="r"><link name="a">{boxes}</link><link name="b">{boxes}</link>'
        '<joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
        '<axis xyz="0 0 0"/></joint></robot>',
    )
    page = lint("html", path, "--extend-select", "pedantic").out
    levels = re.findall(r'<article class="(\w+)"', page)
    assert set(levels) >= {"error", "info"}
    assert levels == sorted(levels, key=["error", "warning", "info"].index)
    assert str(tmp_path) not in page
    assert "<code>r.urdf:1:" in page


@pytest.mark.library("PIL")
def test_html_has_a_picture_of_each_robot_or_the_reason_for_none(lint, write):
    box = '<visual><geometry><box size="1 1 1"/></geometry></visual>'
    drawn = write("drawn.urdf", f'<robot name="r"><link name="a">{box}<colision/></link></robot>')
    bare = write("bare.urdf", '<robot name="r"><link name="a"/><link name="b"/></robot>')
    page = lint("html", drawn, bare).out
    assert page.count('src="data:image/png;base64,') == 1
    assert "bare.urdf: no picture, the robot has no visual geometry that can be read" in page


@pytest.mark.parametrize("name", HOSTILE_NAMES)
def test_html_escapes_what_is_hostile(lint, write, name):
    page = lint("html", write(name, HOSTILE.format("<link/>"))).out
    assert page.count("<script>") == 1
    assert "\x1b" not in page
