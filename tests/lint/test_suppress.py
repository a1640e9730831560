import pytest

from tests.conftest import XACRO
from urdftool import check

BAD_LINK = """<robot name="r">
  <link name="base"/>
  <joint name="j" type="continuous">{0}
    <parent link="base"/>
    <child link="arm"/>
    {1}
    <axis xyz="0 0 0"/>{2}
  </joint>
  <link name="arm"/>
</robot>
"""
IGNORE = "<!-- urdftool-ignore[zero-axis] it is a test -->"


def rules(path, **options):
    return [finding.code for finding in check(path, select=["zero-axis", "lint"], **options)]


@pytest.mark.parametrize("where", [(IGNORE, "", ""), ("", IGNORE, ""), ("", "", IGNORE)])
def test_own_line_or_next_element(write, where):
    covered = where[0] == ""
    found = rules(write("r.urdf", BAD_LINK.format(*where)))
    assert ("zero-axis" in found) is not covered


def test_before_an_element_it_covers_all_inside(write):
    text = BAD_LINK.format("", "", "").replace("  <joint", f"  {IGNORE}\n  <joint")
    assert rules(write("r.urdf", text)) == []


def test_prefixes_families_and_lists(write):
    for names in ("zero-*", "joint", "mesh-not-found, zero-axis", "all"):
        comment = f"<!-- urdftool-ignore[{names}] -->"
        found = rules(write("r.urdf", BAD_LINK.format("", comment, "")))
        assert "zero-axis" not in found, names


def test_the_whole_file(write):
    text = BAD_LINK.format("", "", "").replace(
        '<link name="base"/>', "<!-- urdftool-ignore-file[zero-axis] -->\n<link name='base'/>"
    )
    assert rules(write("r.urdf", text)) == []


def test_one_that_covers_nothing_is_a_finding(write):
    text = BAD_LINK.format("", "", IGNORE).replace("0 0 0", "0 0 1")
    assert rules(write("r.urdf", text)) == ["unused-suppression"]


def test_one_for_a_rule_that_did_not_run_is_not(write):
    text = BAD_LINK.format("", "", "<!-- urdftool-ignore[mesh-not-found] -->")
    assert rules(write("r.urdf", text)) == ["zero-axis"]


def test_an_unknown_rule_names_the_nearest(write):
    text = BAD_LINK.format("", "", "<!-- urdftool-ignore[zero-axes] -->")
    findings = check(write("r.urdf", text), select=["lint"])
    assert [f.code for f in findings] == ["unknown-rule"]
    assert "did you mean 'zero-axis'?" in findings[0].message


MACRO = """<xacro:macro name="turn" params="name">
  <joint name="${{name}}" type="continuous">
    <parent link="base"/>
    <child link="${{name}}_link"/>
    <axis xyz="0 0 0"/>{inside}
  </joint>
  <link name="${{name}}_link"/>
</xacro:macro>
<link name="base"/>
{before}
<xacro:turn name="a"/>
<xacro:turn name="b"/>"""


def macro(write, **comments):
    text = MACRO.format(**{"inside": "", "before": "", **comments})
    return write("r.urdf.xacro", XACRO.format(text))


def test_inside_a_macro_it_covers_every_expansion(write):
    assert rules(macro(write, inside=IGNORE)) == []


def test_before_a_call_it_covers_what_that_call_expands_to(write):
    path = macro(write, before=IGNORE)
    (finding,) = check(path, select=["zero-axis", "lint"])
    assert finding.name == "b"
    assert finding.expansions == 1


@pytest.mark.parametrize(
    ("comment", "message"),
    [
        ("urdftool-ignore[zero-axes]", "there is no rule 'zero-axes'; did you mean 'zero-axis'?"),
        ("urdftool-ignore[mesh, inertai] x", "there is no rule 'inertai'; did you mean 'inertia'"),
        ("urdftool-ignore-file[mehs-*]", "there is no rule 'mehs-*'; did you mean 'mesh'?"),
        ("urdftool-ignore[]", "does not name a rule; write urdftool-ignore[RULE]"),
        ("urdftool-ignore", "does not name a rule; write urdftool-ignore[RULE]"),
        ("urdftool-ingore[mesh]", "there is no comment 'urdftool-ingore'; did you mean 'urdftool"),
        ("urdftool-ignore-fil[mesh]", "did you mean 'urdftool-ignore-file'?"),
    ],
)
def test_a_comment_that_means_nothing_names_what_is_near(write, urdftool, comment, message):
    path = write("r.urdf", f'<robot name="r"><!-- {comment} -->\n<link name="a"/></robot>')
    result = urdftool("lint", path, "--format", "concise")
    assert result.code == 1
    assert "r.urdf:1:17: error: " in result.out
    assert message in result.out


def test_a_comment_about_urdftool_is_none_for_it(write, urdftool):
    text = "urdftool-lint takes this for a wheel; see urdftool-ignore[mesh]"
    path = write("r.urdf", f'<robot name="r"><!-- {text} --><link name="a"/></robot>')
    assert "unknown-rule" not in urdftool("lint", path).out
