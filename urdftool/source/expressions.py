"""Compilation of expressions in ``${…}`` and ``$(eval …)`` from a list of allowed syntax.

xacro evaluates expressions with Python's ``eval``. Here an expression of untrusted input contains
only the syntax in ``SYNTAX``, and the compiled code does not access attributes: operators, methods
and subscripts become calls of functions of ``safe_builtins``, which allow methods by the type of
their owner and bound the size of results. Everything else is an error that names it.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator
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

_LOAD = ast.Load()
_AT: dict[str, Any] = {"lineno": 1, "col_offset": 0, "end_lineno": 1, "end_col_offset": 0}
"""Position of the nodes that are added to a tree; messages do not show it."""

_PARAMETERS = ast.arguments([], [ast.arg(name, **_AT) for name in _HELPERS], None, [], [], None, [])

_REPLACED = frozenset((ast.Attribute, ast.Subscript, ast.Slice, ast.GeneratorExp, *_OPERATORS))


class Expression:
    """Compiled expression."""

    __slots__ = ("_code", "_name")

    def __init__(self, code: CodeType, name: str | None = None) -> None:
        """Store code that returns a function of the helpers, and the name if it is only a name."""
        self._code = code
        self._name = name

    def evaluate(self, names: dict[str, Any]) -> Any:
        """Return the value of the expression.

        Args:
            names: Values by name. Python's built-in names are not available in addition to them.
        """
        if self._name is not None:  # as the code, in a third of the time
            try:
                return names[self._name]
            except KeyError:
                raise NameError(f"name '{self._name}' is not defined", name=self._name) from None
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
    nodes = _list_nodes(tree)
    _check_names(nodes)
    if not trusted:
        _check_syntax(nodes)
    body = tree.body
    if any(type(node) in _REPLACED for node in nodes):
        body = _Calls(trusted=trusted).visit(body)
    function = ast.Expression(ast.Lambda(_PARAMETERS, body, **_AT))
    code = compile(function, "<expression>", "eval")
    if not trusted:
        _check_code(code, {node.id for node in nodes if type(node) is ast.Name})
    return Expression(code, body.id if type(body) is ast.Name else None)


def list_names(source: str) -> set[str]:
    """Return the names that an expression uses; an invalid expression has none."""
    try:
        tree = ast.parse(source.strip()[:MAX_LENGTH], "<expression>", "eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return set()
    return {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}


def _list_nodes(tree: ast.AST) -> list[ast.AST]:
    """Return all nodes of a tree, which an expression makes large, as fast as possible."""
    nodes = [tree]
    for node in nodes:
        for name in node._fields:
            value = getattr(node, name, None)
            if type(value) is list:
                nodes += [item for item in value if isinstance(item, ast.AST)]
            elif isinstance(value, ast.AST):
                nodes.append(value)
    return nodes


def _list_identifiers(nodes: Iterable[ast.AST]) -> Iterator[str]:
    """Yield all identifiers, in the form to which Python normalizes them."""
    for node in nodes:
        if isinstance(node, ast.Name):
            yield node.id
        elif isinstance(node, ast.Attribute):
            yield node.attr
        elif isinstance(node, (ast.arg, ast.keyword)) and node.arg:
            yield node.arg


def _check_names(nodes: Iterable[ast.AST]) -> None:
    """Check that no name begins with two underscores, as xacro does."""
    hidden = sorted({name for name in _list_identifiers(nodes) if name.startswith("__")})
    if hidden:
        raise ForbiddenNameError(f"names that begin with '__' are not allowed: {', '.join(hidden)}")


def _check_syntax(nodes: Iterable[ast.AST]) -> None:
    """Check that a tree contains only allowed nodes and literals."""
    for node in nodes:
        kind = type(node)
        if kind not in SYNTAX:
            _refuse(_WORDS.get(kind, kind.__name__))
        if isinstance(node, ast.Constant):
            if type(node.value) not in CONSTANTS:
                _refuse(f"a literal of type {type(node.value).__name__}")
        elif isinstance(node, ast.keyword):
            if node.arg is None:
                _refuse("an unpacked argument (**)")
        elif isinstance(node, ast.Dict):
            if None in node.keys:
                _refuse("an unpacked dictionary (**)")
        elif isinstance(node, ast.comprehension):
            if node.is_async:
                _refuse("async")
        elif isinstance(node, (ast.Attribute, ast.Subscript)):
            if not isinstance(node.ctx, ast.Load):
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
        return _call(helper, node.value, ast.Constant(node.attr, **_AT))

    def visit_Subscript(self, node: ast.Subscript) -> ast.AST:
        """Replace a subscript."""
        self.generic_visit(node)
        return node if self.trusted else _call("<item>", node.value, node.slice)

    def visit_Slice(self, node: ast.Slice) -> ast.AST:
        """Replace the bounds of a slice by a slice object."""
        self.generic_visit(node)
        none = ast.Constant(None, **_AT)
        bounds = (bound or none for bound in (node.lower, node.upper, node.step))
        return node if self.trusted else _call("<slice>", *bounds)

    def visit_GeneratorExp(self, node: ast.GeneratorExp) -> ast.AST:
        """Replace a generator by a list: no frame stays alive."""
        self.generic_visit(node)
        return node if self.trusted else ast.ListComp(node.elt, node.generators, **_AT)


def _call(helper: str, *arguments: ast.expr) -> ast.Call:
    return ast.Call(ast.Name(helper, _LOAD, **_AT), list(arguments), [], **_AT)


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
