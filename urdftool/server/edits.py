"""Edits of documents."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..diagnostic import Replacement
from ..source.location import SourceFile
from .knowledge import Knowledge, make_path
from .moves import count_common

Edits = dict[str, list[dict[str, Any]]]
"""Edits of the protocol by path of the document."""


def make_edit(knowledge: Knowledge, file: SourceFile, after: bytes) -> dict[str, Any]:
    """Return the edit of one range, between the common start and end of two contents."""
    before = file.data
    most = min(len(before), len(after))
    head = count_common(before, after, most)
    tail = count_common(before[::-1], after[::-1], most - head)
    head, tail = _shorten_common(before, after, head, tail)
    return {
        "range": knowledge.make_table(file).get_range(head, len(before) - tail),
        "newText": after[head : len(after) - tail].decode(file.encoding, "replace"),
    }


def _shorten_common(before: bytes, after: bytes, head: int, tail: int) -> tuple[int, int]:
    """Return lengths of a common start and end that cut no character and no line end."""
    while head and (_is_inside(before, head) or _is_inside(after, head)):
        head -= 1
    while tail and (_is_inside(before, len(before) - tail) or _is_inside(after, len(after) - tail)):
        tail -= 1
    return head, tail


def _is_inside(data: bytes, offset: int) -> bool:
    """Tell whether a byte continues a character of UTF-8, or a line end of two bytes."""
    if offset >= len(data):
        return False
    return data[offset] & 0xC0 == 0x80 or data[offset - 1 : offset + 1] == b"\r\n"


def convert_replacements(knowledge: Knowledge, replacements: Iterable[Replacement]) -> Edits:
    """Return the edits of a fix."""
    edits: Edits = {}
    for replacement in replacements:
        place = replacement.place
        table = knowledge.make_table(place.file)
        edit = {"range": table.get_range(place.start, place.end), "newText": replacement.text}
        edits.setdefault(make_path(place.path), []).append(edit)
    return edits
