"""Comments in the text of a file: found in time linear in its length, also where one has no end."""

from __future__ import annotations

import re
from collections.abc import Iterator


def list_spans(text: bytes, opening: bytes, closing: bytes) -> Iterator[tuple[int, int]]:
    """Yield begin and end of what two marks enclose, with the marks; one without an end is none."""
    at = 0
    while (begin := text.find(opening, at)) >= 0:
        end = text.find(closing, begin + len(opening))
        if end < 0:
            return
        at = end + len(closing)
        yield begin, at


def list_comments(text: bytes) -> Iterator[tuple[int, int]]:
    """Yield begin and end of the comments of an XML file, with their marks."""
    return list_spans(text, b"<!--", b"-->")


def blank_comments(text: bytes) -> bytes:
    """Return an XML file of the same length with blanks in place of its comments."""
    return _blank(text, list_comments(text))


def remove_comments(text: str) -> str:
    """Return an XML file without its comments."""
    data = text.encode("utf-8", "surrogatepass")
    kept, at = [], 0
    for begin, end in list_comments(data):
        kept.append(data[at:begin])
        at = end
    return b"".join((*kept, data[at:])).decode("utf-8", "surrogatepass")


def blank_cmake_comments(text: bytes) -> bytes:
    """Return a CMake file of the same length and lines with blanks in place of its comments."""
    without_blocks = _blank(text, list_spans(text, b"#[[", b"]]"))
    return re.sub(rb"#[^\n]*", lambda found: b" " * len(found[0]), without_blocks)


def _blank(text: bytes, spans: Iterator[tuple[int, int]]) -> bytes:
    parts, at = [], 0
    for begin, end in spans:
        parts += [text[at:begin], _NOT_LINE_END.sub(b" ", text[begin:end])]
        at = end
    return b"".join((*parts, text[at:]))


_NOT_LINE_END = re.compile(rb"[^\n]")
