"""Movement of ranges by the edits of a text, for findings of the text before."""

from __future__ import annotations

import re
from typing import NamedTuple, TypeVar

from .positions import count_units

T = TypeVar("T", str, bytes)
Point = tuple[int, int]
"""Line and column, from 0."""

_LINE_END = re.compile(r"\r\n|\n|\r")


class TextChange(NamedTuple):
    """Replacement of a range of a text.

    Attributes:
        start: First position that is replaced.
        end: Position after the last.
        new_end: Position after the new text.
    """

    start: Point
    end: Point
    new_end: Point

    def move(self, point: Point) -> Point:
        """Return where a position is afterwards; the start of the change for one inside of it."""
        if point <= self.start:
            return point
        if point < self.end:
            return self.start
        column = point[1]
        if point[0] == self.end[0]:
            column += self.new_end[1] - self.end[1]
        return point[0] + self.new_end[0] - self.end[0], column

    def is_around(self, start: Point, end: Point) -> bool:
        """Tell whether all text of a range is replaced."""
        return start < end and self.start <= start and end <= self.end


def make_change(start: Point, end: Point, text: str, encoding: str) -> TextChange:
    """Return the change that replaces a range by a text."""
    lines = _LINE_END.split(text)
    column = count_units(lines[-1], encoding) + (start[1] if len(lines) == 1 else 0)
    return TextChange(start, end, (start[0] + len(lines) - 1, column))


def compare_texts(before: str, after: str, encoding: str) -> TextChange:
    """Return one change that makes a text of another: between the common start and end."""
    most = min(len(before), len(after))
    head = count_common(before, after, most)
    tail = count_common(before[::-1], after[::-1], most - head)
    start = _find_point(before, head, encoding)
    end = _find_point(before, len(before) - tail, encoding)
    return make_change(start, end, after[head : len(after) - tail], encoding)


def count_common(one: T, other: T, most: int) -> int:
    """Return the length of the common start of two texts, at most ``most``."""
    low, high = 0, most
    while low < high:
        middle = (low + high + 1) // 2
        if one[low:middle] == other[low:middle]:
            low = middle
        else:
            high = middle - 1
    return low


def _find_point(text: str, offset: int, encoding: str) -> Point:
    lines = _LINE_END.split(text[:offset])
    return len(lines) - 1, count_units(lines[-1], encoding)
