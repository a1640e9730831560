"""Values in ``<gazebo>`` blocks, as Gazebo reads them."""

from __future__ import annotations

from ...model.read import number, numbers
from ...source.document import Element
from .numbers import number_text, numbers_text

_TRUE = frozenset(("true", "yes", "1"))
_FALSE = frozenset(("false", "no", "0"))


def is_true(text: str | None) -> bool:
    """Tell whether a flag is set."""
    return text is not None and text.strip().lower() in _TRUE


def is_false(text: str | None) -> bool:
    """Tell whether a flag is cleared."""
    return text is not None and text.strip().lower() in _FALSE


def is_flag(text: str) -> bool:
    """Tell whether a text is a flag."""
    return is_true(text) or is_false(text)


def value_of(element: Element) -> str:
    """Return the value of an element: its attribute ``value``, or its text."""
    return (element.get("value") or element.text).strip()


def read_value(holds: str, text: str) -> str | None:
    """Return the text of a value, or None if it is not of the kind.

    Args:
        holds: The kind: ``number``, ``count``, ``vector`` (3 numbers) or ``flag``.
        text: The text of the source.
    """
    if holds == "flag":
        return ("true" if is_true(text) else "false") if is_flag(text) else None
    if holds == "vector":
        three = numbers(text, 3)
        return None if three is None else numbers_text(three)
    one = number(text)
    if one is None or (holds == "count" and (one < 0 or not one.is_integer())):
        return None
    return number_text(one)
