"""The functions and files that docs/architecture.md names exist."""

import ast
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "urdftool"
PAGE = (ROOT / "docs/architecture.md").read_text("utf-8")


@cache
def list_names() -> frozenset[tuple[str, str]]:
    """List each module's path without suffix, with each function, method and class in it."""
    return frozenset(
        (f"/{path.relative_to(PACKAGE).with_suffix('').as_posix()}", node.name)
        for path in PACKAGE.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.FunctionDef | ast.ClassDef)
    )


def is_defined(module: str, name: str) -> bool:
    return any(path.endswith(f"/{module}") and name == known for path, known in list_names())


def test_call_sequences_name_functions_that_exist():
    steps = PAGE.partition("## Call sequences")[2].partition("\n## ")[0]
    spans = re.findall(r"`([a-z_/]+)\.(?:[A-Z]\w+\.)?(_?[a-z]\w+)`", steps)
    unknown = [f"{m}.{n}" for m, n in spans if m != "rule" and not is_defined(m, n)]
    assert len(spans) > 20
    assert unknown == []


def test_functions_beside_a_file_exist_in_it():
    spans = re.findall(r"`([\w/]+)\.py: ([a-z_]\w*|[A-Z][a-z]\w*)`", PAGE)
    assert len(spans) > 5
    assert [span for span in spans if not is_defined(*span)] == []


def test_files_exist():
    files = set(re.findall(r"`((?:[\w]+/)*\w+\.py)\b", PAGE))
    known = [
        f"/{path.relative_to(ROOT).as_posix()}"
        for top in ("urdftool", "tests", "measure", "docs")
        for path in (ROOT / top).rglob("*.py")
    ]
    missing = [
        f
        for f in files
        if not re.search("NAME|FAMILY|FILE", f) and not any(k.endswith(f"/{f}") for k in known)
    ]
    assert len(files) > 20
    assert missing == []
