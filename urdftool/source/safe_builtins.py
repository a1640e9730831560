"""Replacements of Python functions in expressions, with bounded cost and result size.

A description may be untrusted input. Some Python functions can run for minutes or exhaust memory in
one call that cannot be interrupted, or give access to interpreter internals.
"""

from __future__ import annotations

import math
import re
import string
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

MAX_BITS = 100_000
MAX_LENGTH = 10_000_000
MAX_RANGE = 1_000_000
MAX_WIDTH = 9_999
MAX_DIGITS = 400

_WIDE = re.compile(r"\*|[0-9]{5}")
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


def get_type(thing: Any, *more: Any) -> type:
    """Return ``type(thing)`` of a value; types cannot be created.

    Raises:
        ForbiddenNameError: ``thing`` is a type, or more arguments are given.
    """
    if more or isinstance(thing, type):
        raise ForbiddenNameError("type() of a type is not allowed in a description")
    return type(thing)


def refuse_vars(*_: Any) -> Any:
    """Replace ``vars()``, which gives access to all names.

    Raises:
        ForbiddenNameError: Always.
    """
    raise ForbiddenNameError("vars() is not allowed in a description")


def make_range(*bounds: Any) -> range:
    """Return ``range(*bounds)``.

    Raises:
        OverflowError: It has more than ``MAX_RANGE`` numbers.
    """
    found = range(*bounds)
    if found and abs(found[-1] - found[0]) // abs(found.step) >= MAX_RANGE:
        raise _make_size_error()
    return found


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
    if isinstance(digits, int) and abs(digits) > MAX_DIGITS:
        raise _make_size_error()
    return round(number, digits)


def multiply_all(things: Iterable[Any], *, start: Any = 1) -> Any:
    """Return ``math.prod(things, start=start)``, with the bounds of :func:`product`."""
    for thing in things:
        start = multiply(start, thing)
    return start


def limit_arguments(function: Callable[..., Any]) -> Callable[..., Any]:
    """Wrap a function of integers: at most 100 arguments, none above 5000."""

    def small(*arguments: Any) -> Any:
        if len(arguments) > 100 or any(isinstance(n, int) and n > 5000 for n in arguments):
            raise _make_size_error()
        return function(*arguments)

    return small


PYTHON: Mapping[str, Any] = {
    "range": make_range,
    "round": round_number,
    "sum": sum_values,
    "type": get_type,
    "vars": refuse_vars,
}
"""Replacements of Python's built-in functions, by name."""

MATH: Mapping[str, Any] = {
    "prod": multiply_all,
    **{name: limit_arguments(getattr(math, name)) for name in ("comb", "factorial", "lcm", "perm")},
}
"""Replacements of functions of ``math``, by name."""


class _Formatter(string.Formatter):
    """``str.format`` without attribute access."""

    def get_field(self, field_name: str, args: Sequence[Any], kwargs: Mapping[str, Any]) -> Any:
        if "__" in field_name or "." in field_name:
            raise ForbiddenNameError(f"'{field_name}' is not allowed in format()")
        return super().get_field(field_name, args, kwargs)

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
        if width > MAX_WIDTH:
            raise _make_size_error()
        return str(getattr(text, name)(width, *fill))

    return pad


METHODS: Mapping[str, Callable[..., str]] = {
    "format": _Formatter().format,
    "join": _join,
    "replace": _replace,
    **{name: _limit_padding(name) for name in ("center", "ljust", "rjust", "zfill")},
}
"""Replacements of methods of strings, by name."""


def get_method(owner: Any, name: str) -> Any:
    """Return an attribute named in ``METHODS``, replaced if the owner is a string or ``str``.

    Raises:
        ForbiddenNameError: The owner is ``bytes``.
    """
    function = METHODS[name]
    if isinstance(owner, str):
        return lambda *values, **more: function(owner, *values, **more)
    if owner is str:
        return function
    if isinstance(owner, bytes) or owner is bytes:
        raise ForbiddenNameError(f"{name}() of bytes is not allowed in a description")
    return getattr(owner, name)


def check_size(value: Any) -> None:
    """Check the size of a result.

    Raises:
        OverflowError: It exceeds ``MAX_LENGTH``, nested values included.
    """
    if isinstance(value, (*_SEQUENCES, *_COLLECTIONS)):
        _refuse_length(len(value))
    if isinstance(value, (list, tuple, *_COLLECTIONS)):
        _refuse_length(_count_characters(value, {}))


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
    if bits > MAX_BITS:
        raise _make_size_error()


def _refuse_length(length: int) -> None:
    if length > MAX_LENGTH:
        raise OverflowError(f"the text or list exceeds the limit of {MAX_LENGTH} characters")


def _refuse_width(spec: str) -> None:
    if _WIDE.search(spec):
        raise OverflowError("the format width exceeds the limit of 4 digits")


def _make_size_error() -> OverflowError:
    return OverflowError(f"the number exceeds the limit of {MAX_BITS} bits")
