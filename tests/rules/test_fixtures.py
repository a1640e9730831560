"""Every rule against its fixtures, which are also the examples of its page.

``fixtures/rules/RULE/bad*.urdf[.xacro]`` is a small whole robot with that fault. Each line where
a finding is expected ends in a comment that names the rules found there: ``<!-- zero-axis -->``,
or ``<!-- zero-mass massless-moving-body -->``; in ``bad.usda`` it is ``# zero-axis``. Where a
comment cannot stand (a file that is not well-formed, a line inside a tag), ``bad.expected`` beside
it has lines such as ``3 not-well-formed`` (or ``bad.srdf 3 …``, of another file) and the comments
do not count.
``good*.urdf`` is the same robot without the fault, and silent. ``urdftool.toml`` beside them sets
targets where the rule needs one.
"""

import re
from pathlib import Path

import pytest

from tests import rule_table
from urdftool.formats.detect import read_other_format
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings
from urdftool.rules import FAMILY_OF, get_rule
from urdftool.rules.rule import Rule
from urdftool.rules.table import RULES

FIXTURES = Path(__file__).parents[2] / "fixtures" / "rules"

ENDINGS = (".urdf", ".xacro", ".sdf", ".usda")
BAD, GOOD = (
    sorted(path for path in FIXTURES.glob(f"*/{word}*") if path.suffix in ENDINGS)
    for word in ("bad", "good")
)


def _name(path):
    return f"{path.parent.name}/{path.name}"


def _findings(path):
    if path.suffix == ".usda":
        pytest.importorskip("pxr")
    settings = Settings(extend_select=(path.parent.name,))
    options = Options(settings, read_other=read_other_format)
    report = check_file(path, options)
    assert report.error is None
    assert not report.failed_rules
    for library in report.skipped_rules.values():
        pytest.skip(f"requires {library}")
    return report.findings


def _expected(path):
    beside = path.parent / (path.name.split(".")[0] + ".expected")
    if beside.exists():
        lines = [line.split() for line in beside.read_text().splitlines() if line.strip()]
        named = [line if not line[0].isdigit() else [path.name, *line] for line in lines]
        return sorted((line[0], int(line[1]), rule) for line in named for rule in line[2:])
    marks = []
    for file in sorted(path.parent.glob("*")):
        if file != path and (
            file.name.startswith(("bad", "good", "fixed")) or file.suffix == ".toml"
        ):
            continue
        if file.suffix not in ENDINGS:
            continue
        for number, line in enumerate(file.read_text("utf-8").splitlines(), 1):
            for comment in re.findall(r"<!--\s([a-z0-9 -]+)\s-->|# ([a-z0-9 -]+)$", line):
                words = "".join(comment).split()
                if all(word in FAMILY_OF for word in words):
                    marks += [(file.name, number, word) for word in words]
    return sorted(marks)


@pytest.mark.parametrize("path", BAD, ids=_name)
def test_bad_is_found_on_its_lines_and_nothing_else(path):
    found = sorted((Path(f.location.path).name, f.location.line, f.code) for f in _findings(path))
    assert found == _expected(path)
    assert path.parent.name in {rule for _, _, rule in found}


@pytest.mark.parametrize("path", GOOD, ids=_name)
def test_good_is_silent(path):
    assert [str(finding) for finding in _findings(path)] == []


@pytest.mark.parametrize("name", FAMILY_OF)
def test_rule_is_complete(name):
    rule = get_rule(name)
    assert isinstance(rule, Rule)
    assert rule.name == name
    assert rule.family == FAMILY_OF[name]
    first, _, rest = (rule.check.__doc__ or "").partition("\n")
    assert first.strip().endswith("."), "the first line is a fact, a sentence"
    assert rest.strip(), "why it hurts"
    folder = FIXTURES / name
    assert folder in {path.parent for path in BAD}, f"{folder} has no bad fixture"
    assert folder in {path.parent for path in GOOD}, f"{folder} has no good fixture"


def test_no_fixture_without_a_rule():
    assert {path.name for path in FIXTURES.iterdir()} == set(FAMILY_OF)


def test_no_name_twice():
    names = [n for files in RULES.values() for group in files.values() for n in group]
    assert len(names) == len(set(names))


def test_the_table_of_rules_is_that_of_the_decorators():
    pytest.importorskip("ruff")
    assert rule_table.TABLE.read_text("utf-8") == rule_table.text(), "python -m tests.rule_table"
