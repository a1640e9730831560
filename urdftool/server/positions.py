"""Positions of the Language Server Protocol: lines, and units of an encoding, both from 0."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Mapping
from typing import Any

from ..source.location import SourceFile

Position = Mapping[str, int]
_LINE_END = re.compile(rb"\r\n|\n|\r")
_BOM = b"\xef\xbb\xbf"


def count_units(text: str, encoding: str) -> int:
    """Return the length of a text in units of ``utf-8``, ``utf-16`` or ``utf-32``."""
    if text.isascii() or encoding == "utf-32":
        return len(text)
    return len(text.encode("utf-8")) if encoding == "utf-8" else len(text.encode("utf-16-le")) // 2


def count_characters(text: str, units: int, encoding: str) -> int:
    """Return how many characters of a text lie before a number of units; all if it is shorter."""
    if text.isascii() or encoding == "utf-32":
        return min(units, len(text))
    number = 0
    for character in text:
        units -= count_units(character, encoding)
        if units < 0:
            break
        number += 1
    return number


class LineTable:
    """Conversion between bytes of a file and positions of an editor.

    A byte order mark is not in the text of an editor.
    """

    def __init__(self, file: SourceFile, encoding: str) -> None:
        """Index the lines of a file.

        Args:
            file: The file.
            encoding: ``utf-8``, ``utf-16`` or ``utf-32``, the unit of a column.
        """
        self.file, self.encoding = file, encoding
        first = len(_BOM) if file.data.startswith(_BOM) else 0
        ends = list(_LINE_END.finditer(file.data))
        self.starts = [first, *(end.end() for end in ends)]
        self.ends = [*(end.start() for end in ends), len(file.data)]

    def _decode(self, start: int, end: int) -> str:
        return self.file.data[start:end].decode(self.file.encoding, "replace")

    def get_position(self, offset: int) -> dict[str, int]:
        """Return the position of a byte; the end of the file for a byte after it."""
        line = max(bisect_right(self.starts, offset) - 1, 0)
        text = self._decode(self.starts[line], min(max(offset, self.starts[line]), self.ends[line]))
        return {"line": line, "character": count_units(text, self.encoding)}

    def get_offset(self, position: Position) -> int:
        """Return the byte of a position; the nearest one for a position outside of the file."""
        if position["line"] >= len(self.starts):
            return len(self.file.data)
        line = max(position["line"], 0)
        text = self._decode(self.starts[line], self.ends[line])
        before = text[: count_characters(text, max(position["character"], 0), self.encoding)]
        return self.starts[line] + len(before.encode(self.file.encoding, "replace"))

    def get_range(self, start: int, end: int) -> dict[str, Any]:
        """Return the range between two bytes."""
        return {"start": self.get_position(start), "end": self.get_position(max(start, end))}

    def get_first_line(self, start: int, end: int) -> dict[str, Any]:
        """Return the range between two bytes, ended on its first line."""
        line = max(bisect_right(self.starts, start) - 1, 0)
        return self.get_range(start, max(start, min(end, self.ends[line])))
