"""Text of the package and its documentation is plain technical English (``tests/language``)."""

import pytest

from .conftest import ROOT
from .language.check import find_remarks

PARTS = sorted(
    path
    for path in (ROOT / "urdftool").iterdir()
    if (path.is_dir() and path.name != "__pycache__") or path.suffix == ".py"
)


@pytest.mark.parametrize("part", [*PARTS, ROOT / "docs", ROOT / "README.md"], ids=lambda p: p.name)
def test_no_private_words_and_verbs_first(part):
    remarks = [f"{r.path}:{r.line}: {r.found}: {r.write}" for r in find_remarks([part])]
    assert remarks == []


def test_words_names_and_docstrings_are_found(tmp_path):
    bad = tmp_path / "bad.py"
    bad.write_text('def wheel():\n    """A wheel whose colour nobody knows."""\n')
    kinds = {remark.kind for remark in find_remarks([bad])}
    assert kinds == {"word", "docstring", "name"}
