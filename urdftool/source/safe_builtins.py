"""Replacements of Python functions in expressions, with bounded cost and result size.

A description may be untrusted input. Some Python functions can run for minutes or exhaust memory in
one call that cannot be interrupted, or give access to interpreter internals.
"""

from __future__ import annotations

import _string  # type: ignore[import-not-found]
import math
import re
import string
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any

HOW = "pass --trust if the input is trusted"
"""Remedy in messages about what untrusted input may not do."""

MAX_BITS = 100_000  # bits of an integer; chosen, no source
MAX_LENGTH = 10_000_000  # characters of a text, elements of a list; chosen, no source
MAX_RANGE = 1_000_000  # numbers of a range; chosen, no source
MAX_WIDTH = 9_999  # characters to which a value is formatted; chosen, no source
MAX_DIGITS = 400  # to which a number is rounded; doubles end at 5e-324; chosen, no source

_WIDE = re.compile(r"\*|\d{5}")  # also digits of other scripts
_SEQUENCES = (str, bytes, list, tuple)
_COLLECTIONS = (dict, set, frozenset)


class ForbiddenNameError(Exception):
    """Error for a name that gives access beyond the expression."""


def compute_power(base: Any, exponent: Any) -> Any:
    """Return ``base ** exponent``.

    Raises:
        OverflowError: The result would exceed ``MAX_BITS``.
    """
    if isinstance(base, int) and isinstance(exponent, int) and abs(base) > 1:
        _refuse_bits(base.bit_length() * exponent)
    return base**exponent


def shift(number: Any, places: Any) -> Any:
    """Return ``number << places``.

    Raises:
        OverflowError: The result would exceed ``MAX_BITS``.
    """
    if isinstance(number, int) and isinstance(places, int):
        _refuse_bits(number.bit_length() + places)
    return number << places


def multiply(a: Any, b: Any) -> Any:
    """Return ``a * b`` of numbers or of a sequence and a number.

    Raises:
        OverflowError: The result would exceed ``MAX_BITS`` or ``MAX_LENGTH``.
    """
    if type(a) is float or type(b) is float:
        return a * b
    if isinstance(a, int) and isinstance(b, int):
        _refuse_bits(a.bit_length() + b.bit_length())
    elif isinstance(a, _SEQUENCES) and isinstance(b, int):
        _refuse_length(len(a) * b)
    elif isinstance(b, _SEQUENCES) and isinstance(a, int):
        _refuse_length(len(b) * a)
    return a * b


def add(a: Any, b: Any) -> Any:
    """Return ``a + b`` of numbers or sequences.

    Raises:
        OverflowError: The result would exceed ``MAX_LENGTH``.
    """
    if type(a) is float or type(b) is float:
        return a + b
    if isinstance(a, _SEQUENCES) and isinstance(b, _SEQUENCES):
        _refuse_length(len(a) + len(b))
    return a + b


def compute_remainder(a: Any, b: Any) -> Any:
    """Return ``a % b`` of numbers, or of a format string and its values.

    Raises:
        OverflowError: The format string has a width of five or more digits or ``*``.
    """
    if isinstance(a, str | bytes):
        _refuse_width(a if isinstance(a, str) else a.decode("latin-1"))
    return a % b


def make_range(*bounds: Any) -> range:
    """Return ``range(*bounds)``.

    Raises:
        OverflowError: It has more than ``MAX_RANGE`` numbers.
    """
    numbers = range(*bounds)
    count = abs(numbers[-1] - numbers[0]) // abs(numbers.step) + 1 if numbers else 0
    _refuse_above(MAX_RANGE, count, "the range", "numbers")
    return numbers


def sum_values(things: Iterable[Any], start: Any = 0) -> Any:
    """Return ``sum(things, start)``, with the bounds of :func:`total`."""
    for thing in things:
        start = add(start, thing)
    return start


def round_number(number: Any, digits: Any = None) -> Any:
    """Return ``round(number, digits)``.

    Raises:
        OverflowError: ``digits`` exceeds ``MAX_DIGITS``.
    """
    if isinstance(digits, int):
        _refuse_above(MAX_DIGITS, abs(digits), "rounding", "digits")
    return round(number, digits)


def multiply_all(things: Iterable[Any], *, start: Any = 1) -> Any:
    """Return ``math.prod(things, start=start)``, with the bounds of :func:`product`."""
    for thing in things:
        start = multiply(start, thing)
    return start


def limit_arguments(function: Callable[..., Any]) -> Callable[..., Any]:
    """Wrap a function of integers: at most 100 arguments, none above 5000."""

    def small(*arguments: Any) -> Any:
        _refuse_above(100, len(arguments), "the function", "arguments")
        for number in arguments:
            if isinstance(number, int) and number > 5000:
                raise OverflowError("the argument exceeds the limit of 5000")
        return function(*arguments)

    return small


PYTHON: Mapping[str, Any] = {
    **{
        function.__name__: function
        for function in (
            *(list, dict, str, float, int, bool, complex, set, frozenset, tuple, slice),
            *(map, zip, filter, enumerate, reversed, sorted),
            *(len, min, max, abs, all, any, divmod, isinstance, ord, repr),
        )
    },
    "True": True,
    "False": False,
    "range": make_range,
    "round": round_number,
    "sum": sum_values,
}
"""Functions and types in ``python.NAME``, by name; those of untrusted input."""

_MATH = (
    *("acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "ceil", "copysign"),
    *("cos", "cosh", "degrees", "dist", "e", "erf", "erfc", "exp", "exp2", "expm1", "fabs"),
    *("floor", "fmod", "frexp", "fsum", "gamma", "gcd", "hypot", "inf", "isclose", "isfinite"),
    *("isinf", "isnan", "isqrt", "ldexp", "lgamma", "log", "log10", "log1p", "log2", "modf"),
    *("nan", "nextafter", "pi", "pow", "radians", "remainder", "sin", "sinh", "sqrt", "sumprod"),
    *("tan", "tanh", "tau", "trunc", "ulp", "fma"),
)

MATH: Mapping[str, Any] = {
    **{name: getattr(math, name) for name in _MATH if hasattr(math, name)},
    **{name: limit_arguments(getattr(math, name)) for name in ("comb", "factorial", "lcm", "perm")},
    "prod": multiply_all,
}
"""Numbers and functions in ``math.NAME``, by name; those of untrusted input."""

BOUNDED: Mapping[str, Any] = {
    name: value
    for name, value in {**PYTHON, **MATH}.items()
    if getattr(value, "__module__", None) == __name__
}
"""Functions of this module that replace those of Python, by name; in trusted input, too."""


def refuse_function(name: str) -> Callable[..., Any]:
    """Return a function in place of one that untrusted input may not call."""

    def refuse(*_: Any, **__: Any) -> Any:
        raise ForbiddenNameError(f"{name}() is not allowed in a description; {HOW}")

    return refuse


class _Formatter(string.Formatter):
    """``str.format`` without attribute access."""

    def get_field(self, field_name: str, args: Sequence[Any], kwargs: Mapping[str, Any]) -> Any:
        first, rest = _string.formatter_field_name_split(field_name)
        value = self.get_value(first, args, kwargs)
        for is_attribute, key in rest:
            if is_attribute:
                raise ForbiddenNameError(f"'{field_name}' is not allowed in format(); {HOW}")
            value = get_item(value, key)
        return value, first

    def format_field(self, value: Any, format_spec: str) -> str:
        _refuse_width(format_spec)
        return str(super().format_field(value, format_spec))


def _join(text: str, parts: Iterable[str]) -> str:
    parts = list(parts)
    _refuse_length(sum(map(len, parts)) + len(text) * len(parts))
    return text.join(parts)


def _replace(text: str, old: str, new: str, *count: int) -> str:
    _refuse_length(len(text) + (text.count(old) if old else len(text) + 1) * len(new))
    return text.replace(old, new, *count)


def _limit_padding(name: str) -> Callable[..., str]:
    def pad(text: str, width: int, *fill: str) -> str:
        _refuse_above(MAX_WIDTH, width, "the width", "characters")
        return str(getattr(text, name)(width, *fill))

    return pad


def _extend(values: list[Any], more: Iterable[Any]) -> None:
    added = list(more)
    _refuse_length(len(values) + len(added))
    values.extend(added)


BOUNDED_METHODS: Mapping[str, tuple[type, Callable[..., Any]]] = {
    "format": (str, _Formatter().format),
    "join": (str, _join),
    "replace": (str, _replace),
    **{name: (str, _limit_padding(name)) for name in ("center", "ljust", "rjust", "zfill")},
    "extend": (list, _extend),
}
"""Replacements of methods, by name, with the type of the owner."""

METHODS: tuple[tuple[type, frozenset[str]], ...] = (
    (
        str,
        frozenset(
            (
                *("capitalize", "casefold", "center", "count", "endswith", "find", "format"),
                *("index", "isalnum", "isalpha", "isascii", "isdecimal", "isdigit", "islower"),
                *("isnumeric", "isspace", "istitle", "isupper", "join", "ljust", "lower"),
                *("lstrip", "partition", "removeprefix", "removesuffix", "replace", "rfind"),
                *("rindex", "rjust", "rpartition", "rsplit", "rstrip", "split", "splitlines"),
                *("startswith", "strip", "swapcase", "title", "upper", "zfill"),
            )
        ),
    ),
    (
        dict,
        frozenset(
            (
                *("clear", "copy", "get", "items", "keys", "pop", "popitem", "setdefault"),
                *("update", "values"),
            )
        ),
    ),
    (
        list,
        frozenset(
            (
                *("append", "clear", "copy", "count", "extend", "index", "insert", "pop"),
                *("remove", "reverse", "sort"),
            )
        ),
    ),
    (tuple, frozenset(("count", "index"))),
    (
        set,
        frozenset(
            (
                *("add", "clear", "copy", "difference", "discard", "intersection", "isdisjoint"),
                *("issubset", "issuperset", "pop", "remove", "symmetric_difference", "union"),
                "update",
            )
        ),
    ),
    (
        frozenset,
        frozenset(
            (
                *("copy", "difference", "intersection", "isdisjoint", "issubset", "issuperset"),
                *("symmetric_difference", "union"),
            )
        ),
    ),
    (float, frozenset(("imag", "is_integer", "real"))),
    (int, frozenset(("bit_length", "imag", "is_integer", "real"))),
    (complex, frozenset(("conjugate", "imag", "real"))),
)
"""Methods and attributes of values that untrusted input may use, by the type of the owner."""


def get_attribute(owner: Any, name: str) -> Any:
    """Return ``owner.name`` in untrusted input.

    That is a method in ``METHODS``, a value of a namespace of xacro, or the value of a key of a
    dictionary with dotted access.

    Raises:
        AttributeError: The owner does not have it.
        ForbiddenNameError: The owner has it, but it is not in the list.
    """
    if _is_namespace(owner):
        try:
            return get_item(owner, name)
        except KeyError:
            raise NameError(f"name '{name}' is not defined") from None
    names = next((names for kind, names in METHODS if isinstance(owner, kind)), ())
    if name in names:
        return get_bounded_method(owner, name)
    kind = owner if isinstance(owner, type) else type(owner)
    if kind is owner or any(name in base.__dict__ for base in kind.__mro__):
        raise ForbiddenNameError(
            f"attribute .{name} of {kind.__name__} is not allowed in a description; {HOW}"
        )
    if isinstance(owner, dict) and kind is not dict:  # YAML with dotted access
        return owner[name]
    raise AttributeError(f"'{kind.__name__}' object has no attribute '{name}'")


def get_item(owner: Any, key: Any) -> Any:
    """Return ``owner[key]`` in untrusted input.

    Raises:
        ForbiddenNameError: The owner is a type, or the name of a namespace is hidden.
    """
    if isinstance(owner, type):
        raise ForbiddenNameError(f"a subscript of {owner.__name__} is not allowed; {HOW}")
    if _is_namespace(owner) and not str(key).isidentifier():
        raise KeyError(key)
    if _is_namespace(owner) and str(key).startswith("__"):
        raise ForbiddenNameError(f"names that begin with '__' are not allowed: {key}")
    return owner[key]


def _is_namespace(value: Any) -> bool:
    """Tell whether a value is a namespace of xacro: a dictionary that evaluates its values."""
    return isinstance(value, dict) and hasattr(type(value), "_resolve_")


def get_bounded_method(owner: Any, name: str) -> Any:
    """Return ``owner.name``, or its replacement in ``BOUNDED_METHODS``."""
    kind, function = BOUNDED_METHODS.get(name, (None, None))
    if kind is not None and function is not None and isinstance(owner, kind):
        return partial(function, owner)
    return getattr(owner, name)


def check_size(value: Any) -> None:
    """Check the size of a result.

    Raises:
        OverflowError: It exceeds ``MAX_LENGTH``, nested values included.
    """
    if type(value) in _SCALARS:
        return
    if isinstance(value, (*_SEQUENCES, *_COLLECTIONS)):
        _refuse_length(len(value))
    if isinstance(value, (list, tuple, *_COLLECTIONS)):
        _refuse_length(_count_characters(value, {}))


_SCALARS = frozenset((bool, float, int, type(None)))


def _count_characters(value: Any, known: dict[int, int]) -> int:
    """Return the approximate length of a value as text; repeated parts are visited once."""
    if isinstance(value, str | bytes):
        return len(value)
    if isinstance(value, int):
        return 1 + value.bit_length() // 3
    if not isinstance(value, (list, tuple, *_COLLECTIONS)):
        return 1
    if id(value) not in known:
        known[id(value)] = 0
        parts = [*value, *value.values()] if isinstance(value, dict) else value
        known[id(value)] = 1 + sum(_count_characters(part, known) for part in parts)
    return known[id(value)]


def check_format(spec: str) -> None:
    """Check the width in a format specification.

    Raises:
        OverflowError: It has five or more digits or ``*``.
    """
    _refuse_width(spec)


def _refuse_bits(bits: int) -> None:
    _refuse_above(MAX_BITS, bits, "the number", "bits")


def _refuse_length(length: int) -> None:
    _refuse_above(MAX_LENGTH, length, "the text or list", "characters or elements")


def _refuse_width(spec: str) -> None:
    if _WIDE.search(spec):
        raise OverflowError("the format width exceeds the limit of 4 digits")


def _refuse_above(limit: int, value: int, what: str, unit: str) -> None:
    if value > limit:
        raise OverflowError(f"{what} exceeds the limit of {limit} {unit}")
