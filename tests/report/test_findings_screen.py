"""The default output begins with what matters, and a family of rules gets a screen."""

import json
import re

import pytest

from urdftool.diagnostic import FileRewrite, Fix, Severity
from urdftool.finding import Finding
from urdftool.report.findings_screen import (
    MANY,
    SCREEN,
    format_advice,
    format_screen,
    sort_by_severity,
)
from urdftool.source.location import Place, SourceFile

FILES = [SourceFile(path, b"<robot>\n" + b"<link/>\n" * 400) for path in ("a.urdf", "b.urdf")]
ERROR, WARNING, INFO = Severity.ERROR, Severity.WARNING, Severity.INFO


def fact(rule, severity, line, file=0, fix=None):
    start = 8 + 8 * line
    place = Place(FILES[file], start, start + 7)
    fixes = (fix,) if fix else ()
    return Finding(rule, severity, f"{rule} {line}", place, "link", f"l{line}", fixes=fixes)


def shown(findings, style="concise", **more):
    return list(format_screen(findings, style, **more))


def headlines(lines):
    return [re.sub(r".*: (\w+): .* \[(.*)\]", r"\1 \2", line) for line in lines if "[" in line]


def test_errors_come_first_in_a_file_and_rules_are_together():
    facts = [
        fact("zero-mass", WARNING, 1),
        fact("missing-collision", INFO, 2),
        fact("unused-arg", WARNING, 3),
        fact("zero-mass", WARNING, 4),
        fact("zero-axis", ERROR, 5),
        fact("zero-axis", ERROR, 0, file=1),
    ]
    assert headlines(shown(facts)) == [
        "error zero-axis",
        "warning zero-mass",
        "warning zero-mass",
        "warning unused-arg",
        "info missing-collision",
        "error zero-axis",
    ]
    assert [f.location.path for f in sort_by_severity(facts)] == ["a.urdf"] * 5 + ["b.urdf"]


@pytest.mark.parametrize("style", ["full", "concise"])
@pytest.mark.parametrize("count", [1, 5, SCREEN, SCREEN + 1, 300])
def test_a_family_gets_a_screen_and_what_is_left_out_is_counted(style, count):
    facts = [fact("zero-mass", INFO, line) for line in range(count)]
    facts[-1] = fact("zero-inertia", ERROR, count - 1)
    lines = shown(facts, style)
    said = [line for line in lines if line.startswith(("a.urdf", " "))]
    assert len(said) <= SCREEN
    assert headlines(lines)[0] == "error zero-inertia"
    left = [line for line in lines if "more of inertia" in line]
    assert bool(left) == (count > SCREEN)
    if left:
        number = count - SCREEN + 1
        assert left == [f"{number} more of inertia: {number} info; --all shows them"]
        assert len(headlines(lines)) + number == count


def test_families_do_not_take_each_others_room():
    facts = [fact("zero-mass", INFO, line) for line in range(100)]
    facts += [fact("zero-axis", WARNING, line) for line in range(SCREEN)]
    kinds = headlines(shown(facts))
    assert kinds.count("warning zero-axis") == SCREEN
    assert kinds.count("info zero-mass") == SCREEN - 1


def test_errors_of_a_later_file_are_shown_before_infos_of_the_first():
    facts = [fact("zero-mass", INFO, line) for line in range(100)]
    facts += [fact("zero-mass", ERROR, line, file=1) for line in range(10)]
    assert headlines(shown(facts)).count("error zero-mass") == 10


def test_all_shows_every_finding_with_its_details():
    facts = [fact("zero-mass", INFO, line) for line in range(60)]
    assert len(shown(facts, "full", whole=True)) == 60 * 4
    assert len(shown(facts, whole=True)) == 60


def test_what_is_shortened_is_counted():
    facts = [fact("zero-mass", INFO, line) for line in range(20)]
    lines = shown(facts, "full")
    assert sum("^" in line for line in lines) == 1
    assert "19 findings are shown in one line; --all shows all details" in lines


ROBOT = '<robot name="r">\n{}</robot>'
LINK = '<link name="l{0}"><inertial><mass value="-1"/></inertial></link>\n'


@pytest.fixture
def many(write):
    return write("r.urdf", ROBOT.format("".join(map(LINK.format, range(40)))))


ONLY = ("--select", "negative-mass", "--no-cache")


def test_machines_get_all(many, urdftool):
    for style in ("concise", "json", "github", "sarif", "junit", "html"):
        out = urdftool("lint", many, *ONLY, "--format", style).out
        assert "l39" in out
        assert "--all" not in out
    assert len(json.loads(urdftool("lint", many, *ONLY, "--format", "json").out)["findings"]) == 40
    urdftool("lint", many, *ONLY, "--output-file", "report.txt")
    with open("report.txt") as stream:
        assert stream.read().count("[negative-mass]") == 40


def test_people_get_a_screen_or_all_where_asked(many, urdftool, monkeypatch):
    out = urdftool("lint", many, *ONLY).out
    assert out.count("[negative-mass]") == SCREEN - 1
    assert f"{40 - SCREEN + 1} more of inertia: 16 errors; --all shows them\n" in out
    assert urdftool("lint", many, *ONLY, "--all").out.count("    |") >= 40
    monkeypatch.setattr("sys.stdout.isatty", lambda: True, raising=False)
    out = urdftool("lint", many, *ONLY).out
    assert "^" not in out
    assert out.count("[negative-mass]") == SCREEN - 1


def test_the_summary_names_three_rules_and_what_to_do():
    fix = Fix(True, "do it", ())
    facts = [fact("zero-axis", ERROR, line, fix=fix) for line in range(4)]
    facts += [fact("zero-mass", WARNING, line, fix=fix._replace(safe=False)) for line in range(3)]
    facts += [fact("name-style", INFO, line) for line in range(2)]
    facts += [fact("unused-arg", INFO, 1)]
    assert len(facts) > MANY
    assert list(format_advice(facts)) == [
        "rules with the most findings:",
        "     4  zero-axis   --fix, or --ignore zero-axis",
        "     3  zero-mass   --fix --unsafe-fixes, or --ignore zero-mass",
        "     2  name-style  --ignore name-style",
        "--fix --diff shows 4 safe fixes",
        "--fix --unsafe-fixes --diff shows 3 unsafe fixes or more as well",
    ]
    assert list(format_advice([*facts[:7], *facts[:2]]))[-1].endswith("3 unsafe fixes as well")
    single = [*facts, facts[0], fact("zero-mass", WARNING, 9)]
    assert list(format_advice(facts, single))[-2:] == [
        "--fix --diff shows 5 safe fixes",
        "--fix --unsafe-fixes --diff shows 3 unsafe fixes or more as well",
    ]
    assert list(format_advice(facts[:MANY])) == []
    rewrite = fix._replace(rewrites=(FileRewrite("a.stl", "a.stl", "binary STL"),))
    meshes = [fact("ascii-stl", INFO, line, fix=rewrite) for line in range(MANY + 1)]
    assert list(format_advice(meshes)) == [
        "rules with the most findings:",
        "     9  ascii-stl  --fix --fix-meshes, or --ignore ascii-stl",
        "--fix-meshes adds 9 fixes of mesh files",
    ]
    rules = "abcdefghi"
    assert list(format_advice([fact(rule, INFO, n) for n, rule in enumerate(rules)])) == []


def test_the_summary_has_it_on_stderr_and_only_for_people(many, urdftool):
    for style, there in (("full", True), ("concise", True), ("json", False)):
        result = urdftool("lint", many, *ONLY, "--format", style)
        assert ("rules with the most findings:" in result.err) == there
        assert "most findings" not in result.out
    assert "most findings" not in urdftool("lint", many, *ONLY, "--statistics").err


def make_long(count):
    names = ", ".join(f"'wheel_link_{number}'" for number in range(count))
    finding = fact("zero-mass", WARNING, 1)
    finding.message = f"mass of {count} links is 0: {names}; write the mass [kg]"
    return finding


def test_a_long_list_of_names_is_cut_and_the_advice_stays():
    [line, note] = shown([make_long(40)], cut=True)
    assert "'wheel_link_3', … 35 more …, 'wheel_link_39'; write the mass [kg] [zero-mass]" in line
    assert note == "1 message is cut at …; --all shows all names"
    assert shown([make_long(40)])[0].count("wheel_link_") == 40
    assert shown([make_long(8)], cut=True) == shown([make_long(8)])


def test_a_long_text_without_names_is_not_cut():
    finding = fact("zero-mass", WARNING, 1)
    finding.message = "words, " * 100
    assert shown([finding], cut=True)[0].count("words") == 100


def test_full_wraps_long_lines():
    lines = shown([make_long(100)], "full", whole=True)
    assert max(map(len, lines)) <= 200
    assert re.sub(r"\s+", " ", " ".join(lines)).count("'wheel_link_") == 100
