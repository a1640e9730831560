import json

import jsonschema
import pytest

from tests.conftest import ROOT
from urdftool import check

ARM = """<xacro:arg name="prefix" default=""/>
<xacro:arg name="turns" default="true"/>
<link name="base"/>
<joint name="$(arg prefix)j" type="continuous">
  <parent link="base"/>
  <child link="tip"/>
  <axis xyz="0 0 0"/>
</joint>
<link name="tip"/>
<xacro:if value="$(arg turns)">
  <joint name="turn" type="continuous">
    <parent link="tip"/>
    <child link="end"/>
    <axis xyz="0 0 0"/>
  </joint>
  <link name="end"/>
</xacro:if>"""

TWO = """[[lint.variants]]
file = "r.urdf.xacro"
args = {prefix = "left_"}
[[lint.variants]]
file = "r.urdf.xacro"
args = {prefix = "right_", turns = false}
"""


@pytest.fixture
def arm(xacro_file, write):
    write("urdftool.toml", TWO)
    return xacro_file("r.urdf.xacro", ARM)


def test_findings_of_all_variants_are_merged(arm):
    findings = check(arm, select=["zero-axis"])
    assert [(f.name, f.variants) for f in findings] == [
        ("left_j", ()),
        ("turn", ("prefix=left_",)),
    ]


def test_a_finding_of_some_variants_says_which(arm, urdftool):
    result = urdftool("lint", arm, "--select", "zero-axis", "--format", "concise")
    every, some = result.out.splitlines()
    assert "only with" not in every
    assert "(only with prefix=left_)" in some
    table = json.loads(urdftool("lint", arm, "--select", "zero-axis", "--format", "json").out)
    jsonschema.validate(table, json.loads((ROOT / "docs/schemas/lint.json").read_text()))
    assert [f.get("variants") for f in table["findings"]] == [None, ["prefix=left_"]]


def test_the_command_line_takes_the_place_of_all(arm):
    findings = check(arm, select=["zero-axis"], args={"prefix": "other_"})
    assert [(f.name, f.variants) for f in findings] == [("other_j", ()), ("turn", ())]


def test_other_files_have_no_variants(arm, xacro_file):
    other = xacro_file("other.urdf.xacro", ARM)
    assert {f.name for f in check(other, select=["zero-axis"])} == {"j", "turn"}


def test_a_comment_that_one_variant_needs_is_not_unused(write, xacro_file):
    write("urdftool.toml", TWO)
    comment = '<!-- urdftool-ignore[zero-axis] a test -->\n  <joint name="turn"'
    path = xacro_file("r.urdf.xacro", ARM.replace('<joint name="turn"', comment))
    found = check(path, select=["zero-axis", "unused-suppression"])
    assert [f.code for f in found] == ["zero-axis"]


def test_a_variant_that_does_not_expand_is_a_finding(xacro_file, write):
    write("urdftool.toml", TWO.replace("turns = false", 'turns = "maybe"'))
    findings = check(xacro_file("r.urdf.xacro", ARM))
    (failed,) = [f for f in findings if f.code == "non-boolean-conditional"]
    assert failed.variants == ("prefix=right_ turns=maybe",)


@pytest.mark.parametrize(
    ("variant", "message"),
    [
        ('file = "r.urdf.xacro"\narg = {}', "has no option 'arg'; did you mean 'args'?"),
        ('file = "absent.xacro"', "file absent.xacro does not exist"),
        ("args = {}", "must have a file and its args"),
        ('file = "r.urdf.xacro"\nargs = ["a"]', "args must be a table"),
        ('file = "r.urdf.xacro"\nargs = {a = []}', "must be a text, a number, true or false"),
    ],
)
def test_what_a_variant_cannot_be(xacro_file, write, urdftool, variant, message):
    write("urdftool.toml", f"[[lint.variants]]\n{variant}\n")
    result = urdftool("lint", xacro_file("r.urdf.xacro", ARM))
    assert result.code == 2
    assert message in result.err
