"""Kinds of the values of keywords in ``<gazebo>`` blocks."""

from __future__ import annotations

from ...model.settings import describe_kind, get_text, list_rows, parse
from ...source.document import Element


def get_kind(keyword: str) -> str:
    """Return the kind of a keyword's value: ``number``, ``count``, ``vector`` or ``flag``.

    Empty for a keyword without a value, and for what is not a keyword of a link or joint.
    """
    return next((row.kind for row in list_rows(keyword)), "")


def describe_required_keyword_value(element: Element) -> str:
    """Describe the value that a keyword requires; return "" if it has one or takes none."""
    kind = get_kind(element.tag)
    return "" if not kind or parse(kind, get_text(element)) is not None else describe_kind(kind)
