"""Alignment of text tables, by rich; the only module that formats columns."""

from __future__ import annotations

import io
from collections.abc import Collection, Sequence

from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..control_characters import escape_controls

Cell = str | tuple[str, str | None]
"""A text, or a text and its color."""

WIDEST = 100_000
"""Columns of a console that does not wrap lines. Chosen, no source."""


def create_text_console(stream: io.StringIO, *, colors: bool, width: int = WIDEST) -> Console:
    """Create a rich console that writes plain text, or text with the 8 terminal colors."""
    return Console(
        file=stream,
        force_terminal=colors,
        color_system="standard" if colors else None,
        width=width,
        highlight=False,
        emoji=False,
        markup=False,
        legacy_windows=False,
        no_color=not colors,
        _environ={},
    )


def render_table(
    rows: Sequence[Sequence[Cell]],
    *,
    left: Collection[int] = (0,),
    rule: bool = False,
    colors: bool = False,
) -> str:
    """Align rows in columns that are as wide as their cells.

    Args:
        rows: Rows of equal length, including the header row.
        left: Columns aligned to the left; others are aligned to the right.
        rule: Draw a line below the first row.
        colors: Whether to color the cells.
    """
    if not rows:
        return ""
    table = Table(box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))
    for column in range(len(rows[0])):
        table.add_column(justify="left" if column in left else "right", no_wrap=True)
    texts = [[_make_text(cell) for cell in row] for row in rows]
    if rule:
        widths = [max(text.cell_len for text in column) for column in zip(*texts, strict=True)]
        texts.insert(1, [Text("-" * width) for width in widths])
    for line in texts:
        table.add_row(*line)
    stream = io.StringIO()
    create_text_console(stream, colors=colors).print(table)
    return "".join(f"{line.rstrip()}\n" for line in stream.getvalue().split("\n")[:-1])


def _make_text(cell: Cell) -> Text:
    text, color = cell if isinstance(cell, tuple) else (cell, None)
    return Text(escape_controls(text), style=color or "")
