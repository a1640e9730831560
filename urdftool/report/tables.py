"""Alignment of text tables; the only module that formats columns."""

from __future__ import annotations

import unicodedata
from collections.abc import Collection, Sequence

import click

from ..control_characters import escape_controls

Cell = str | tuple[str, str | None]
"""A text, or a text and its color."""

_GAP = "  "
"""Blanks between two columns."""
_WIDE = ("W", "F")
"""Widths of characters that take two columns of a terminal; source: Unicode Annex 11."""
_WITHOUT_WIDTH = ("Mn", "Me", "Cf")
"""Categories of characters that take no column: marks on others, and formats."""


def render_table(
    rows: Sequence[Sequence[Cell]],
    *,
    left: Collection[int] = (0,),
    rule: bool = False,
    colors: bool = False,
) -> str:
    """Align rows in columns that are as wide as their cells.

    The first row is the header; columns are aligned to the right, except ``left``.
    """
    if not rows:
        return ""
    cells = [[_read_cell(cell) for cell in row] for row in rows]
    columns = zip(*cells, strict=True)
    widths = [max(measure_width(text) for text, _ in column) for column in columns]
    if rule:
        cells.insert(1, [("-" * width, None) for width in widths])
    sides = [column in left for column in range(len(widths))]
    lines = (
        _GAP.join(
            _align(text, width, is_left, color if colors else None)
            for (text, color), width, is_left in zip(row, widths, sides, strict=True)
        )
        for row in cells
    )
    return "".join(f"{line.rstrip()}\n" for line in lines)


def measure_width(text: str) -> int:
    """Return the number of columns that a text takes at a terminal."""
    if text.isascii():
        return len(text)
    return sum(_measure_character(character) for character in text)


def _measure_character(character: str) -> int:
    if unicodedata.category(character) in _WITHOUT_WIDTH:
        return 0
    return 2 if unicodedata.east_asian_width(character) in _WIDE else 1


def _read_cell(cell: Cell) -> tuple[str, str | None]:
    text, color = cell if isinstance(cell, tuple) else (cell, None)
    return escape_controls(text), color


def _align(text: str, width: int, is_left: bool, color: str | None) -> str:
    """Return a text with blanks at one side, and in a color if it is not empty."""
    blanks = " " * (width - measure_width(text))
    shown = click.style(text, fg=color) if color and text else text
    return shown + blanks if is_left else blanks + shown
