"""Plant every change and write what was found: ``python -m tests.planted [--write]``."""

from __future__ import annotations

import sys
from pathlib import Path

from .measure import CHANGES, Found, measure

PAGE = Path(__file__).resolve().parents[2] / "docs" / "verify.md"

HEAD = """\
# What `--verify` finds

With `--verify`, `urdftool export sdf` and `export mjcf` compare with the description what they
wrote. Here each change below was planted in the written text of a
[robot with everything](https://github.com/urdftool/urdftool/tree/main/fixtures/formats/everything)
in it, one at a time. A change counts as found where the row that is about it differs; other rows
may differ too. Without a change no row differs.

Written by `python -m tests.planted --write`; `tests/formats/test_planted.py` repeats it.
"""

TITLES = {"mjcf": "MJCF", "sdf": "SDF"}
TABLES = {
    "mjcf": "The rows are those of [`export mjcf --verify`](formats/mjcf.md#verify).",
    "sdf": "The rows are those of [`export sdf --verify`](formats/sdf.md#verify).",
}


def page() -> str:
    """Return the page."""
    results = {form: measure(form) for form in CHANGES}
    lines = [HEAD, "| format | changes | found in their row | found in another | not found |"]
    lines.append("|---|---|---|---|---|")
    for form, found in results.items():
        right = sum(one.is_right for one in found)
        wrong = sum(bool(one.rows) and not one.is_right for one in found)
        lost = len(found) - right - wrong
        lines.append(f"| {TITLES[form]} | {len(found)} | {right} | {wrong} | {lost} |")
    for form, found in results.items():
        lines += ["", f"## {TITLES[form]}", "", TABLES[form], ""]
        lines += ["| change | row | found | other rows that differ |", "|---|---|---|---|"]
        lines += [_line(one) for one in found]
    return "\n".join(lines) + "\n"


def _line(one: Found) -> str:
    others = ", ".join(row for row in one.rows if row != one.planted.row)
    found = "yes" if one.is_right else "**no**"
    return f"| {one.planted.what} | {one.planted.row} | {found} | {others} |".replace("|  |", "| |")


if __name__ == "__main__":
    text = page()
    if "--write" in sys.argv[1:]:
        PAGE.write_text(text, "utf-8")
    else:
        print(text)
