"""Spans of attributes in a start tag.

Expat reports only the byte at which a tag starts. Tags get here after expat has accepted them, so
a short scanner suffices: names, ``=``, quoted values.
"""

from __future__ import annotations

import re

_ATTRIBUTE = re.compile(rb"""\s*([^\s=<>/"']+)\s*=\s*("[^"]*"|'[^']*')""")
_TAG_NAME = re.compile(rb"<[^\s<>/]+")


def locate_attributes(data: bytes, start: int) -> dict[str, tuple[int, int]]:
    """Return byte spans ``(start of the name, byte after the closing quote)`` by attribute name.

    Args:
        data: Bytes of the file.
        start: Byte of the ``<`` of the tag.
    """
    spans: dict[str, tuple[int, int]] = {}
    name = _TAG_NAME.match(data, start)
    if name is None:
        return spans
    position = name.end()
    while match := _ATTRIBUTE.match(data, position):
        spans[match[1].decode("utf-8", "replace")] = match.span(1)[0], match.end()
        position = match.end()
    return spans


def locate_value(data: bytes, span: tuple[int, int]) -> tuple[int, int]:
    """Return the span of the value between its quotes, for a span of :func:`locate_attributes`."""
    match = _ATTRIBUTE.match(data, span[0])
    if match is None:
        return span
    return match.start(2) + 1, match.end(2) - 1


def find_tag_end(data: bytes, start: int) -> int:
    """Return the byte after the ``>`` that ends the tag starting at ``start``."""
    name = _TAG_NAME.match(data, start)
    position = name.end() if name else start
    while match := _ATTRIBUTE.match(data, position):
        position = match.end()
    end = data.find(b">", position)
    return len(data) if end < 0 else end + 1
