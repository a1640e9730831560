"""One fact many times is one finding, and what another explains is listed under it."""

import json
from pathlib import Path

import jsonschema
import pytest

from tests.conftest import ROOT
from tests.report.sarif import SARIF
from urdftool import check
from urdftool.diagnostic import Severity
from urdftool.finding import Cause, Finding, Group
from urdftool.lint.group import NAMES, group
from urdftool.rules import get_all_rules
from urdftool.source.location import Call, Place, SourceFile

SEEN = '<visual><geometry><box size="1 1 1"/></geometry></visual>'
LINK = '<link name="{0}">{1}</link>\n'
ONLY = ("--select", "missing-collision", "--fail-on", "info", "--no-cache")
SCHEMA = json.loads((ROOT / "docs" / "schemas" / "lint.json").read_text())


def robot(*names, before="", inside=""):
    links = "".join(f"{before}{LINK.format(name, SEEN)}" for name in names)
    return f'<robot name="r">\n{links}{inside}</robot>'


def lint_json(urdftool, *words):
    record = json.loads(urdftool("lint", *words, "--format", "json").out)
    jsonschema.validate(record, SCHEMA)
    return record


def test_one_fact_of_many_links_is_one_finding_with_its_names(write, urdftool):
    path = write("r.urdf", robot(*"abcdefgh"))
    result = urdftool("lint", path, *ONLY, "--format", "concise")
    assert result.code == 1
    assert result.out == (
        "r.urdf:2:1: info: 8 links have a visual but no collision: 'a', 'b', 'c', 'd', 'e' and "
        "3 more; add a <collision> to each, best with a primitive shape [missing-collision]\n"
    )
    assert "1 info in 1 file" in result.err
    (found,) = lint_json(urdftool, path, *ONLY)["findings"]
    assert found["group"]["by"] == "robot"
    assert found["group"]["count"] == 8
    assert [(m["element"]["name"], m["line"]) for m in found["group"]["members"]] == [
        (name, line) for line, name in enumerate("abcdefgh", 2)
    ]
    assert [instance["name"] for instance in found["instances"]] == list("bcdefgh")


@pytest.mark.parametrize("style", ["json", "sarif", "github", "junit", "html"])
def test_formats_for_programs_have_no_statistics(write, urdftool, style):
    result = urdftool("lint", write("r.urdf", "<robot/>"), "--statistics", "--format", style)
    assert (result.code, result.out) == (2, "")
    assert f"--statistics and --format {style} exclude each other" in result.err


def test_statistics_count_groups_and_their_places(write, urdftool):
    path = write("r.urdf", robot(*"abcdefgh"))
    result = urdftool("lint", path, *ONLY, "--statistics")
    assert result.out == "     1  info     missing-collision, 8 places (fix: unsafe)\n"


def test_one_alone_is_reported_as_before(write, urdftool):
    path = write("r.urdf", robot("a", inside='<link name="b"/>'))
    (found,) = lint_json(urdftool, path, *ONLY)["findings"]
    assert found["message"].startswith("link 'a' has a visual but no collision")
    assert "group" not in found


def test_the_library_has_each_and_groups_them_where_asked(write):
    path = write("r.urdf", robot(*"abc"))
    assert len(check(path, select=["missing-collision"])) == 3
    (whole,) = check(path, select=["missing-collision"], grouped=True)
    assert [member.name for member in whole.members] == list("abc")
    assert whole.count == 3


@pytest.mark.parametrize("style", ["full", "concise", "sarif", "github", "junit", "html"])
def test_every_format_has_the_group_once_and_its_members(write, urdftool, style):
    path = write("r.urdf", robot(*"abcd"))
    result = urdftool("lint", path, *ONLY, "--format", style)
    assert result.out.count("4 links have a visual but no collision") == (
        2 if style == "junit" else 1
    )
    if style == "sarif":
        log = json.loads(result.out)
        jsonschema.validate(log, SARIF)
        (one,) = log["runs"][0]["results"]
        lines = [
            related["physicalLocation"]["region"]["startLine"]
            for related in one["relatedLocations"]
        ]
        assert lines == [3, 4, 5]
    elif style != "concise":
        assert "r.urdf:5:1" in result.out


def test_severities_are_told_apart(write):
    flat = '<visual><geometry><box size="0 0 0"/></geometry></visual>'
    mass = '<inertial><mass value="1"/></inertial>'
    links = [LINK.format(name, mass + flat) for name in "ab"]
    frames = [LINK.format(name, flat) for name in "st"]
    path = write("r.urdf", f'<robot name="r">{"".join(links + frames)}</robot>')
    found = check(path, select=["non-positive-dimension"], grouped=True)
    assert sorted((f.severity.label, f.count) for f in found) == [("info", 2), ("warning", 2)]


def test_instances_of_a_macro_are_counted(xacro_file):
    wheel = (
        '<xacro:macro name="m" params="n"><link name="${n}">' + SEEN + "</link></xacro:macro>\n"
        '<xacro:m n="x"/><xacro:m n="y"/>\n'
    )
    path = xacro_file("r.urdf.xacro", wheel + LINK.format("a", SEEN))
    (whole,) = check(path, select=["missing-collision"], grouped=True)
    assert whole.count == 3
    assert sorted(whole.names) == ["a", "x", "y"]
    assert "expansions" not in str(whole.message)


def test_a_comment_excuses_one_of_a_group(write, urdftool):
    text = robot(*"abc").replace(
        '<link name="b">', '<!-- urdftool-ignore[missing-collision] a sticker --><link name="b">'
    )
    (found,) = lint_json(urdftool, write("r.urdf", text), *ONLY)["findings"]
    assert [m["element"]["name"] for m in found["group"]["members"]] == ["a", "c"]


def test_a_baseline_knows_each_of_a_group(write, urdftool):
    path = write("r.urdf", robot("a", "b"))
    result = urdftool("lint", path, *ONLY, "--write-baseline", "old.json")
    assert "old.json: written, 2 entries" in result.err
    write("r.urdf", robot("a", "b", "c", "d"))
    (found,) = lint_json(urdftool, path, *ONLY, "--baseline", "old.json")["findings"]
    assert [m["element"]["name"] for m in found["group"]["members"]] == ["c", "d"]
    write("r.urdf", robot("b", "a"))
    result = urdftool("lint", path, *ONLY, "--baseline", "old.json")
    assert (result.code, result.out) == (0, "")
    assert "1 in the baseline" in result.err


def test_the_fingerprint_of_a_group_is_that_of_its_members(write, urdftool):
    def mark(*names):
        path = write("r.urdf", robot(*names))
        log = json.loads(urdftool("lint", path, *ONLY, "--format", "sarif").out)
        (result,) = log["runs"][0]["results"]
        return result["partialFingerprints"]["primaryLocationLineHash"]

    assert mark("a", "b") == mark("b", "a")
    assert mark("a", "b") != mark("a", "b", "c")


TRANSMISSION = """<transmission name="t{0}"><type>transmission_interface/SimpleTransmission</type>
<joint name="j{0}"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>
<actuator name="m{0}"/></transmission>
"""


CONTROL = '<gazebo><plugin name="c" filename="libgazebo_ros_control.so"/></gazebo>\n'


def test_the_fix_of_a_group_is_that_of_all_and_is_applied_to_all(write, urdftool):
    text = CONTROL + "".join(map(TRANSMISSION.format, range(3)))
    path = write("r.urdf", f'<robot name="r"><link name="a"/>\n{text}</robot>')
    only = ("--select", "unprefixed-hardware-interface", "--no-cache")
    (found,) = lint_json(urdftool, path, *only)["findings"]
    assert found["group"]["count"] == 3
    assert len(found["fix"]["edits"]) == 3
    assert "covers" not in found["fix"]["message"]
    result = urdftool("lint", path, *only, "--fix")
    assert result.code == 0
    assert "Fixed 3 in 1 file" in result.err
    assert Path(path).read_text().count("hardware_interface/Effort") == 3


def test_a_fix_that_covers_a_part_says_how_much(write, urdftool):
    text = CONTROL + "".join(map(TRANSMISSION.format, range(2)))
    split = TRANSMISSION.format(2).replace(
        ">EffortJointInterface<", "><!-- x -->EffortJointInterface<"
    )
    path = write("r.urdf", f'<robot name="r"><link name="a"/>\n{text}{split}</robot>')
    (found,) = lint_json(urdftool, path, "--select", "unprefixed-hardware-interface")["findings"]
    assert found["group"]["count"] == 3
    assert len(found["fix"]["edits"]) == 2
    assert "(covers 2 of 3 places)" in found["fix"]["message"]


def test_variants_of_a_file_are_told_apart(xacro_file, write):
    inside = (
        '<xacro:arg name="arm" default="false"/>\n'
        + "".join(LINK.format(name, SEEN) for name in "ab")
        + '<xacro:if value="$(arg arm)">'
        + "".join(LINK.format(name, SEEN) for name in "cd")
        + "</xacro:if>"
    )
    rows = '[[lint.variants]]\nfile = "r.urdf.xacro"\nargs = {{arm = {}}}\n'
    write("urdftool.toml", rows.format("true") + rows.format("false"))
    path = xacro_file("r.urdf.xacro", inside)
    found = check(path, select=["missing-collision"], grouped=True)
    assert [(f.names, f.variants) for f in found] == [
        (["a", "b"], ()),
        (["c", "d"], ("arm=true",)),
    ]


def test_a_part_of_two_robots_is_reported_with_the_first(xacro_file, urdftool, write):
    part = "".join(LINK.format(name, SEEN) for name in "ab")
    xacro_file("part.xacro", part)
    include = '<xacro:include filename="part.xacro"/>'
    xacro_file("one.urdf.xacro", include + LINK.format("c", SEEN))
    xacro_file("two.urdf.xacro", include + LINK.format("d", SEEN) + LINK.format("e", SEEN))
    found = lint_json(urdftool, ".", *ONLY)["findings"]
    names = [[m["element"]["name"] for m in f["group"]["members"]] for f in found]
    assert sorted(map(sorted, names)) == [["a", "b", "c"], ["d", "e"]]


POINTER = "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n"


def meshes(*names):
    shapes = "".join(
        f'<link name="{name}"><visual><geometry><mesh filename="{name}.stl"/></geometry></visual>'
        "</link>\n"
        for name in names
    )
    return f'<robot name="r">\n{shapes}</robot>'


def test_pointers_of_git_lfs_are_one_finding_for_a_repository(write, urdftool):
    for folder in ("one", "two"):
        (Path(write(f"{folder}/.git/HEAD", "")))
        for robot_name, names in (("x", "ab"), ("y", "cd")):
            write(f"{folder}/{robot_name}.urdf", meshes(*names))
            for name in names:
                write(f"{folder}/{name}.stl", POINTER)
    found = lint_json(urdftool, ".", "--select", "git-lfs-pointer")["findings"]
    assert [(f["group"]["by"], f["group"]["count"], f["path"]) for f in found] == [
        ("repository", 4, "one/x.urdf"),
        ("repository", 4, "two/x.urdf"),
    ]
    assert "4 mesh files are git-lfs pointers" in found[0]["message"]


FILE = SourceFile("r.urdf", b"<robot>\n<link/>\n<link/>\n</robot>\n")


def fact(rule, name, start=8, *, cause=(), severity=Severity.WARNING, calls=(), **more):
    return Finding(
        rule,
        severity,
        f"{rule} of '{name}'",
        Place(FILE, start, start + 7, calls),
        "link",
        name,
        site=("r.urdf", start),
        cause=Cause(cause, (("r.urdf", start),)) if cause else None,
        **more,
    )


def test_what_another_finding_explains_is_listed_under_it():
    found = group(
        [
            fact("no-mass", "a"),
            fact("falls", "a", cause=("no-mass",), severity=Severity.ERROR),
            fact("falls", "b", 16, cause=("no-mass",)),
        ]
    )
    assert [(f.code, f.name, f.severity) for f in found] == [
        ("no-mass", "a", Severity.ERROR),
        ("falls", "b", Severity.WARNING),
    ]
    assert [f.message for f in found[0].consequences] == ["falls of 'a'"]


def test_a_cause_that_only_some_instances_have_explains_nothing():
    one, other = (Call(FILE, start, "m", ()) for start in (0, 8))
    falls = fact("falls", "a", cause=("no-mass",), calls=(one,), others=[("b", (other,))])
    assert len(group([fact("no-mass", "a", calls=(one,)), falls])) == 2
    whole = fact("no-mass", "b", calls=(other,), others=[("a", (one,))])
    assert len(group([whole, falls])) == 1


def test_causes_in_a_chain_and_in_a_circle():
    chain = [fact("c", "a", cause=("b",)), fact("b", "a", cause=("a",)), fact("a", "a")]
    (top,) = group(chain)
    assert (top.code, top.consequences[0].code, top.consequences[0].consequences[0].code) == (
        "a",
        "b",
        "c",
    )
    circle = group([fact("a", "a", cause=("b",)), fact("b", "a", cause=("a",))])
    assert len(circle) == 1
    assert len(circle[0].consequences) == 1


def test_consequences_of_a_group_are_grouped():
    facts = []
    for number in range(NAMES + 2):
        name, start = f"l{number}", 8 + number
        facts.append(fact("no-mass", name, start, group=Group("robot", "{count}: {names}")))
        facts.append(fact("falls", name, start, cause=("no-mass",), group=Group("robot", "")))
    (whole,) = group(facts)
    assert whole.message == "7: 'l0', 'l1', 'l2', 'l3', 'l4' and 2 more"
    (under,) = whole.consequences
    assert under.message == ("falls of 'l0' (and 6 more: 'l1', 'l2', 'l3', 'l4', 'l5' and 1 more)")


def test_findings_are_grouped_by_what_rules_call_alike():
    keys = (("m", "above"), ("m", "above"), ("rad", "above"), None, None)
    facts = [
        fact("a", name, 8 + n, group=Group("robot", "", key))
        for n, (name, key) in enumerate(zip("abcde", keys, strict=True))
    ]
    assert [found.names for found in group(facts)] == [["a", "b"], ["c"], ["d", "e"]]


def test_no_message_decides_what_is_grouped():
    facts = [fact("a", name, 8 + n, group=Group("robot", "")) for n, name in enumerate("ab")]
    facts[1].message = "another sentence"
    assert [found.names for found in group(facts)] == [["a", "b"]]


def test_declared_groups_and_causes_are_of_rules():
    rules = {rule.name: rule for rule in get_all_rules()}
    grouped = {name for name, rule in rules.items() if rule.group}
    assert {
        "missing-collision",
        "missing-inertial",
        "placeholder-inertia",
        "unprefixed-hardware-interface",
        "nonconvex-collision-mesh",
        "git-lfs-pointer",
    } <= grouped
    assert rules["git-lfs-pointer"].group == "repository"
    for rule in rules.values():
        assert set(rule.caused_by) <= set(rules) - {rule.name}


@pytest.mark.parametrize(("count", "expected"), [(2, 2), (3, 1)])
def test_one_defect_in_copies_of_a_file_is_one_finding(tmp_path, urdftool, count, expected):
    (tmp_path / ".git").mkdir()
    shape = '<geometry><box size="1 1 1"/></geometry><material name="grey"/>'
    text = f'<robot name="a"><link name="a"><visual>{shape}</visual></link></robot>'
    for number in range(count):
        (tmp_path / f"{number}.urdf").write_text(text)
    report = json.loads(urdftool("lint", tmp_path, "--format", "json").out)
    found = [one for one in report["findings"] if one["rule"] == "undefined-material"]
    assert len(found) == expected
    places = [
        member["path"]
        for one in found
        for member in one.get("group", {"members": [one]})["members"]
    ]
    assert len(places) == count
