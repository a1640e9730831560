"""Find text of the package and its documentation that is not plain technical English."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from .exceptions import EXCEPTIONS
from .words import BRITISH, PREDICATES, REPLACED, VERBS, compiled

ROOT = Path(__file__).parents[2]
WORDS = compiled(REPLACED | BRITISH)


class Remark(NamedTuple):
    """One place with text to rewrite.

    Attributes:
        path: File, relative to the project.
        line: Line, from 1.
        kind: ``word``, ``docstring`` or ``name``.
        found: The words found.
        write: What to write instead.
    """

    path: str
    line: int
    kind: str
    found: str
    write: str


def find_remarks(paths: list[Path]) -> Iterator[Remark]:
    """Yield the remarks on Python and Markdown files.

    Args:
        paths: Files, or folders that are searched.
    """
    for path in paths:
        files = sorted(path.rglob("*")) if path.is_dir() else [path]
        for file in files:
            if file.suffix == ".py":
                yield from _python(file)
            elif file.suffix == ".md":
                yield from _text(file, 1, file.read_text("utf-8"))


def _python(file: Path) -> Iterator[Remark]:
    source = file.read_text("utf-8")
    tree = ast.parse(source)
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        kinds = (tokenize.STRING, tokenize.COMMENT, getattr(tokenize, "FSTRING_MIDDLE", -1))
        if token.type in kinds:
            yield from _text(file, token.start[0], token.string)
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    nested = {inner for outer in functions for inner in ast.walk(outer) if inner is not outer}
    for node in functions:
        if node not in nested:
            yield from _function(file, node)


def _text(file: Path, line: int, text: str) -> Iterator[Remark]:
    path = str(file.relative_to(ROOT)) if file.is_relative_to(ROOT) else str(file)
    for pattern, write in WORDS:
        for found in pattern.finditer(text):
            words = found[0].lower()
            start = text.rfind("\n", 0, found.start()) + 1
            end = text.find("\n", found.end())
            whole = text[start : end if end >= 0 else None]
            if any(
                re.search(where, path) and re.search(excepted, whole)
                for where, excepted, _ in EXCEPTIONS
            ):
                continue
            yield Remark(path, line + text.count("\n", 0, found.start()), "word", words, write)


def _function(file: Path, node: ast.FunctionDef) -> Iterator[Remark]:
    path = str(file.relative_to(ROOT)) if file.is_relative_to(ROOT) else str(file)
    decorators = [ast.unparse(decorator) for decorator in node.decorator_list]
    if any("property" in d or re.match(r"rule\b|click\b|\w+\.command", d) for d in decorators):
        return
    if node.name.startswith("__"):
        return
    first = (ast.get_docstring(node) or "Return").split()[0].rstrip(",.")
    if first.lower() not in VERBS:
        yield Remark(path, node.lineno, "docstring", first, "begin with a verb")
    if any(re.search(where, path) and re.fullmatch(name, node.name) for where, name, _ in NAMES):
        return
    start = node.name.lstrip("_").split("_")[0]
    if start not in VERBS | PREDICATES and start not in ("to", "from", "as", "with", "without"):
        if re.search(r"[a-z]_from_[a-z]", node.name):
            return
        yield Remark(path, node.lineno, "name", node.name, "begin with a verb")


NAMES: tuple[tuple[str, str, str], ...] = (
    (r"xacro_tree|xacro_hooks", r".*", "named by xml.dom, which xacro calls"),
    (r"rules/rule\.py", r"rule|full", "decorators, which name what they make of a function"),
    (r"inertia/solids\.py", r"[a-z_]+", "named by the solid; public"),
    (r"docs/conf\.py", r"setup", "named by Sphinx"),
    (r"server/protocol\.py", r"structure_message", "named by pygls"),
    (r"rules/fix\.py", r"safe|unsafe", "make a proposal that is safe or unsafe"),
    (
        r"(?:terminal|console|answer_stream)\.py",
        r"isatty|fileno|flush|writable|readable",
        "named by io",
    ),
)
"""Functions whose names others decide: a pattern of paths, one of names, and the reason."""
