"""Fixes of many descriptions: proved together, in halves where some fail, and written by groups."""

import os
from pathlib import Path

import pytest

from tests.conftest import XACRO
from urdftool.lint import fix_run
from urdftool.lint.fix_proof import Wrong
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings
from urdftool.rules import get_rule

ONLY = ("--select", "empty-dynamics", "--fix", "--no-cache", "--exit-zero")
OPTIONS = Options(Settings(select=("empty-dynamics",)), fixes=True)


def chain(count, inside="<dynamics/>"):
    """A robot with so many joints, each with something to fix."""
    links = "".join(f'  <link name="l{n}"/>\n' for n in range(count + 1))
    joints = "".join(
        f'  <joint name="j{n}" type="continuous"><parent link="l{n}"/><child link="l{n + 1}"/>'
        f'<axis xyz="0 0 1"/>{inside}</joint>\n'
        for n in range(count)
    )
    return f'<robot name="r">\n{links}{joints}</robot>\n'


@pytest.fixture
def lints(monkeypatch):
    """The descriptions that are linted to prove fixes."""
    paths = []

    def counted(path, options):
        paths.append(str(path))
        return check_file(path, options)

    monkeypatch.setattr(fix_run, "check_file", counted)
    return paths


def fixed(paths):
    return fix_run.apply_fixes([check_file(path, OPTIONS) for path in paths], OPTIONS)


def test_many_fixes_of_one_file_are_proved_at_once(write, lints):
    path = write("r.urdf", chain(40))
    done = fixed([path])
    assert done.applied == {"empty-dynamics": 40}
    assert done.after[path] == chain(40, "").encode()
    assert lints == [path]


def test_a_fix_that_other_fixes_allow_is_tried_again(write, monkeypatch):
    """The fix of the first joint makes the report worse until all others are made."""

    def find_regression(old, new, tried, others):
        early = len(old.findings) > 1 and any("'j0'" in one.message for one in tried)
        return Wrong("another joint differs") if early else None

    monkeypatch.setattr(fix_run, "find_regression", find_regression)
    path = write("r.urdf", chain(3))
    done = fixed([path])
    assert done.applied == {"empty-dynamics": 3}
    assert (done.broken, done.reverted) == ({}, [])
    Path(path).write_bytes(done.after[path])
    assert fixed([path]).made == []


def test_descriptions_that_share_nothing_are_linted_once_each(write, lints):
    paths = [write(f"r{n}.urdf", chain(2)) for n in range(10)]
    done = fixed(paths)
    assert done.applied == {"empty-dynamics": 20}
    assert lints == paths
    assert sorted(map(sorted, done.groups)) == [[path] for path in paths]


PART = """<xacro:macro name="part" params="name">
  <link name="${name}"/>
  <joint name="${name}_joint" type="continuous">
    <parent link="base"/><child link="${name}"/><axis xyz="0 0 1"/><dynamics/>
  </joint>
</xacro:macro>
"""
USES = '<xacro:include filename="part.xacro"/>\n<link name="base"/>\n<xacro:part name="a"/>\n'


def test_descriptions_that_share_a_file_are_linted_once_each(write, lints):
    write("part.xacro", XACRO.format(PART))
    paths = [write(f"r{n}.urdf.xacro", XACRO.format(USES)) for n in range(10)]
    done = fixed(paths)
    assert done.applied == {"empty-dynamics": 1}
    assert sorted(lints) == sorted(paths)
    assert done.groups == [{"part.xacro"}]
    assert not any(report.findings for report in done.reports)


def test_what_keeps_several_from_being_read_is_fixed_once(write, urdftool):
    write("part.xacro", XACRO.format(PART.replace("<dynamics/>", "<!-- a -- b --><dynamics/>")))
    paths = [write(f"r{n}.urdf.xacro", XACRO.format(USES)) for n in range(3)]
    words = ("--select", "not-well-formed,empty-dynamics", "--fix", "--no-cache", "--exit-zero")
    result = urdftool("lint", *paths, *words)
    fixed_part = PART.replace("<dynamics/>", "<!-- a - - b -->")
    assert Path("part.xacro").read_text() == XACRO.format(fixed_part)
    assert result.err.startswith("Fixed 2 in 1 file: ")


def test_a_fix_that_reveals_findings_in_two_robots_of_one_macro_is_made(write):
    """The type of the joint shows what its link lacks: no reason to refuse it, in neither robot."""
    body = """<link name="${name}"><inertial><mass value="-1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
      <visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual></link>"""
    part = PART.replace('<link name="${name}"/>', body).replace("continuous", "revolut")
    write("part.xacro", XACRO.format(part))
    more = '<xacro:part name="b"/>\n<xacro:part name="c"/>\n'
    paths = [write(f"r{n}.urdf.xacro", XACRO.format(USES + more)) for n in range(2)]
    options = Options(Settings(targets=frozenset(("moveit",))), fixes=True)
    reports = [check_file(path, options) for path in paths]
    done = fix_run.apply_fixes(reports, options, unsafe=True)
    assert {"unknown-joint-type", "missing-collision"} <= set(done.applied)
    assert b'type="continuous"' in done.after["part.xacro"]


def _broken_for(monkeypatch, wrong):
    """A fix of empty dynamics that writes nonsense for some joints."""
    from urdftool.rules.fix import remove_element, replace_element, safe

    def fixer(problem, context):
        dynamics = context.get_joint(problem).dynamics
        if wrong(problem.name):
            return safe(
                "break it",
                replace_element(dynamics.element, ("<dynamics damping='x' friction='y'/>",)),
            )
        return safe("remove it", remove_element(dynamics.element))

    monkeypatch.setattr(get_rule("empty-dynamics"), "make_fix", fixer)


def test_one_bad_fix_among_many_is_found_by_halves(write, lints, monkeypatch):
    _broken_for(monkeypatch, lambda name: name == "j17")
    path = write("r.urdf", chain(64))
    options = Options(Settings(select=("empty-dynamics", "not-a-number")), fixes=True)
    done = fix_run.apply_fixes([check_file(path, options)], options)
    assert done.applied == {"empty-dynamics": 63}
    assert "damping" in done.broken["empty-dynamics"]
    after = done.after[path].decode()
    assert after.count("<dynamics/>") == 1
    assert 'name="j17"' in next(line for line in after.splitlines() if "<dynamics/>" in line)
    assert len(lints) <= 1 + 2 * 6 + 1  # it is tried again after the others


def test_a_bad_fix_of_one_description_costs_the_others_nothing(write, lints, monkeypatch):
    _broken_for(monkeypatch, lambda name: name == "j3")
    options = Options(Settings(select=("empty-dynamics", "not-a-number")), fixes=True)
    paths = [write(f"r{n}.urdf", chain(2)) for n in range(9)]
    paths.append(write("s.urdf", chain(4)))
    done = fix_run.apply_fixes([check_file(path, options) for path in paths], options)
    assert done.applied == {"empty-dynamics": 9 * 2 + 3}
    assert [lints.count(path) for path in paths[:-1]] == [1] * 9


def test_what_would_make_another_description_worse_is_not_made(write, urdftool, monkeypatch):
    """The fix of a file that two include is right in the one and an error in the other."""
    from urdftool.rules.fix import replace_element, safe

    def fixer(problem, context):
        element = context.get_joint(problem).dynamics.element
        return safe("write it", replace_element(element, ("<dynamics damping='${damping}'/>",)))

    monkeypatch.setattr(get_rule("empty-dynamics"), "make_fix", fixer)
    write("part.xacro", XACRO.format(PART))
    knows = '<xacro:property name="damping" value="1"/>\n'
    one = write("a.urdf.xacro", XACRO.format(knows + USES))
    other = write("b.urdf.xacro", XACRO.format(USES))
    result = urdftool("lint", one, other, *ONLY)
    assert Path("part.xacro").read_text() == XACRO.format(PART)
    assert (
        "the fix of empty-dynamics was not applied, because it would introduce a defect"
        in result.err
    )
    assert "Nothing to fix." in result.err
    assert urdftool("lint", one, *ONLY).err.startswith("Fixed 1 in 1 file")
    assert "damping='${damping}'" in Path("part.xacro").read_text()


def test_a_file_that_cannot_be_written_keeps_only_its_own_group(write, urdftool, monkeypatch):
    write("part.xacro", XACRO.format(PART))
    own = USES + '<joint name="j" type="fixed"><parent link="a"/><child link="z"/></joint>\n'
    own += '<link name="z"/>\n<joint name="k" type="continuous"><parent link="a"/>'
    own += '<child link="y"/><axis xyz="0 0 1"/><dynamics/></joint>\n<link name="y"/>\n'
    two = [write(f"{name}.urdf.xacro", XACRO.format(own)) for name in "ab"]
    alone = write("c.urdf", chain(2))
    before = {path: Path(path).read_text() for path in (*two, "part.xacro")}
    real = os.access
    with monkeypatch.context() as patch:
        patch.setattr(
            os, "access", lambda p, mode: (mode != os.W_OK or p != two[1]) and real(p, mode)
        )
        result = urdftool("lint", *two, alone, *ONLY)
    assert result.code == 2
    assert "b.urdf.xacro: not fixed, because the file is read-only" in result.err
    assert {path: Path(path).read_text() for path in before} == before
    assert Path(alone).read_text() == chain(2, "")
    assert "Fixed 2 in 1 file: empty-dynamics × 2" in result.err
    assert result.out.count("[empty-dynamics]") == 3, "what is not fixed is still reported"
    assert "Fixed 3 in 3 files" in urdftool("lint", *two, alone, *ONLY).err
