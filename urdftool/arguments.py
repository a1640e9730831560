"""Checks of the arguments of functions of the Python API, by their annotations."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from numbers import Integral, Real
from os import PathLike
from typing import Any, ParamSpec, TypeVar

from .errors import ConfigError

P = ParamSpec("P")
T = TypeVar("T")


def _is_list(value: object) -> bool:
    return isinstance(value, Iterable) and not isinstance(value, str | bytes | PathLike | Mapping)


def _is_a(value: object, name: str) -> bool:
    """Tell whether a class of a value has a name; to import the class takes time."""
    return any(one.__name__ == name for one in type(value).__mro__)


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _is_finite(value: object) -> bool:
    return _is_number(value) and math.isfinite(value)  # type: ignore[arg-type]


def _is_vector(value: object) -> bool:
    return _is_list(value) and len(found := [*value]) == 3 and all(map(_is_finite, found))  # type: ignore[misc]


_KINDS: Mapping[str, tuple[Callable[[Any], bool], str]] = {
    "None": (lambda value: value is None, "None"),
    "bool": (lambda value: isinstance(value, bool), "True or False"),
    "str": (lambda value: isinstance(value, str), "text"),
    "Path": (lambda value: isinstance(value, PathLike), "a path"),
    "int": (lambda value: isinstance(value, Integral) and _is_number(value), "a whole number"),
    "float": (_is_finite, "a finite number"),
    "Mapping": (lambda value: isinstance(value, Mapping), "a dict of values by name"),
    "dict": (lambda value: isinstance(value, Mapping), "a dict of values by name"),
    "Iterable": (_is_list, "a list"),
    "Sequence": (_is_list, "a list"),
    "Paths": (_is_list, "a list"),
    "Vector": (_is_vector, "three finite numbers"),
    "tuple": (_is_list, "a list"),
    "Robot": (lambda value: _is_a(value, "Robot"), "a robot of urdftool.load"),
    "Link": (lambda value: _is_a(value, "Link"), "a link of a robot of urdftool.load"),
}
"""Whether a value has a kind, and its name in a message, by the first word of an annotation."""


def check_arguments(function: Callable[P, T]) -> Callable[P, T]:
    """Return a function that raises ConfigError for arguments of another kind than annotated.

    Annotations that are not in ``_KINDS``, such as those of words, are checked by the function.

    The module of the function has ``from __future__ import annotations``.
    """
    names = function.__code__.co_varnames[: function.__code__.co_argcount]
    kinds: Mapping[str, str] = function.__annotations__

    @wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> T:
        for name, value in (*zip(names, args, strict=False), *kwargs.items()):
            require_kind(name, value, kinds.get(name, ""))
        return function(*args, **kwargs)

    return call


def require_kind(name: str, value: object, annotation: str) -> None:
    """Raise ConfigError if a value is of none of the kinds of an annotation."""
    words = [word.partition("[")[0].strip() for word in _split(annotation)]
    if not words or any(word not in _KINDS for word in words):
        return
    if any(_KINDS[word][0](value) for word in words):
        return
    allowed = [_KINDS[word][1] for word in words if word != "None"]
    text = f"{name} is {reprlib.repr(value)}, which is not {' or '.join(allowed)}"
    is_one = isinstance(value, str) and "a list" in allowed
    raise ConfigError(f"{text}; pass [{reprlib.repr(value)}]" if is_one else text)


def _split(annotation: str) -> list[str]:
    """Return the types of a union; ``|`` inside of brackets does not separate them."""
    found, depth = [""], 0
    for character in annotation:
        depth += (character == "[") - (character == "]")
        if character == "|" and not depth:
            found.append("")
        else:
            found[-1] += character
    return [one for one in found if one.strip()]
