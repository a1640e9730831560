"""``lint --fix`` on files that are shared, linked, read-only, changed meanwhile, or macros."""

import json
import os
import shutil
from pathlib import Path

import pytest

from tests.conftest import FIXTURES, XACRO
from urdftool import output
from urdftool.lint import fix_run
from urdftool.model.load import load
from urdftool.rules import get_rule

ROBOT = """<?xml version="1.0"?>
<robot name="r">
  <link name="base"/>
  <link name="arm"/>
  <joint name="swing" type="continuous">
    <parent link="base"/>
    <child link="arm"/>
    <axis xyz="{axis}"/>{dynamics}
  </joint>
</robot>
"""
LONG = ROBOT.format(axis="0 0 2", dynamics="")
UNIT = ROBOT.format(axis="0 0 1", dynamics="")
SHOWN = ("--select", "axis-not-unit", "--no-cache")
ONLY = (*SHOWN, "--unsafe-fixes")

WHEEL = """<xacro:macro name="wheel" params="name axis">
  <link name="${name}"/>
  <joint name="${name}_joint" type="continuous">
    <parent link="base"/>
    <child link="${name}"/>
    <axis xyz="AXIS"/>
  </joint>
</xacro:macro>
<link name="base"/>
<xacro:wheel name="left" axis="0 0 2"/>
<xacro:wheel name="right" axis="0 0 SECOND"/>
"""


def wheels(axis, second="2"):
    return XACRO.format(WHEEL.replace("AXIS", axis).replace("SECOND", second))


def test_what_is_fixed_is_said_and_the_rest_reported(write, urdftool):
    path = write("r.urdf", LONG)
    result = urdftool(
        "lint", path, "--fix", "--unsafe-fixes", "--select", "axis-not-unit,missing-dynamics"
    )
    assert Path(path).read_text() == UNIT
    assert result.err.startswith("Fixed 1 in 1 file: axis-not-unit × 1\n")
    assert "[missing-dynamics]" in result.out
    assert "axis-not-unit" not in result.out
    assert result.code == 0, "what is left is info"


def test_diff_writes_nothing_and_exits_1_if_it_would(write, urdftool):
    path = write("r.urdf", LONG)
    result = urdftool("lint", path, "--diff", *ONLY)
    assert result.code == 1
    assert Path(path).read_text() == LONG
    assert result.out.startswith("--- r.urdf\n+++ r.urdf\n@@ ")
    assert '-    <axis xyz="0 0 2"/>\n+    <axis xyz="0 0 1"/>\n' in result.out
    write("r.urdf", UNIT)
    assert urdftool("lint", path, "--diff", *ONLY).code == 0


def test_diff_of_a_file_that_cannot_be_read_is_not_nothing(write, urdftool):
    missing = urdftool("lint", "missing.urdf", "--diff")
    assert (missing.code, missing.out) == (2, "")
    assert "missing.urdf: no such file" in missing.err
    path = write("r.urdf", LONG)
    both = urdftool("lint", path, write("half.urdf", "<robot name='half'>"), "--diff", *ONLY)
    assert both.code == 2
    assert "half.urdf: not checked: " in both.err
    assert '+    <axis xyz="0 0 1"/>' in both.out


def test_unsafe_fixes_are_applied_only_when_asked_for(write, urdftool):
    text = ROBOT.replace("continuous", "revolute").format(axis="0 0 1", dynamics="")
    path = write("r.urdf", text)
    words = ("--select", "missing-limit", "--no-cache")
    result = urdftool("lint", path, "--fix", *words)
    assert (result.code, Path(path).read_text()) == (1, text)
    assert "1 more finding has an unsafe fix (--unsafe-fixes)" in result.err
    assert urdftool("lint", path, "--fix", "--unsafe-fixes", *words).code == 0
    assert 'type="continuous"' in Path(path).read_text()
    assert urdftool("lint", path, "--unsafe-fixes").code == 2


def test_standard_input_is_fixed_to_standard_output(monkeypatch, urdftool):
    import io
    import sys

    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(LONG.encode())))
    result = urdftool(
        "lint", "-", "--fix", "--unsafe-fixes", "--select", "axis-not-unit,missing-dynamics"
    )
    assert result.out == UNIT
    assert "[missing-dynamics]" in result.err


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace(b"\n", b"\r\n"),
        lambda text: b"\xef\xbb\xbf" + text,
        lambda text: text.rstrip(b"\n"),
        lambda text: text.replace(b'"1.0"', b'"1.0" encoding="ISO-8859-1"').replace(
            b"<link", "<!-- é -->\n  <link".encode("latin-1"), 1
        ),
    ],
    ids=["crlf", "bom", "no newline at the end", "latin-1"],
)
def test_bytes_that_are_not_spoken_of_stay(write, urdftool, change):
    path = write("r.urdf", change(LONG.encode()))
    assert urdftool("lint", path, "--fix", *ONLY).code == 0
    assert Path(path).read_bytes() == change(UNIT.encode())


def test_utf_16_is_not_edited(write, urdftool):
    data = LONG.replace('version="1.0"', 'version="1.0" encoding="UTF-16"').encode("utf-16")
    path = write("r.urdf", data)
    result = urdftool("-v", "lint", path, "--fix", *ONLY)
    assert Path(path).read_bytes() == data
    assert "UTF-16" in result.err


def test_a_link_stays_a_link_and_the_mode_stays(write, urdftool):
    target = write("real.urdf", LONG)
    os.chmod(target, 0o640)
    os.symlink("real.urdf", "link.urdf")
    assert urdftool("lint", "link.urdf", "--fix", *ONLY).code == 0
    assert os.path.islink("link.urdf")
    assert Path(target).read_text() == UNIT
    assert os.stat(target).st_mode & 0o777 == 0o640


def test_a_read_only_file_is_left(write, urdftool, monkeypatch):
    path = write("r.urdf", LONG)
    os.chmod(path, 0o444)
    real = os.access
    monkeypatch.setattr(os, "access", lambda p, mode: mode != os.W_OK and real(p, mode))
    result = urdftool("lint", path, "--fix", *ONLY)
    assert result.code == 2
    assert "r.urdf: not fixed, because the file is read-only" in result.err
    assert "[axis-not-unit]" in result.out, "what is not fixed is still reported"
    assert Path(path).read_text() == LONG


def test_a_file_that_was_changed_meanwhile_is_left(write, urdftool, monkeypatch):
    path = write("r.urdf", LONG)
    original = fix_run.apply_fixes

    def and_change(*args, **kwargs):
        done = original(*args, **kwargs)
        write("r.urdf", LONG + "\n<!-- typed in the editor -->\n")
        return done

    monkeypatch.setattr(fix_run, "apply_fixes", and_change)
    result = urdftool("lint", path, "--fix", *ONLY)
    assert result.code == 2
    assert "another program changed the file" in result.err
    assert "typed in the editor" in Path(path).read_text()


def test_interrupted_between_two_files_neither_is_changed(write, monkeypatch):
    names = [write("a.xacro", "one"), write("b.xacro", "two")]
    calls = []
    move = os.replace

    def second_is_interrupted(source, target):
        calls.append(target)
        if len(calls) == 2:
            raise KeyboardInterrupt
        move(source, target)

    monkeypatch.setattr(os, "replace", second_is_interrupted)
    with pytest.raises(KeyboardInterrupt):
        output.rewrite(
            dict.fromkeys(names, b"one") | {names[1]: b"two"}, dict.fromkeys(names, b"x")
        )
    assert [Path(name).read_text() for name in names] == ["one", "two"]
    assert sorted(os.listdir(".")) == ["a.xacro", "b.xacro"]


def test_a_macro_is_edited_where_all_its_expansions_agree(write, urdftool):
    path = write("r.urdf.xacro", wheels("0 0 2"))
    assert urdftool("lint", path, "--fix", *ONLY).code == 0
    assert Path(path).read_text() == wheels("0 0 1")


BLOCK = """<xacro:macro name="part" params="name *shape">
  <link name="${name}">
    <visual>
      <xacro:insert_block name="shape"/>
    </visual>
  </link>
</xacro:macro>
<xacro:part name="one">
  <geometry>
    <sphere radius="0.1"/>
  </geometry>
</xacro:part>
"""


def test_what_follows_from_the_arguments_of_one_call_is_not_written_into_the_macro(write, urdftool):
    path = write("r.urdf.xacro", XACRO.format(BLOCK))
    words = ("--select", "missing-inertial,missing-collision", "--fix", "--unsafe-fixes")
    assert urdftool("lint", path, *words, "--no-cache").code == 1
    assert Path(path).read_text() == XACRO.format(BLOCK)


def test_what_an_expression_computes_is_not_overwritten(write, urdftool):
    path = write("r.urdf.xacro", wheels("${axis}"))
    result = urdftool("-v", "lint", path, "--fix", *ONLY)
    assert result.code == 1
    assert Path(path).read_text() == wheels("${axis}")
    assert "not fixed [axis-not-unit]" in result.err


KINDS = """<xacro:macro name="part" params="name kind">
  <link name="${name}"/>
  <joint name="${name}_joint" type="${kind}">
    <parent link="base"/>
    <child link="${name}"/>
    <axis xyz="0 0 2"/>
  </joint>
</xacro:macro>
<link name="base"/>
<xacro:part name="left" kind="continuous"/>
<xacro:part name="right" kind="RIGHT"/>
"""


@pytest.mark.parametrize(("right", "agree"), [("continuous", True), ("fixed", False)])
def test_a_macro_is_not_edited_where_its_expansions_differ(write, urdftool, right, agree):
    text = XACRO.format(KINDS.replace("RIGHT", right))
    path = write("r.urdf.xacro", text)
    result = urdftool("-v", "lint", path, "--fix", *ONLY)
    assert (Path(path).read_text() != text) is agree
    assert ("where it must not change in this way" in result.err) is not agree


def test_an_expansion_that_a_comment_excuses_keeps_the_macro_as_it_is(write, urdftool):
    excuse = '<!-- urdftool-ignore[axis-not-unit] it is so -->\n<xacro:wheel name="right"'
    text = wheels("0 0 2").replace('<xacro:wheel name="right"', excuse)
    path = write("r.urdf.xacro", text)
    urdftool("lint", path, "--fix", *ONLY)
    assert Path(path).read_text() == text


def test_a_file_that_two_descriptions_include_is_edited_once(write, urdftool):
    write(
        "wheel.xacro", XACRO.format(WHEEL.replace("AXIS", "0 0 2").split('<link name="base"/>')[0])
    )
    body = '<xacro:include filename="wheel.xacro"/>\n<link name="base"/>\n'
    body += '<xacro:wheel name="left" axis=""/>'
    paths = [write(f"{name}.urdf.xacro", XACRO.format(body)) for name in "ab"]
    before = [Path(path).read_text() for path in paths]
    result = urdftool("lint", *paths, "--fix", *ONLY)
    assert result.code == 0
    assert "Fixed 1 in 1 file" in result.err
    assert Path("wheel.xacro").read_text().count('xyz="0 0 1"') == 1
    assert [Path(path).read_text() for path in paths] == before
    write("wheel.xacro", Path("wheel.xacro").read_text().replace("0 0 1", "0 0 2"))
    assert urdftool("lint", *paths, "--diff", *ONLY).out.count("+++ ") == 1


def test_a_file_of_another_package_is_not_edited(write, urdftool):
    text = XACRO.format(WHEEL.replace("AXIS", "0 0 2").split('<link name="base"/>')[0])
    there = write("other/urdf/wheel.xacro", text)
    write("other/package.xml", "<package><name>other</name></package>")
    write("own/package.xml", "<package><name>own</name></package>")
    body = '<xacro:include filename="$(find other)/urdf/wheel.xacro"/>\n<link name="base"/>\n'
    body += '<xacro:wheel name="left" axis=""/>'
    path = write("own/urdf/r.urdf.xacro", XACRO.format(body))
    result = urdftool("lint", path, "--fix", *ONLY, "-p", "other=other")
    assert result.code == 1
    assert Path(there).read_text() == text
    assert "1 fix was not applied to other/urdf/wheel.xacro, outside of own" in result.err


def test_a_fix_that_makes_things_worse_is_taken_back_and_said(write, urdftool, monkeypatch):
    from urdftool.rules.fix import safe, set_attribute

    def wrong(problem, context):
        return safe("break it", set_attribute(problem.subject.axis.element, "xyz", "0 0"))

    monkeypatch.setattr(get_rule("axis-not-unit"), "make_fix", wrong)
    path = write("r.urdf", LONG)
    also = ("--extend-select", "axis-not-unit", "--no-cache")
    result = urdftool("lint", path, "--fix", *also)
    assert Path(path).read_text() == LONG
    assert (
        "the fix of axis-not-unit was not applied, because it would introduce a defect"
        in result.err
    )


def test_a_fix_that_breaks_is_a_bug_of_ours(write, urdftool, monkeypatch):
    def broken(problem, context):
        raise ZeroDivisionError("no axis")

    monkeypatch.setattr(get_rule("axis-not-unit"), "make_fix", broken)
    path = write("r.urdf", ROBOT.format(axis="0 0 2", dynamics="\n    <dynamics/>"))
    only = ("--select", "axis-not-unit,empty-dynamics", "--no-cache")
    result = urdftool("lint", path, "--fix", *only)
    assert result.code == 3
    assert "axis-not-unit" in result.err
    assert "Traceback" not in result.err
    assert "<dynamics/>" not in Path(path).read_text(), "the other fixes are made"


def test_what_cannot_be_read_is_mended_until_it_can(write, urdftool):
    text = "<!-- a -- b -->\n" + LONG.replace("<link", "<!-- c -- d -->\n  <link", 1)
    path = write("r.urdf", text)
    words = ("--fix", "--unsafe-fixes", "--no-cache", "--extend-select", "axis-not-unit")
    assert urdftool("lint", path, *words).code == 0
    fixed = Path(path).read_text()
    assert fixed.startswith('<?xml version="1.0"?>\n<!-- a - - b -->\n<robot')
    assert '<axis xyz="0 0 1"/>' in fixed


def test_json_says_what_would_be_written_where(write, urdftool):
    path = write("r.urdf", LONG)
    found = json.loads(urdftool("lint", path, "--format", "json", *SHOWN).out)
    (finding,) = found["findings"]
    assert finding["fix"] == {
        "applicability": "unsafe",
        "message": 'write xyz="0 0 1"',
        "edits": [
            {
                "path": "r.urdf",
                "start": {"line": 8, "column": 16},
                "end": {"line": 8, "column": 21},
                "replacement": "0 0 1",
            }
        ],
    }


def test_the_report_for_people_says_how_to_apply_it(write, urdftool):
    path = write("r.urdf", LONG)
    out = urdftool("lint", path, *SHOWN).out
    assert '= fix: write xyz="0 0 1" (--fix --unsafe-fixes)\n' in out
    assert "axis-not-unit (fix: unsafe)" in urdftool("lint", path, *SHOWN, "--statistics").out
    assert (
        "Fix: unsafe (--fix --unsafe-fixes)" in urdftool("lint", "--explain", "axis-not-unit").out
    )
    path = write("r.urdf", ROBOT.format(axis="0 0 1", dynamics="<dynamics/>"))
    words = ("--select", "empty-dynamics", "--no-cache")
    assert "= fix: remove the empty <dynamics> (--fix)\n" in urdftool("lint", path, *words).out
    assert "Fix: safe (--fix)" in urdftool("lint", "--explain", "empty-dynamics").out
    assert "[fix: safe or unsafe]" in urdftool("lint", "--list-rules").out


@pytest.mark.library("scipy")
def test_nothing_is_weighed_by_meshes_of_doubtful_size(tmp_path, urdftool):
    """Meshes in millimetres are scaled first; only then do they say what a link weighs."""
    package = tmp_path / "cad_arm"
    shutil.copytree(FIXTURES / "cad_arm", package)
    path = package / "urdf" / "cad_arm.urdf"
    more = ("--extend-select", "missing-inertial")  # a robot without any is an info, off by default
    urdftool("lint", "--fix", "--unsafe-fixes", *more, path)
    robot = load(path)
    assert all(link.inertial.mass < 10 for link in robot.links if link.visuals)


@pytest.mark.parametrize(
    ("comment", "goes"),
    [
        ("", True),
        (" <!-- urdftool-ignore[zero-axis] as measured -->", True),
        (" <!-- TODO: as measured -->", False),
    ],
)
def test_no_safe_fix_takes_a_comment_away(write, urdftool, comment, goes):
    dynamics = f"<dynamics>{comment}</dynamics>"
    path = write("r.urdf", ROBOT.format(axis="0 0 1", dynamics=dynamics))
    only = ("--select", "empty-dynamics", "--no-cache", "--exit-zero")
    urdftool("lint", path, "--fix", *only)
    assert (dynamics not in Path(path).read_text()) == goes
    urdftool("lint", path, "--fix", "--unsafe-fixes", *only)
    assert "<dynamics" not in Path(path).read_text()


def test_comments_are_rewritten_only_when_asked_for(write, urdftool):
    text = ROBOT.format(axis="0 0 1", dynamics="<!-- TODO: damping -->")
    path = write("r.urdf", text)
    urdftool("lint", path, "--fix", "--target", "ros2", "--no-cache", "--exit-zero")
    assert Path(path).read_text() == text
