"""Half-typed XML made well-formed, with every byte that stays at its offset."""

from __future__ import annotations

import re

_TOKEN = re.compile(
    rb"""<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>|<!DOCTYPE[^\[>]*(?:\[.*?\]\s*)?>
    |</(?P<end>[^\s<>/"'=]+)\s*>
    |<(?P<start>[^\s<>/"'=!?]+)(?:\s+[^\s<>/"'=]+\s*=\s*(?:"[^"<]*"|'[^'<]*'))*\s*(?P<empty>/?)>""",
    re.DOTALL | re.VERBOSE,
)
_HALF = re.compile(rb"<[^<>\r\n]*>?")
_REFERENCE = re.compile(rb"&(?!#\d+;|#x[\da-fA-F]+;|(?:amp|lt|gt|quot|apos);)")


def repair_xml(data: bytes) -> bytes:
    """Return XML with blanks in place of tags that are half-typed or have no partner.

    Elements without an end at the end of the text get their end tags there.

    Args:
        data: Bytes of an encoding in which ASCII has its own bytes.
    """
    blanked = bytearray(_REFERENCE.sub(b" ", data))
    opened: list[tuple[bytes, int, int]] = []
    position = 0
    for token in _TOKEN.finditer(data):
        _blank_half(blanked, position, token.start())
        position = token.end()
        if token["start"] is not None and not token["empty"]:
            opened.append((token["start"], *token.span()))
        elif token["end"] is not None:
            _close(blanked, opened, token["end"], token.span())
    _blank_half(blanked, position, len(data))
    return bytes(blanked) + b"".join(b"</%s>" % name for name, _, _ in reversed(opened))


def _blank_half(data: bytearray, start: int, end: int) -> None:
    """Blank what begins like a tag between two tokens."""
    for half in _HALF.finditer(bytes(data[start:end])):
        _blank(data, start + half.start(), start + half.end())


def _close(
    data: bytearray, opened: list[tuple[bytes, int, int]], name: bytes, span: tuple[int, int]
) -> None:
    """Close an element, and blank the tags that have no partner."""
    if all(known != name for known, _, _ in opened):
        _blank(data, *span)
        return
    while opened:
        known, start, end = opened.pop()
        if known == name:
            return
        _blank(data, start, end)


def _blank(data: bytearray, start: int, end: int) -> None:
    for index in range(start, end):
        if data[index] not in b"\r\n":
            data[index] = 0x20


def find_token_end(data: bytes, start: int) -> int | None:
    """Return the byte after the tag or comment at a byte; None if it is half-typed."""
    token = _TOKEN.match(data, start)
    return None if token is None else token.end()
