"""Values in ``<gazebo>`` blocks, as Gazebo reads them."""

from __future__ import annotations

from ...model.read import number, parse_numbers
from ...rules.gazebo.block_values import is_value_of_kind
from ...rules.gazebo.keywords import is_true
from .numbers import format_numbers_text, number_text


def read_value(kind: str, text: str) -> str | None:
    """Return the text of a value, or None if it is not of the kind.

    Args:
        kind: The kind: ``number``, ``count``, ``vector`` (3 numbers) or ``flag``.
        text: The text of the source.
    """
    if not is_value_of_kind(kind, text):
        return None
    if kind == "flag":
        return "true" if is_true(text) else "false"
    if kind == "vector":
        return format_numbers_text(parse_numbers(text, 3) or ())
    return number_text(number(text) or 0.0)
