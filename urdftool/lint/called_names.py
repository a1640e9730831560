"""Names that Python code uses: what it calls, reads, or imports from a library."""

from __future__ import annotations

import ast
import json
import re
import warnings
from collections.abc import Iterator

_WORD = re.compile(rb"[A-Za-z_]\w*")
_MAGIC = re.compile(r"(?m)^[ \t]*[%!].*$")


def list_names(path: str, text: bytes) -> frozenset[str]:
    """Return the names that a file of code uses.

    These are the names, attributes and imported names in it, and strings that are one name, as
    for ``getattr``; not what comments and texts mention. Of a file that Python does not parse, all
    words are returned.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of invalid escapes, in any file
            tree = ast.parse(_join_cells(text) if path.endswith(".ipynb") else text)
    except (SyntaxError, ValueError, TypeError, LookupError, RecursionError, MemoryError):
        return frozenset(word.decode() for word in _WORD.findall(text))
    return frozenset(_list_names(tree))


def _join_cells(text: bytes) -> str:
    """Return the code of a notebook, without commands of the shell.

    Raises:
        ValueError: It is no JSON.
        TypeError: It is no notebook.
        LookupError: It is no notebook.
    """
    cells = json.loads(text)["cells"]
    code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    return _MAGIC.sub("", "\n".join(code))


def _list_names(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            yield node.id
        elif isinstance(node, ast.Attribute):
            yield node.attr
            base = node.value
            above = base.attr if isinstance(base, ast.Attribute) else getattr(base, "id", "")
            yield f"{above}.{node.attr}"
        elif isinstance(node, ast.ImportFrom):
            module = (node.module or "").rpartition(".")[2]
            for alias in node.names:
                yield alias.name
                yield f"{module}.{alias.name}"
        elif isinstance(node, ast.Import):
            for alias in node.names:
                yield from alias.name.split(".")
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            if node.value.isidentifier():
                yield node.value
