"""Functions for expressions whose cost and result are bounded, in the place of Python's own.

A description may come from a stranger. Python's own functions would spend minutes or all memory in
one call that nothing can interrupt, or lead from a number to the interpreter's insides.
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
    """A name that leads out of the expression, which no robot needs."""


def power(base: Any, exponent: Any) -> Any:
    """``base ** exponent``."""
    if isinstance(base, int) and isinstance(exponent, int) and abs(base) > 1:
        _refuse_bits(base.bit_length() * exponent)
    return base**exponent


def shift(number: Any, places: Any) -> Any:
    """``number << places``."""
    if isinstance(number, int) and isinstance(places, int):
        _refuse_bits(number.bit_length() + places)
    return number << places


def product(a: Any, b: Any) -> Any:
    """``a * b``, of numbers or of a sequence and a number."""
    if type(a) is float or type(b) is float:
        return a * b
    if isinstance(a, int) and isinstance(b, int):
        _refuse_bits(a.bit_length() + b.bit_length())
    elif isinstance(a, _SEQUENCES) and isinstance(b, int):
        _refuse_length(len(a) * b)
    elif isinstance(b, _SEQUENCES) and isinstance(a, int):
        _refuse_length(len(b) * a)
    return a * b


def total(a: Any, b: Any) -> Any:
    """``a + b``, of numbers or of sequences."""
    if type(a) is float or type(b) is float:
        return a + b
    if isinstance(a, _SEQUENCES) and isinstance(b, _SEQUENCES):
        _refuse_length(len(a) + len(b))
    return a + b


def remainder(a: Any, b: Any) -> Any:
    """``a % b``, of numbers; or of a text and what goes into it."""
    if isinstance(a, str | bytes):
        _refuse_width(a if isinstance(a, str) else a.decode("latin-1"))
    return a % b


def kind(thing: Any, *more: Any) -> type:
    """``type(thing)``, which makes no types and does not tell the type of one."""
    if more or isinstance(thing, type):
        raise ForbiddenNameError("type() is for values here")
    return type(thing)


def no_vars(*_: Any) -> Any:
    """``vars()``, which leads to everything there is."""
    raise ForbiddenNameError("vars() is not there in a description")


def numbers(*bounds: Any) -> range:
    """``range()``."""
    found = range(*bounds)
    if found and abs(found[-1] - found[0]) // abs(found.step) >= MAX_RANGE:
        raise _too_large()
    return found


def added(things: Iterable[Any], start: Any = 0) -> Any:
    """``sum()``."""
    for thing in things:
        start = total(start, thing)
    return start


def rounded(number: Any, digits: Any = None) -> Any:
    """``round()``."""
    if isinstance(digits, int) and abs(digits) > MAX_DIGITS:
        raise _too_large()
    return round(number, digits)


def multiplied(things: Iterable[Any], *, start: Any = 1) -> Any:
    """``math.prod()``."""
    for thing in things:
        start = product(start, thing)
    return start


def few(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function of whole numbers, for small ones and not too many of them."""

    def small(*arguments: Any) -> Any:
        if len(arguments) > 100 or any(isinstance(n, int) and n > 5000 for n in arguments):
            raise _too_large()
        return function(*arguments)

    return small


PYTHON: Mapping[str, Any] = {
    "range": numbers,
    "round": rounded,
    "sum": added,
    "type": kind,
    "vars": no_vars,
}
"""In the place of Python's own, by name."""

MATH: Mapping[str, Any] = {
    "prod": multiplied,
    **{name: few(getattr(math, name)) for name in ("comb", "factorial", "lcm", "perm")},
}
"""In the place of those of ``math``, by name."""


class _Formatter(string.Formatter):
    """``str.format`` without the way through attributes."""

    def get_field(self, field_name: str, args: Sequence[Any], kwargs: Mapping[str, Any]) -> Any:
        if "__" in field_name or "." in field_name:
            raise ForbiddenNameError(f"use of '{field_name}' in format()")
        return super().get_field(field_name, args, kwargs)

    def format_field(self, value: Any, format_spec: str) -> str:
        _refuse_width(format_spec)
        return str(super().format_field(value, format_spec))


def _joined(text: str, parts: Iterable[str]) -> str:
    parts = list(parts)
    _refuse_length(sum(map(len, parts)) + len(text) * len(parts))
    return text.join(parts)


def _replaced(text: str, old: str, new: str, *count: int) -> str:
    _refuse_length(len(text) + (text.count(old) if old else len(text) + 1) * len(new))
    return text.replace(old, new, *count)


def _padded(name: str) -> Callable[..., str]:
    def pad(text: str, width: int, *fill: str) -> str:
        if width > MAX_WIDTH:
            raise _too_large()
        return str(getattr(text, name)(width, *fill))

    return pad


METHODS: Mapping[str, Callable[..., str]] = {
    "format": _Formatter().format,
    "join": _joined,
    "replace": _replaced,
    **{name: _padded(name) for name in ("center", "ljust", "rjust", "zfill")},
}
"""Methods of text that are not called as they are."""


def method(owner: Any, name: str) -> Any:
    """An attribute whose name is one of ``METHODS``; of what is no text, as it is."""
    function = METHODS[name]
    if isinstance(owner, str):
        return lambda *values, **more: function(owner, *values, **more)
    if owner is str:
        return function
    if isinstance(owner, bytes) or owner is bytes:
        raise ForbiddenNameError(f"{name}() of bytes is not there in a description")
    return getattr(owner, name)


def check_size(value: Any) -> None:
    """Refuse a result that is too long to be of use."""
    if isinstance(value, (*_SEQUENCES, *_COLLECTIONS)):
        _refuse_length(len(value))
    if isinstance(value, (list, tuple, *_COLLECTIONS)):
        _refuse_length(_letters(value, {}))


def _letters(value: Any, known: dict[int, int]) -> int:
    """About how long a value is as text; what stands in it several times is looked at once."""
    if isinstance(value, str | bytes):
        return len(value)
    if isinstance(value, int):
        return 1 + value.bit_length() // 3
    if not isinstance(value, (list, tuple, *_COLLECTIONS)):
        return 1
    if id(value) not in known:
        known[id(value)] = 0
        parts = [*value, *value.values()] if isinstance(value, dict) else value
        known[id(value)] = 1 + sum(_letters(part, known) for part in parts)
    return known[id(value)]


def check_format(spec: str) -> None:
    """Refuse a format with a width that no number needs."""
    _refuse_width(spec)


def _refuse_bits(bits: int) -> None:
    if bits > MAX_BITS:
        raise _too_large()


def _refuse_length(length: int) -> None:
    if length > MAX_LENGTH:
        raise OverflowError("the text or list is longer than any robot needs")


def _refuse_width(spec: str) -> None:
    if _WIDE.search(spec):
        raise OverflowError("the width is larger than any robot needs")


def _too_large() -> OverflowError:
    return OverflowError("the number is larger than any robot needs")
