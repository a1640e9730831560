"""Formatting of names and numbers in graphs."""

from __future__ import annotations

from collections.abc import Iterable

from ..control_characters import escape_controls

_LONGEST_FILE_NAME = 200
"""Bytes; file systems allow 255 with the suffix. Chosen, no source."""

_LONGEST_NAME = 80
"""Characters of a name that a node shows. Chosen, no source."""


def shorten_name(name: str) -> str:
    """Escape and truncate a name for a node."""
    text = escape_controls(name)
    return text if len(text) <= _LONGEST_NAME else text[: _LONGEST_NAME - 1] + "…"


def make_file_name(name: str, otherwise: str) -> str:
    """Convert a robot's name to a valid file name."""
    plain = "".join("_" if c in "/\\" or not c.isprintable() else c for c in name).strip()
    kept = plain.encode("utf-8", "replace")[:_LONGEST_FILE_NAME].decode("utf-8", "ignore")
    return kept if kept.strip(".") else otherwise


def number(value: float) -> str:
    """Format a number with at most four digits; -0 becomes 0."""
    return f"{value + 0.0:.4g}"


def format_numbers(values: Iterable[float]) -> str:
    """Format numbers, separated by blanks."""
    return " ".join(map(number, values))
