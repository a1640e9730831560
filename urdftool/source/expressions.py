"""Compilation of expressions in ``${…}`` and ``$(eval …)``, with checked names and bounded cost.

xacro evaluates expressions with Python's ``eval``. This module checks all names in an expression,
and replaces operators and methods of unbounded result size by functions of ``bounded``.
"""

from __future__ import annotations

import ast
import re
from functools import lru_cache
from types import CodeType
from typing import Any

from . import safe_builtins
from .safe_builtins import ForbiddenNameError

_HIDDEN = frozenset(
    (
        *("ag_await", "ag_code", "ag_frame", "cr_await", "cr_code", "cr_frame", "cr_origin"),
        *("gi_code", "gi_frame", "gi_yieldfrom", "f_back", "f_builtins", "f_code", "f_globals"),
        *("f_locals", "f_trace", "tb_frame", "tb_next", "mro", "format_map"),
        *("expandtabs", "translate", "to_bytes"),
    )
)
_OPERATORS = {
    ast.Add: "__total__",
    ast.Mult: "__product__",
    ast.Mod: "__remainder__",
    ast.Pow: "__power__",
    ast.LShift: "__shift__",
}

# An expression without a match needs no syntax tree.
_METHODS = "|".join((*safe_builtins.METHODS, *_HIDDEN))
_SUSPECT = re.compile(rf"[+*%]|<<|\b[fF][rR]?['\"]|\b[rR][fF]['\"]|\.\s*(?:{_METHODS})")


@lru_cache(maxsize=1 << 15)
def compile_expression(source: str) -> CodeType:
    """Compile an expression.

    Raises:
        SyntaxError: It is not an expression.
        ForbiddenNameError: It uses a name that gives access to interpreter internals.
    """
    text = source.strip()
    if not _SUSPECT.search(text):
        code = compile(text, "<expression>", "eval")
        _check_names(code)
        return code
    tree = ast.parse(text, "<expression>", "eval")
    _check_names(compile(tree, "<expression>", "eval"))
    _check_attributes(tree)
    return compile(_Bounded().visit(tree), "<expression>", "eval")


def _check_names(code: CodeType) -> None:
    """Check the names in an expression and in its nested functions and comprehensions."""
    hidden = [name for name in (*code.co_names, *code.co_varnames) if name.startswith("__")]
    if hidden:
        raise ForbiddenNameError(f"names that begin with '__' are not allowed: {', '.join(hidden)}")
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            _check_names(inner)


def _check_attributes(tree: ast.AST) -> None:
    """Check for attributes that give access to frames and code, or create text of any size."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and node.attr in _HIDDEN:
            raise ForbiddenNameError(f"attribute .{node.attr} is not allowed in a description")


class _Bounded(ast.NodeTransformer):
    """Transformer that replaces operators and methods by calls of bounded functions."""

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        """Replace an operator."""
        self.generic_visit(node)
        function = _OPERATORS.get(type(node.op))
        return node if function is None else _call(node, function, node.left, node.right)

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        """Replace a method of a string."""
        self.generic_visit(node)
        if node.attr not in safe_builtins.METHODS:
            return node
        name = ast.copy_location(ast.Constant(node.attr), node)
        return _call(node, "__method__", node.value, name)

    def visit_FormattedValue(self, node: ast.FormattedValue) -> ast.AST:
        """Check the width of a formatted value."""
        self.generic_visit(node)
        for part in getattr(node.format_spec, "values", []):
            if not isinstance(part, ast.Constant):
                raise ForbiddenNameError("a format width cannot be an expression")
            safe_builtins.check_format(str(part.value))
        return node


def _call(node: ast.expr, function: str, *arguments: ast.expr) -> ast.Call:
    name = ast.copy_location(ast.Name(function, ast.Load()), node)
    return ast.copy_location(ast.Call(name, list(arguments), []), node)


# Python searches these names last; _check_names prevents their direct use.
BUILTINS: dict[str, Any] = {
    "__power__": safe_builtins.compute_power,
    "__shift__": safe_builtins.shift,
    "__product__": safe_builtins.multiply,
    "__total__": safe_builtins.add,
    "__remainder__": safe_builtins.compute_remainder,
    "__method__": safe_builtins.get_method,
}
