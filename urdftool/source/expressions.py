"""What stands between ``${`` and ``}``, or in ``$(eval …)``: compiled once, and bounded.

xacro evaluates expressions with Python's ``eval``. What they may name is checked here, in every
part of an expression, and operators and methods whose result can be of any size become those of
``bounded``.
"""

from __future__ import annotations

import ast
import re
from functools import lru_cache
from types import CodeType
from typing import Any

from . import bounded
from .bounded import ForbiddenNameError

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

# Without any of these nothing in an expression needs a closer look.
_METHODS = "|".join((*bounded.METHODS, *_HIDDEN))
_SUSPECT = re.compile(rf"[+*%]|<<|\b[fF][rR]?['\"]|\b[rR][fF]['\"]|\.\s*(?:{_METHODS})")


@lru_cache(maxsize=1 << 15)
def compile_expression(source: str) -> CodeType:
    """Compile an expression.

    Raises:
        SyntaxError: It is not an expression.
        ForbiddenNameError: It uses a name that leads to the interpreter's insides.
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
    """Refuse hidden names in an expression and in the functions and comprehensions within it."""
    hidden = [name for name in (*code.co_names, *code.co_varnames) if name.startswith("__")]
    if hidden:
        raise ForbiddenNameError(f"use of invalid name(s) {', '.join(hidden)}")
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            _check_names(inner)


def _check_attributes(tree: ast.AST) -> None:
    """Refuse attributes that lead to frames and code, or make text of any size."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and node.attr in _HIDDEN:
            raise ForbiddenNameError(f"use of .{node.attr} is not allowed in a description")


class _Bounded(ast.NodeTransformer):
    """Calls of bounded functions in the place of operators and methods."""

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        """Replace an operator."""
        self.generic_visit(node)
        function = _OPERATORS.get(type(node.op))
        return node if function is None else _call(node, function, node.left, node.right)

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        """Replace a method of text."""
        self.generic_visit(node)
        if node.attr not in bounded.METHODS:
            return node
        name = ast.copy_location(ast.Constant(node.attr), node)
        return _call(node, "__method__", node.value, name)

    def visit_FormattedValue(self, node: ast.FormattedValue) -> ast.AST:
        """Look at the width that a value is to have."""
        self.generic_visit(node)
        for part in getattr(node.format_spec, "values", []):
            if not isinstance(part, ast.Constant):
                raise ForbiddenNameError("a width that is itself an expression")
            bounded.check_format(str(part.value))
        return node


def _call(node: ast.expr, function: str, *arguments: ast.expr) -> ast.Call:
    name = ast.copy_location(ast.Name(function, ast.Load()), node)
    return ast.copy_location(ast.Call(name, list(arguments), []), node)


# Python looks names up here last; an expression cannot name them itself.
BUILTINS: dict[str, Any] = {
    "__power__": bounded.power,
    "__shift__": bounded.shift,
    "__product__": bounded.product,
    "__total__": bounded.total,
    "__remainder__": bounded.remainder,
    "__method__": bounded.method,
}
