"""Names that expressions may use."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from .expressions import compile_expression, list_names
from .safe_builtins import BOUNDED, MATH, PYTHON, refuse_function

_ROS1_FUNCTIONS = ("list", "dict", "map", "str", "float", "int")


def make_symbols(
    original: Mapping[str, Any],
    functions: Mapping[str, Callable[..., Any]],
    warn: Callable[[str], object],
    *,
    trusted: bool,
) -> dict[str, Any]:
    """Return the global symbols of expressions.

    In untrusted input these are the names in ``PYTHON``, ``MATH`` and ``functions``; all other
    functions of xacro raise an error. In trusted input they are those of xacro, except for
    functions with bounded results.

    Args:
        original: xacro's global symbols with the namespaces ``python``, ``math`` and ``xacro``.
        functions: Functions of the namespace ``xacro`` by name.
        warn: Called with a warning if a function is called without its namespace.
        trusted: Whether the input is trusted.
    """
    spaces = {"python": PYTHON, "math": MATH, "xacro": functions}
    symbols: dict[str, Any] = {}
    for space, allowed in spaces.items():
        known = original[space]
        if trusted:
            bounded = {name: value for name, value in BOUNDED.items() if name in known}
            allowed = {**known, **(allowed if space == "xacro" else bounded)}
        refused = {name: refuse_function(f"{space}.{name}") for name in known}
        symbols[space] = type(known)()  # a parent would expose Python's functions
        symbols[space].update({**refused, **allowed})
    for name, value in original.items():
        owner = next((space for space in spaces if name in original[space]), None)
        if owner is not None and name not in spaces:
            deprecated = value is not original[owner][name]
            value = symbols[owner][name]
            symbols[name] = _wrap_deprecated(value, name, owner, warn) if deprecated else value
    return symbols


def make_ros1_evaluation(ros: Any, *, trusted: bool) -> Callable[[str, dict[str, Any]], str]:
    """Return a function for ``$(eval …)`` with the names that ROS 1 defines for it."""

    def evaluate(text: str, context: dict[str, Any]) -> str:
        arguments = context.setdefault("arg", {})

        def argument(name: str) -> Any:
            return ros.convert_value(ros._eval_arg(name, args=arguments), "auto")

        names = {**{name: PYTHON[name] for name in _ROS1_FUNCTIONS}, **MATH}
        names |= {"true": True, "false": False, "arg": argument}
        names |= {name: getattr(ros, f"_eval_{name}") for name in ("env", "optenv", "find")}
        names |= {"dirname": lambda: ros._eval_dirname(context["filename"])}
        used = list_names(text) & arguments.keys()
        names |= {name: argument(name) for name in used - names.keys()}
        return str(compile_expression(text, trusted=trusted).evaluate(names))

    return evaluate


def _wrap_deprecated(
    function: Callable[..., Any], name: str, space: str, warn: Callable[[str], object]
) -> Callable[..., Any]:
    """Wrap a function called by its deprecated name; warn as xacro does."""

    def call(*args: Any, **kwargs: Any) -> Any:
        warn(f"Using {name}() directly is deprecated. Use {space}.{name}() instead.")
        return function(*args, **kwargs)

    return call
