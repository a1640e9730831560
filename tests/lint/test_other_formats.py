"""Lint of SDF and MJCF: findings at their lines, without effects and fixes of URDF."""

import json

import pytest

import urdftool as api
from tests.conftest import FIXTURES
from tests.formats.defective import joint, link, mjcf, sdf

INERTIAL = (
    "<inertial>\n<mass>{}</mass>\n<inertia>\n<ixx>{}</ixx><iyy>{}</iyy><izz>{}</izz></inertia>"
    "</inertial>"
)
LIMIT = "<xyz>0 0 1</xyz>\n<limit>\n<lower>{}</lower><upper>{}</upper></limit>"
HEAVY = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
BOX = '<geom type="box" size=".1 .1 .1"/>'

MODEL = sdf(
    link("base")
    + link("thin", INERTIAL.format(1, 1, 1, 9))
    + link("nothing", "")
    + link("half", "<inertial>\n<mass>1</mass></inertial>")
    + joint("base", "thin", LIMIT.format(-90, 90), "a")
    + joint("base", "nothing", LIMIT.format(1, -1), "b")
    + joint("base", "half", name="c")
)

BODIES = mjcf(
    f'<body name="base">\n{BOX}\n<body name="arm" pos="0 0 1">\n<joint name="j"/>\n{HEAVY}\n{BOX}'
    '</body></body>\n<geom type="plane" size="1 1 1"/>'
)


def line_of(text, part):
    return text[: text.index(part)].count("\n") + 1


def found(urdftool, path, *options):
    result = urdftool("lint", path, "--no-cache", "--format", "json", *options)
    return {f["rule"]: f for f in json.loads(result.out)["findings"]}, result


def test_findings_of_sdf_have_their_lines(urdftool, write):
    path = write("model.sdf", MODEL)
    findings, result = found(urdftool, path)
    assert result.code == 1
    assert "bug" not in result.err
    for code, part in (
        ("inertia-triangle-inequality", "<inertia>\n<ixx>1"),
        ("missing-inertial", '<link name="nothing"'),
        ("incomplete-inertial", "<inertial>\n<mass>1</mass></inertial>"),
        ("limit-in-degrees", "<limit>\n<lower>-90"),
        ("lower-above-upper", "<limit>\n<lower>1"),
    ):
        finding = findings[code]
        assert (finding["path"], finding["line"]) == (path, line_of(MODEL, part)), code
        assert not finding["effects"]
        assert not finding["hint"]
        assert finding["fix"] is None
    assert findings["missing-inertial"]["element"] == {"kind": "link", "name": "nothing"}


@pytest.mark.library("mujoco")
def test_findings_of_mjcf_have_their_lines(urdftool, write):
    path = write("model.xml", BODIES)
    findings, result = found(urdftool, path)
    assert set(findings) == {"placeholder-inertia"}
    assert findings["placeholder-inertia"]["line"] == line_of(BODIES, HEAVY)
    assert result.err.count("[unread-scenery]") == 1
    floor = line_of(BODIES, '<geom type="plane"')
    assert f"{path}:{floor}:1: note:" in result.err


def test_a_comment_suppresses_a_finding(urdftool, write):
    comment = "<!-- urdftool-ignore[lower-above-upper] known -->\n<limit>\n<lower>1"
    path = write("model.sdf", MODEL.replace("<limit>\n<lower>1", comment))
    findings, _ = found(urdftool, path)
    assert "limit-in-degrees" in findings
    assert "lower-above-upper" not in findings
    assert "unused-suppression" not in findings


def test_rules_about_the_text_of_urdf_do_not_run(urdftool, write):
    path = write("model.sdf", MODEL)
    for selected in ("xml", "xacro", "package", "gazebo", "simulation"):
        findings, _ = found(urdftool, path, "--select", selected)
        assert findings.keys() <= {"mass-ratio"}


def test_no_fix_changes_another_format(urdftool, write):
    path = write("model.sdf", MODEL)
    result = urdftool("lint", path, "--fix", "--unsafe-fixes")
    assert result.code == 1
    assert "model.sdf: not changed; fixes edit URDF and xacro only" in result.err
    with open(path, encoding="utf-8") as stream:
        assert stream.read() == MODEL
    assert urdftool("lint", path, "--diff").out == ""


@pytest.mark.parametrize("style", ["full", "concise", "json", "sarif", "github", "junit", "html"])
def test_every_output_names_a_model_that_cannot_be_read(urdftool, write, style):
    path = write("model.sdf", sdf(link("a") + link("a")))
    result = urdftool("lint", path, "--format", style)
    assert result.code == 2
    assert "unreadable-model" in result.out
    assert "two links named" in result.out


def test_malformed_xml_is_reported_as_such(urdftool, write):
    findings, result = found(urdftool, write("model.sdf", sdf(link("a"))[:-30]))
    assert (result.code, set(findings)) == (2, {"not-well-formed"})


def test_a_file_named_as_urdf_is_not_read_as_sdf(urdftool, write):
    findings, result = found(urdftool, write("model.urdf", MODEL))
    assert (result.code, set(findings)) == (2, {"wrong-root"})


def test_targets_and_format_are_those_of_the_file(write):
    robot = api.load(write("model.sdf", MODEL))
    assert robot.format == "sdf"
    codes = {finding.code for finding in api.check(robot)}
    assert codes == {finding.code for finding in api.check("model.sdf")}
    assert "missing-inertial" in codes


def test_a_model_without_defects_has_no_findings(urdftool):
    for path in sorted((FIXTURES / "formats" / "sdf").glob("*.sdf")):
        findings, result = found(urdftool, path, "--fail-on", "warning")
        warned = {c for c, f in findings.items() if f["severity"] != "info"}
        assert not warned - {"missing-inertial"}, path
        assert "bug" not in result.err
