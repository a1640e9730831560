"""Names and numbers as they are shown."""

from __future__ import annotations

from collections.abc import Iterable

_LONGEST_FILE_NAME = 200  # bytes; file systems allow 255, and suffixes come on top
_LONGEST_NAME = 80


def visible(name: str) -> str:
    """A name with what cannot be seen written out: line ends, control and turning characters."""
    if name.isprintable():
        return name
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in name)


def shown(name: str) -> str:
    """A name fit for a node: visible, and not endless."""
    text = visible(name)
    return text if len(text) <= _LONGEST_NAME else text[: _LONGEST_NAME - 1] + "…"


def file_name(name: str, otherwise: str) -> str:
    """A robot's name as that of a file in the current folder.

    Args:
        name: The robot's name.
        otherwise: What a nameless robot's file is called.
    """
    plain = "".join("_" if c in "/\\" or not c.isprintable() else c for c in name).strip()
    kept = plain.encode("utf-8", "replace")[:_LONGEST_FILE_NAME].decode("utf-8", "ignore")
    return kept if kept.strip(".") else otherwise


def number(value: float) -> str:
    """A number in four digits at most; -0 is 0."""
    return f"{value + 0.0:.4g}"


def numbers(values: Iterable[float]) -> str:
    """Numbers with blanks between."""
    return " ".join(map(number, values))
