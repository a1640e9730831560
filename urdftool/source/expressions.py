"""What stands between ``${`` and ``}``: compiled once, and bounded.

xacro evaluates expressions with Python's ``eval``, stripped of its builtins. A description may come
from a stranger, so powers and shifts whose result no robot needs are refused before Python spends
minutes on them.
"""

from __future__ import annotations

import ast
from types import CodeType
from typing import Any

MAX_BITS = 100_000

_codes: dict[str, CodeType] = {}


class ForbiddenNameError(Exception):
    """A name that starts with two underscores, which xacro does not allow."""


def compile_expression(source: str) -> CodeType:
    """The code of an expression, from the cache if it was compiled before.

    Raises:
        SyntaxError: It is not an expression.
        ForbiddenNameError: It uses a name that starts with two underscores.
    """
    code = _codes.get(source)
    if code is None:
        code = compile(source.strip(), "<expression>", "eval")
        hidden = [name for name in code.co_names if name.startswith("__")]
        if hidden:
            raise ForbiddenNameError(f"use of invalid name(s) {', '.join(hidden)}")
        if "**" in source or "<<" in source:
            tree = ast.fix_missing_locations(
                _Bounded().visit(ast.parse(source.strip(), mode="eval"))
            )
            code = compile(tree, "<expression>", "eval")
        _codes[source] = code
    return code


class _Bounded(ast.NodeTransformer):
    """Calls of the bounded functions in the place of ``**`` and ``<<``."""

    _FUNCTIONS = {ast.Pow: "__power__", ast.LShift: "__shift__"}  # noqa: RUF012

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        """Replace one of the two."""
        self.generic_visit(node)
        function = self._FUNCTIONS.get(type(node.op))
        if function is None:
            return node
        name = ast.Name(function, ast.Load())
        return ast.copy_location(ast.Call(name, [node.left, node.right], []), node)


def _power(base: Any, exponent: Any) -> Any:
    if isinstance(base, int) and isinstance(exponent, int) and abs(base) > 1:
        _refuse_above(base.bit_length() * exponent)
    return base**exponent


def _shift(number: Any, places: Any) -> Any:
    if isinstance(number, int) and isinstance(places, int):
        _refuse_above(number.bit_length() + places)
    return number << places


def _refuse_above(bits: int) -> None:
    if bits > MAX_BITS:
        raise OverflowError("the number is larger than any robot needs")


# Python looks names up here last; an expression cannot name them itself.
BUILTINS = {"__power__": _power, "__shift__": _shift}
