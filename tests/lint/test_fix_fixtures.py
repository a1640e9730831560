"""Each fix against its fixtures: ``bad.urdf`` with ``--fix`` is ``fixed.urdf``, byte for byte.

``fixed*`` beside ``bad*`` in ``fixtures/rules/RULE/`` is what the fix of that rule alone makes of
it; a file without a ``fixed`` one is not fixed. In a folder ``fixed*`` are other files, which
become so or are made.
"""

import shutil

import pytest

from tests.conftest import FIXTURES
from urdftool.rules import FAMILY_OF
from urdftool.rules.table import FIXES

RULES = FIXTURES / "rules"
BAD = sorted(path for rule in FIXES for path in (RULES / rule).glob("bad*.urdf*"))

ALL = ("--unsafe-fixes", "--fix-meshes")

ALSO = {"unused-suppression": ("missing-collision",)}
"""Rules that must run for another to find anything."""


def _name(path):
    return f"{path.parent.name}/{path.name}"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    def copy(rule):
        there = tmp_path / rule
        shutil.copytree(RULES / rule, there, ignore=shutil.ignore_patterns("fixed*"))
        monkeypatch.chdir(there)
        return there

    return copy


def _files(there):
    found = sorted(path for path in there.rglob("*") if path.is_file())
    return {path.relative_to(there).as_posix(): path.read_bytes() for path in found}


@pytest.mark.parametrize("bad", BAD, ids=_name)
def test_bad_becomes_fixed(bad, folder, urdftool):
    rule = bad.parent.name
    there = folder(rule)
    expected = _files(there)
    for path in bad.parent.glob("fixed*"):
        name = path.name.replace("fixed", "bad", 1)
        if name.split(".")[0] == bad.name.split(".")[0]:
            expected |= _files(path) if path.is_dir() else {name: path.read_bytes()}
    changes = expected != _files(there)
    select = ("--select", ",".join((rule, *ALSO.get(rule, ()))), "--no-cache", "--exit-zero")
    shown = urdftool("lint", bad.name, *select, "--diff", *ALL)
    assert _files(there) != expected or not changes
    result = urdftool("lint", bad.name, *select, "--fix", *ALL)
    assert result.code == (2 if "not checked" in result.err else 0), result.err
    assert _files(there) == expected
    assert bool(shown.out) == changes
    again = urdftool("lint", bad.name, *select, "--fix", *ALL)
    assert "Nothing to fix." in again.err
    assert _files(there) == expected


@pytest.mark.parametrize("bad", BAD, ids=_name)
def test_only_safe_fixes_without_unsafe_ones(bad, folder, urdftool):
    rule = bad.parent.name
    if FIXES[rule].applicability != "unsafe":
        return
    there = folder(rule)
    before = _files(there)
    words = ("--select", rule, "--fix", "--fix-meshes", "--exit-zero", "--no-cache")
    result = urdftool("lint", bad.name, *words)
    assert _files(there) == before
    assert "Nothing to fix." in result.err


@pytest.mark.parametrize("rule", FIXES)
def test_a_rule_with_a_fix_has_one_that_is_shown(rule):
    assert rule in FAMILY_OF
    assert FIXES[rule].applicability in ("safe", "unsafe", "safe or unsafe")
    assert list((RULES / rule).glob("fixed*")), f"{rule} has no fixed fixture"


def test_nothing_is_fixed_by_a_rule_without_a_fix():
    there = {path.parent.name for path in RULES.glob("*/fixed*")}
    assert there == set(FIXES)
