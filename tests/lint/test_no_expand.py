"""``lint --no-expand``: nothing is evaluated, and what was not checked is said."""

import json
import shutil

import pytest

from tests.conftest import FIXTURES, XACRO
from urdftool.source import expand, expansion_process

STYLES = ("full", "concise", "json", "sarif", "github", "junit", "html")
PAYLOAD = XACRO.format("${xacro.message('evaluated')}<link name=\"${1/0}\"/>")
URDF = '<robot name="r"><link name="a"/><link name="a"/></robot>'


@pytest.fixture
def refused(monkeypatch):
    """Fail where an expansion starts."""

    def fail(*_, **__):
        pytest.fail("xacro is expanded")

    monkeypatch.setattr(expand, "expand_xacro", fail)
    monkeypatch.setattr(expansion_process, "expand", fail)
    monkeypatch.setattr(expand, "expand", fail)


@pytest.fixture
def folder(write):
    write("src/r.urdf.xacro", PAYLOAD)
    write("src/part.xacro", PAYLOAD)
    write("src/r.urdf", URDF)
    write("src/inside.urdf", PAYLOAD)  # xacro by its namespace
    write("src/r.sdf", '<sdf version="1.9"><model name="m"><link name="a"/></model></sdf>')
    write("src/r.sdf.xacro", PAYLOAD)
    return "src"


@pytest.mark.parametrize("style", STYLES)
@pytest.mark.parametrize("more", [(), ("--fix", "--diff"), ("-j", "2")])
def test_nothing_is_evaluated(urdftool, refused, folder, style, more):
    done = urdftool("lint", folder, "src/part.xacro", "--no-expand", "--format", style, *more)
    assert done.code in (0, 1)
    assert "evaluated" not in done.out + done.err
    assert "duplicate-link-name" in done.out or "--fix" in more


def test_the_payload_is_evaluated_otherwise(urdftool, folder):
    done = urdftool("lint", "src/r.urdf.xacro")
    assert done.code == 2
    assert "division by zero" in done.out
    assert "evaluated" in done.err


XACROS = "r.urdf.xacro", "part.xacro", "r.sdf.xacro"


def test_files_that_were_not_expanded_are_counted(urdftool, refused, folder):
    done = urdftool("lint", folder, "--no-expand", "--exit-zero")
    assert done.code == 0
    assert "4 xacro files not expanded and so not checked" in done.err
    assert "src/r.urdf.xacro" in done.err
    assert "checked 2 robots (2 variants), 0 files belong to them, 4 not checked: " in done.err
    assert "in 2 files" in done.err  # r.urdf and r.sdf
    table = json.loads(urdftool("lint", folder, "--no-expand", "--format", "json").out)
    skipped = {entry["path"]: entry["reason"] for entry in table["summary"]["skipped"]}
    named = {path for path, reason in skipped.items() if "--no-expand" in reason}
    assert named == {f"src/{name}" for name in ("inside.urdf", *XACROS)}
    assert table["summary"]["files"] == 2
    assert table["summary"]["not_checked"] == []


def test_the_source_is_checked(urdftool, refused, write):
    write("broken.urdf.xacro", PAYLOAD.replace("<link", "<link><"))
    done = urdftool("lint", "broken.urdf.xacro", "--no-expand")
    assert done.code == 2
    assert "[not-well-formed]" in done.out
    write("prefix.urdf.xacro", PAYLOAD.replace("<link", "<other:link"))
    assert urdftool("lint", "prefix.urdf.xacro", "--no-expand").code == 2
    for rule in ("macro-redefined", "unprefixed-xacro-tag"):
        shutil.copyfile(FIXTURES / "rules" / rule / "bad.urdf.xacro", "r.urdf.xacro")
        assert f"[{rule}]" in urdftool("lint", "r.urdf.xacro", "--no-expand").out
        shutil.copyfile(FIXTURES / "rules" / rule / "good.urdf.xacro", "r.urdf.xacro")
        assert urdftool("lint", "r.urdf.xacro", "--no-expand").code == 0


def test_a_urdf_is_checked_as_always(urdftool, write):
    write("r.urdf", URDF)
    assert urdftool("lint", "r.urdf", "--no-expand") == urdftool("lint", "r.urdf")


def test_a_cached_report_of_an_expansion_is_not_used(urdftool, write):
    write("r.urdf.xacro", XACRO.format('<link name="${1}"/><link name="${1}"/>'))
    for _ in range(2):
        assert urdftool("lint", "r.urdf.xacro").code == 1
        done = urdftool("lint", "r.urdf.xacro", "--no-expand")
        assert done.code == 0
        assert "not expanded" in done.err


def test_variants_are_not_expanded(urdftool, refused, write):
    write("r.urdf.xacro", PAYLOAD)
    write("urdftool.toml", '[lint.variants]\n"*.xacro" = [{a = "1"}, {a = "2"}]\n')
    done = urdftool("lint", "r.urdf.xacro", "--no-expand")
    assert done.code == 0
    assert "1 xacro file not expanded" in done.err
