"""A description that cannot be read or expanded is not checked, and no option hides it."""

import json
from pathlib import Path
from xml.etree import ElementTree

import jsonschema
import pytest
import yaml

from tests.conftest import ROOT
from tests.report.sarif import SARIF
from urdftool import check
from urdftool.errors import SourceError

SCHEMA = json.loads((ROOT / "docs" / "schemas" / "lint.json").read_text())
PACKAGE = '<xacro:include filename="$(find not_there)/a.xacro"/><link name="base"/>'
MACRO = '<xacro:include filename="missing.xacro"/><link name="base"/>'
GOOD = '<robot name="r"><link name="a"/></robot>'
NO_NAMESPACE = """<robot name="r">
  <xacro:property name="w" value="0.1"/>
  <xacro:macro name="leg" params="prefix"><link name="${prefix}_leg"/></xacro:macro>
  <link name="base"/>
  <xacro:leg prefix="a"/>
  <joint name="j" type="fixed"><parent link="base"/><child link="a_leg"/></joint>
</robot>
"""

STOPS = {
    "package.urdf.xacro": ("package-not-found", PACKAGE),
    "include.urdf.xacro": ("include-not-found", MACRO),
    "macro.urdf.xacro": ("unknown-macro", "<xacro:wheel/>"),
    "name.urdf.xacro": ("undefined-name", '<link name="${nothing}"/>'),
    "open.urdf": ("not-well-formed", '<robot name="r"><link name="a">'),
    "sdf.urdf": ("wrong-root", '<sdf version="1.6"><model name="m"/></sdf>'),
    "namespace.urdf": ("missing-xmlns", NO_NAMESPACE),
}


@pytest.fixture(params=STOPS)
def stopped(request, write, xacro_file):
    rule, text = STOPS[request.param]
    make = xacro_file if request.param.endswith(".xacro") else write
    return rule, make(request.param, text)


HIDE = (
    ("--fail-on", "error"),
    ("--exit-zero",),
    ("--select", "zero-axis"),
    ("--target", "gz", "--no-cache"),
)


def test_it_is_an_error_and_no_option_hides_it(stopped, urdftool, write):
    rule, path = stopped
    write(
        "urdftool.toml",
        f'[lint]\nignore = ["{rule}"]\n[lint.severity]\n{rule} = "off"\n'
        f'[lint.per-file-ignores]\n"*" = ["{rule}"]\n',
    )
    for words in (*HIDE, ("--ignore", rule)):
        result = urdftool("lint", path, *words, "--format", "concise")
        assert result.code == 2, words
        assert f"error: {check(path)[0].message}" in result.out
        assert f"; nothing else in this description was checked [{rule}]" in result.out
        assert "1 file not checked" in result.err


def test_it_is_an_error_in_every_format(stopped, urdftool):
    rule, path = stopped
    words = ("lint", path, "--select", rule)
    record = json.loads(urdftool(*words, "--format", "json").out)
    jsonschema.validate(record, SCHEMA)
    (finding,) = record["findings"]
    assert (finding["rule"], finding["severity"], finding["not_checked"]) == (rule, "error", True)
    assert record["summary"]["files"] == 0
    assert record["summary"]["not_checked"] == [{"path": path, "reason": finding["message"]}]
    log = json.loads(urdftool(*words, "--format", "sarif").out)
    jsonschema.validate(log, SARIF)
    run = log["runs"][0]
    assert [result["level"] for result in run["results"]] == ["error"]
    assert run["invocations"][0]["executionSuccessful"] is False
    assert urdftool(*words, "--format", "github").out.startswith("::error file=")
    root = ElementTree.fromstring(urdftool(*words, "--format", "junit").out)
    assert root.get("errors") == "1"
    assert "1 file not checked" in urdftool(*words, "--format", "html").out
    shown = urdftool(*words, "--statistics")
    assert f"1  error    {rule}" in shown.out
    assert "1  error    not-checked" in shown.out
    whole = " ".join(urdftool(*words).out.split())  # long lines are wrapped
    assert "nothing else in this description was checked" in whole


@pytest.mark.parametrize("style", ["json", "sarif", "github", "junit", "html"])
def test_a_file_that_is_not_there_is_an_error_in_every_format(urdftool, style):
    result = urdftool("lint", "absent.urdf", "--format", style, "--exit-zero")
    assert result.code == 2
    assert "absent.urdf: no such file" in result.err
    if style == "json":
        record = json.loads(result.out)
        jsonschema.validate(record, SCHEMA)
        absent = [{"path": "absent.urdf", "reason": "no such file"}]
        assert record["summary"]["not_checked"] == absent
        assert record["summary"]["unreadable"] == absent
        return
    assert "no such file" in result.out
    assert "error" in result.out
    if style == "sarif":
        assert json.loads(result.out)["runs"][0]["results"][0]["ruleId"] == "not-checked"
    if style == "github":
        assert result.out == "::error file=absent.urdf,title=not-checked::no such file\n"


def test_it_is_counted_beside_what_was_checked(stopped, urdftool, write):
    write("good.urdf", GOOD)
    result = urdftool("lint", ".", "--select", "zero-axis")
    assert result.code == 2
    assert "1 error in 1 file, 1 file not checked" in result.err


def test_the_cache_keeps_that_it_was_not_checked(stopped, urdftool):
    _, path = stopped
    first, second = (urdftool("lint", path, "--exit-zero") for _ in range(2))
    assert (first.code, second.code) == (2, 2)
    assert first.out == second.out
    assert "1 file not checked" in second.err


def test_a_baseline_does_not_know_it(stopped, urdftool, write):
    rule, path = stopped
    result = urdftool("lint", path, "--write-baseline", "old.json")
    assert result.code == 2
    assert "not written, because a robot could not be checked" in result.err
    assert not Path("old.json").exists()
    finding = check(path)[0]
    from urdftool.lint.baseline import Baseline, make_baseline, to_text

    Path("old.json").write_text(to_text(make_baseline("old.json", [finding], {})))
    assert Baseline("old.json").get_entry(finding).rule == rule
    result = urdftool("lint", path, "--baseline", "old.json")
    assert result.code == 2
    assert rule in result.out


def test_a_comment_does_not_excuse_it(urdftool, xacro_file):
    path = xacro_file(
        "r.urdf.xacro", f"<!-- urdftool-ignore-file[package-not-found] later -->{PACKAGE}"
    )
    assert urdftool("lint", path).code == 2


def test_the_library_gives_the_error(stopped):
    rule, path = stopped
    found = check(path, select=["zero-axis"], ignore=["xml", "xacro", "package"])
    assert [(f.code, f.severity.label, f.unchecked) for f in found] == [(rule, "error", True)]
    with pytest.raises(SourceError, match="no such file"):
        check("absent.urdf")


def test_hooks_fail(stopped, urdftool):
    _, path = stopped
    for hook in yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text()):
        words = hook["entry"].split()
        if words[1] == "lint":
            assert urdftool(*words[1:], path).code == 2 or "--fix" in words


def test_a_variant_that_cannot_be_expanded_is_an_error(xacro_file, write, urdftool):
    path = xacro_file(
        "r.urdf.xacro",
        '<xacro:arg name="arm" default="none"/><link name="base"/>\n'
        "<xacro:if value=\"${'$(arg arm)' != 'none'}\">"
        '<xacro:include filename="$(arg arm).xacro"/></xacro:if>',
    )
    row = '[[lint.variants]]\nfile = "r.urdf.xacro"\nargs = {{arm = "{}"}}\n'
    write("urdftool.toml", row.format("none") + row.format("gone"))
    result = urdftool("lint", path, "--select", "zero-axis", "--format", "json")
    assert result.code == 2
    record = json.loads(result.out)
    (finding,) = record["findings"]
    assert finding["variants"] == ["arm=gone"]
    assert record["summary"]["not_checked"][0]["reason"].startswith("with arm=gone: ")


def test_a_file_that_is_repaired_is_checked(write, urdftool):
    path = write("r.urdf", '<robot name="r"><!-- a -- b --><link name="a"/></robot>')
    result = urdftool("lint", path, "--format", "json")
    assert result.code == 1
    assert json.loads(result.out)["summary"]["not_checked"] == []


def test_the_namespace_is_reported_first_and_its_fix_lets_the_rest_be_seen(write, urdftool):
    path = write("r.urdf", NO_NAMESPACE)
    (finding,) = check(path, fixes=True)
    assert "has 3 tags of xacro but does not declare its namespace" in finding.message
    assert finding.location.line == 2
    assert finding.fix is not None
    assert finding.fix.safe
    assert urdftool("lint", path, "--fix", "--select", "tree", "--no-cache").code == 0
    assert 'xmlns:xacro="http://www.ros.org/wiki/xacro"' in Path(path).read_text()


NOT_ROBOTS = {
    "chassis.stl": (b"solid \0\1\2\xff", "is a mesh, not a robot description"),
    "part.dae": (b"<COLLADA/>", "is a mesh, not a robot description"),
    "package.xml": (
        b'<?xml version="1.0"?><package format="3"><name>p</name></package>',
        "is a package manifest, not a robot description",
    ),
    "robot.bin": (b"\x7fELF\0\0\0", "is a binary file, not a robot description"),
}


@pytest.mark.parametrize("name", NOT_ROBOTS)
@pytest.mark.parametrize("style", ["full", "concise", "json"])
def test_other_files_are_named_for_what_they_are(write, urdftool, name, style):
    data, message = NOT_ROBOTS[name]
    result = urdftool("lint", write(name, data), "--format", style)
    assert result.code == 2
    assert f"{name}: {message}" in result.err
    if style == "json":
        assert json.loads(result.out)["findings"] == []
    else:
        assert result.out == ""


def test_utf_16_is_not_binary(write, urdftool):
    path = write("r.urdf", GOOD.encode("utf-16"))
    assert urdftool("lint", path, "--select", "zero-axis").code == 0


MACROS = '<xacro:macro name="leg" params="n"><link name="${n}"/></xacro:macro>'


def test_a_file_of_macros_says_so(xacro_file, urdftool):
    path = xacro_file("legs.xacro", MACROS)
    result = urdftool("lint", path)
    assert (result.code, result.out) == (0, "")
    assert result.err == (
        "legs.xacro: skipped, only macros (leg), without a link; lint the robot that includes it\n"
    )
    path = xacro_file("materials.xacro", '<material name="m"><color rgba="0 0 0 1"/></material>')
    assert "skipped, only <material>, without a link" in urdftool("lint", path).err


def test_a_folder_reports_the_xacro_files_that_it_skipped(xacro_file, write, urdftool):
    xacro_file("urdf/legs.xacro", MACROS)
    xacro_file("urdf/unused.xacro", MACROS)
    xacro_file("urdf/arms.urdf.xacro", MACROS)
    xacro_file("urdf/r.urdf.xacro", '<xacro:include filename="legs.xacro"/><xacro:leg n="a"/>')
    xacro_file("urdf/base.xacro", '<xacro:include filename="legs.xacro"/><xacro:leg n="b"/>')
    result = urdftool("lint", "urdf", "--select", "zero-axis")
    assert result.code == 0
    assert result.err.splitlines()[:2] == [
        "urdf/arms.urdf.xacro: skipped, only macros (leg), without a link; "
        "lint the robot that includes it",
        "urdf/unused.xacro: skipped, a part that none of the robots includes",
    ]
    assert "legs.xacro" not in result.err
    record = json.loads(urdftool("lint", "urdf", "--format", "json").out)
    jsonschema.validate(record, SCHEMA)
    assert [skipped["path"] for skipped in record["summary"]["skipped"]] == [
        "urdf/arms.urdf.xacro",
        "urdf/unused.xacro",
    ]


def test_what_the_configuration_excludes_is_not_looked_for(xacro_file, write, urdftool):
    xacro_file("test/bad.urdf.xacro", MACRO)
    write("r.urdf", GOOD)
    assert urdftool("lint", ".", "--select", "zero-axis").code == 2
    write("urdftool.toml", '[lint]\nexclude = ["test/*"]\n')
    result = urdftool("-v", "lint", ".", "--select", "zero-axis")
    assert result.code == 0
    assert "test/bad.urdf.xacro: skipped, excluded by 'test/*'" in result.err
    assert urdftool("lint", "test/bad.urdf.xacro").code == 2
    write("urdftool.toml", '[lint]\nexclude = "test"\n')
    result = urdftool("lint", ".")
    assert result.code == 2
    assert "lint.exclude must be a list of patterns" in result.err


@pytest.mark.parametrize("command", ["lint", "info", "expand"])
def test_an_argument_with_a_single_sign_is_understood(write, urdftool, command):
    path = write("r.urdf", GOOD)
    result = urdftool(command, path, "prefix=left_")
    assert result.code == 2
    assert "file 'prefix=left_' does not exist; did you mean prefix:=left_?" in result.err
    odd = write("a=b.urdf", GOOD)
    assert urdftool("lint", odd, "--select", "zero-axis").code == 0


TEMPLATE = """<robot name="object"><link name="base"><inertial><mass value="{0}"/>
<inertia ixx="{1}" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link></robot>"""


@pytest.mark.parametrize(
    ("mass", "moment", "is_template"),
    [
        ("MASS", "IXX", True),
        ("__MASS__", "__IXX__", True),
        ("MASS", "1", False),
        ("1,0", "i", False),
    ],
)
def test_a_template_is_not_checked_and_a_slip_is_an_error(
    tmp_path, urdftool, mass, moment, is_template
):
    path = tmp_path / "object.urdf"
    path.write_text(TEMPLATE.format(mass, moment))
    for place in (path, tmp_path):
        result = urdftool("lint", place, "--no-cache")
        said = f"object.urdf:1:50: error: a template, in which a program replaces '{mass}'"
        assert ("a template, in which" in result.out) is is_template
        assert (said in result.out) is is_template
        assert "[not-a-number]" in result.out
        assert (result.code == 2) is is_template
        if is_template:
            assert "1 not checked" in result.err or "1 file not checked" in result.err


def test_a_template_that_is_excluded_by_name_is_skipped(tmp_path, urdftool):
    (tmp_path / "object.urdf").write_text(TEMPLATE.format("MASS", "IXX"))
    (tmp_path / "good.urdf").write_text(GOOD)
    (tmp_path / "urdftool.toml").write_text('[lint]\nexclude = ["object.urdf"]\n')
    result = urdftool("lint", tmp_path, "--select", "zero-axis")
    assert result.code == 0
    assert "checked 1 robot (1 variant), 0 files belong to it, 0 not checked" in result.err


def test_a_folder_of_meshes_that_a_program_writes_is_said(tmp_path, urdftool):
    pytest.importorskip("mujoco")
    path = tmp_path / "gripper.xml"
    body = '<worldbody><body><geom type="mesh" mesh="a"/></body></worldbody></mujoco>'
    for folder in ("__MESHDIR__", "meshes"):
        path.write_text(f'<mujoco><asset><mesh name="a" file="{folder}/a.stl"/></asset>{body}')
        result = urdftool("lint", path)
        assert result.code == 2
        assert ("a template" in result.out) is (folder == "__MESHDIR__")
        assert "gripper.xml:1:" in result.out


def test_one_reason_of_several_files_is_one_error(tmp_path, urdftool):
    """The code that loads these parts sets the texture; MuJoCo rejects them as they are."""
    pytest.importorskip("mujoco")
    texture = '<asset><texture name="t" type="2d" file="{}.png"/></asset>'
    body = '<worldbody><body><geom size="0.1"/></body></worldbody>'
    for name, file in (("a", "wood"), ("b", "wood"), ("c", "stone")):
        text = f"<mujoco>{texture.format(file)}{body}</mujoco>"
        (tmp_path / f"{name}.xml").write_text(text)
    result = urdftool("lint", tmp_path, "--format", "concise")
    assert result.code == 2
    assert "file 'wood.png' does not exist (and 1 more)" in result.out
    assert "file 'stone.png' does not exist;" in result.out
    assert "3 not checked" in result.err
