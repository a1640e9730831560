"""``python -m urdftool.formats.sdf.page PAGE``: update the mapping in its page."""

from __future__ import annotations

import sys
from pathlib import Path

from .mapping import format_mapping

BEGIN, END = "<!-- mapping: begin -->", "<!-- mapping: end -->"


def insert_mapping(page: str) -> str:
    """Return a page with the current mapping between its marks."""
    head, _, rest = page.partition(BEGIN)
    _, _, tail = rest.partition(END)
    return f"{head}{BEGIN}\n\n{format_mapping()}\n\n{END}{tail}"


if __name__ == "__main__":
    place = Path(sys.argv[1])
    place.write_text(insert_mapping(place.read_text("utf-8")), "utf-8")
