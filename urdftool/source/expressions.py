"""Compilation of expressions in ``${…}`` and ``$(eval …)`` from a list of allowed syntax.

xacro evaluates expressions with Python's ``eval``. Here an expression of untrusted input contains
only the syntax in ``SYNTAX``, and the compiled code does not access attributes: operators, methods
and subscripts become calls of functions of ``safe_builtins``, which allow methods by the type of
their owner and bound the size of results. Everything else is an error that names it.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from functools import lru_cache
from types import CodeType
from typing import Any

from . import safe_builtins
from .safe_builtins import HOW, ForbiddenNameError

MAX_LENGTH = 10_000
"""Maximum length of an expression [characters]; chosen, the longest in 1,061 real ones has 156."""

SYNTAX: frozenset[type[ast.AST]] = frozenset(
    (
        *(ast.Expression, ast.Constant, ast.Name, ast.Load, ast.Store, ast.IfExp),
        *(ast.List, ast.Tuple, ast.Dict, ast.Set, ast.Subscript, ast.Slice),
        *(ast.Attribute, ast.Call, ast.keyword),
        *(ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp, ast.comprehension),
        *(ast.BinOp, ast.Add, ast.Sub, ast.Mult, ast.Div, ast.FloorDiv, ast.Mod, ast.Pow),
        *(ast.LShift, ast.RShift, ast.BitOr, ast.BitXor, ast.BitAnd),
        *(ast.UnaryOp, ast.UAdd, ast.USub, ast.Not, ast.Invert, ast.BoolOp, ast.And, ast.Or),
        *(ast.Compare, ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE),
        *(ast.Is, ast.IsNot, ast.In, ast.NotIn),
    )
)
"""Nodes of the syntax tree that untrusted input may contain."""

CONSTANTS = (str, int, float, bool, type(None))
"""Types of literals that untrusted input may contain."""

_WORDS = {
    ast.JoinedStr: "an f-string",
    ast.Lambda: "lambda",
    ast.NamedExpr: "the operator :=",
    ast.Starred: "an unpacked argument (*)",
    ast.Await: "await",
    ast.Yield: "yield",
    ast.YieldFrom: "yield from",
    ast.MatMult: "the operator @",
}

_OPERATORS: dict[type[ast.operator], Callable[..., Any]] = {
    ast.Add: safe_builtins.add,
    ast.Mult: safe_builtins.multiply,
    ast.Mod: safe_builtins.compute_remainder,
    ast.Pow: safe_builtins.compute_power,
    ast.LShift: safe_builtins.shift,
}

# The functions that replace operators, methods and subscripts are parameters of the compiled code.
# Their names are not identifiers, so that nothing in an expression or a property refers to them.
_HELPERS: dict[str, Callable[..., Any]] = {
    **{f"<{operator.__name__}>": function for operator, function in _OPERATORS.items()},
    "<attribute>": safe_builtins.get_attribute,
    "<method>": safe_builtins.get_bounded_method,
    "<item>": safe_builtins.get_item,
    "<slice>": slice,
}


class Expression:
    """Compiled expression."""

    __slots__ = ("_code",)

    def __init__(self, code: CodeType) -> None:
        """Store code that returns a function of the helpers."""
        self._code = code

    def evaluate(self, names: dict[str, Any]) -> Any:
        """Return the value of the expression.

        Args:
            names: Values by name. Python's built-in names are not available in addition to them.
        """
        dict.__setitem__(names, "__builtins__", {})
        return eval(self._code, names)(*_HELPERS.values())


@lru_cache(maxsize=1 << 15)
def compile_expression(source: str, *, trusted: bool = False) -> Expression:
    """Compile an expression.

    Args:
        source: Its text.
        trusted: Allow all syntax and all attributes, as xacro does, except for names that begin
            with two underscores.

    Raises:
        SyntaxError: It is not an expression.
        ForbiddenNameError: It contains what untrusted input may not contain.
        OverflowError: It is longer than ``MAX_LENGTH``.
    """
    text = source.strip()
    if len(text) > MAX_LENGTH:
        raise OverflowError(f"the expression is longer than the limit of {MAX_LENGTH} characters")
    tree = ast.parse(text, "<expression>", "eval")
    _check_names(tree)
    if not trusted:
        _check_syntax(tree)
    body = _Calls(trusted=trusted).visit(tree.body)
    parameters = [ast.arg(name) for name in _HELPERS]
    arguments = ast.arguments([], parameters, None, [], [], None, [])
    function = ast.fix_missing_locations(ast.Expression(ast.Lambda(arguments, body)))
    code = compile(function, "<expression>", "eval")
    if not trusted:
        _check_code(code, {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)})
    return Expression(code)


def list_names(source: str) -> set[str]:
    """Return the names that an expression uses; an invalid expression has none."""
    try:
        tree = ast.parse(source.strip()[:MAX_LENGTH], "<expression>", "eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return set()
    return {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}


def _list_identifiers(tree: ast.AST) -> Iterator[str]:
    """Yield all identifiers, in the form to which Python normalizes them."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            yield node.id
        elif isinstance(node, ast.Attribute):
            yield node.attr
        elif isinstance(node, (ast.arg, ast.keyword)) and node.arg:
            yield node.arg


def _check_names(tree: ast.AST) -> None:
    """Check that no name begins with two underscores, as xacro does."""
    hidden = sorted({name for name in _list_identifiers(tree) if name.startswith("__")})
    if hidden:
        raise ForbiddenNameError(f"names that begin with '__' are not allowed: {', '.join(hidden)}")


def _check_syntax(tree: ast.AST) -> None:
    """Check that a tree contains only allowed nodes and literals."""
    for node in ast.walk(tree):
        if type(node) not in SYNTAX:
            _refuse(_WORDS.get(type(node), type(node).__name__))
        if isinstance(node, ast.Constant) and type(node.value) not in CONSTANTS:
            _refuse(f"a literal of type {type(node.value).__name__}")
        if isinstance(node, ast.keyword) and node.arg is None:
            _refuse("an unpacked argument (**)")
        if isinstance(node, ast.Dict) and None in node.keys:
            _refuse("an unpacked dictionary (**)")
        if isinstance(node, ast.comprehension) and node.is_async:
            _refuse("async")
        if isinstance(node, (ast.Attribute, ast.Subscript)) and not isinstance(node.ctx, ast.Load):
            _refuse("an assignment")


def _refuse(what: str) -> None:
    raise ForbiddenNameError(f"{what} is not allowed in a description; {HOW}")


class _Calls(ast.NodeTransformer):
    """Transformer that replaces operators, attributes and subscripts by calls of the helpers."""

    def __init__(self, *, trusted: bool) -> None:
        self.trusted = trusted

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        """Replace an operator whose result could be of any size."""
        self.generic_visit(node)
        if type(node.op) not in _OPERATORS:
            return node
        return _call(f"<{type(node.op).__name__}>", node.left, node.right)

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        """Replace an attribute; in trusted input only methods with a bounded replacement."""
        self.generic_visit(node)
        if self.trusted and node.attr not in safe_builtins.BOUNDED_METHODS:
            return node
        helper = "<method>" if self.trusted else "<attribute>"
        return _call(helper, node.value, ast.Constant(node.attr))

    def visit_Subscript(self, node: ast.Subscript) -> ast.AST:
        """Replace a subscript."""
        self.generic_visit(node)
        return node if self.trusted else _call("<item>", node.value, node.slice)

    def visit_Slice(self, node: ast.Slice) -> ast.AST:
        """Replace the bounds of a slice by a slice object."""
        self.generic_visit(node)
        bounds = (bound or ast.Constant(None) for bound in (node.lower, node.upper, node.step))
        return node if self.trusted else _call("<slice>", *bounds)

    def visit_GeneratorExp(self, node: ast.GeneratorExp) -> ast.AST:
        """Replace a generator by a list: no frame stays alive."""
        self.generic_visit(node)
        return node if self.trusted else ast.ListComp(node.elt, node.generators)


def _call(helper: str, *arguments: ast.expr) -> ast.Call:
    return ast.Call(ast.Name(helper, ast.Load()), list(arguments), [])


def _check_code(code: CodeType, names: set[str]) -> None:
    """Check that compiled code refers only to the names of its expression.

    The code has no other way to access an attribute than a name in ``co_names``.
    """
    unknown = {*code.co_names} - names
    if unknown:
        raise ForbiddenNameError(f"names are not allowed: {', '.join(sorted(unknown))}")
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            _check_code(inner, names)
