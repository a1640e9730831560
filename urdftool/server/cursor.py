"""The place in a document where text is typed: a tag, an attribute, a value or text."""

from __future__ import annotations

import re
from typing import Literal, NamedTuple

from ..errors import SourceError
from ..source.document import Document, Element, parse
from ..source.location import SourceFile
from .actions import find_innermost
from .repair import find_token_end, repair_xml
from .words import WordTable

MOST_BACK = 20_000
"""Bytes before a position in which its tag begins; chosen: a start tag is far shorter."""

_BEFORE = re.compile(
    rb"""<(?P<tag>[^\s<>/"'=!?]*)
    (?:\s+[^\s<>="'/]+\s*=\s*(?:"[^"<]*"|'[^'<]*'))*
    (?:(?P<blank>\s+)(?P<name>[^\s<>="'/]*)
        (?:\s*=\s*(?:"(?P<double>[^"<]*)|'(?P<single>[^'<]*)))?)?\Z""",
    re.VERBOSE,
)
_REST = re.compile(rb"[^<>\r\n]*/?>?")


class Cursor(NamedTuple):
    """Place where text is typed.

    Attributes:
        place: What is typed there.
        element: The element whose tag or text it is, in a tree where that tag is complete.
        attribute: The attribute whose value it is; empty for another place.
        text: What stands before the position: the start of a tag, an attribute or a value.
        start: First byte of ``text`` in the document.
        words: Names of the tree.
    """

    place: Literal["tag", "attribute", "value", "text"]
    element: Element
    attribute: str
    text: str
    start: int
    words: WordTable


def find_cursor(file: SourceFile, offset: int) -> Cursor | None:
    """Return the place of a byte; None in a comment, or where the document is too broken."""
    data = file.data
    if data.rfind(b"<!--", 0, offset) > data.rfind(b"-->", 0, offset):
        return None
    begin = data.rfind(b"<", max(0, offset - MOST_BACK), offset)
    found = _BEFORE.match(data[begin:offset]) if begin >= 0 else None
    if found is None:
        return _find_text(file, begin, offset)
    value = found["double"] if found["double"] is not None else found["single"]
    typed = next((one for one in (value, found["name"], found["tag"]) if one is not None), b"")
    text = _complete(data, begin, offset, found)
    document = _parse(file, text)
    element = None if document is None else find_innermost(document.root, begin)
    if document is None or element is None or element.start != begin:
        return None
    attribute = (found["name"] or b"").decode("utf-8", "replace") if value is not None else ""
    return Cursor(
        "value" if value is not None else "attribute" if found["blank"] else "tag",
        element,
        attribute,
        typed.decode(file.encoding, "replace"),
        offset - len(typed),
        WordTable(document),
    )


def _find_text(file: SourceFile, begin: int, offset: int) -> Cursor | None:
    data = file.data
    tag_end = find_token_end(data, begin) if begin >= 0 else None
    if tag_end is None or tag_end > offset:
        return None
    document = _parse(file, data)
    element = None if document is None else find_innermost(document.root, offset)
    if document is None or element is None:
        return None
    typed = data[tag_end:offset]
    text = typed.decode(file.encoding, "replace")
    return Cursor("text", element, "", text, tag_end, WordTable(document))


def _complete(data: bytes, begin: int, offset: int, found: re.Match[bytes]) -> bytes:
    """Return a document whose tag at a byte is complete, with a letter at the position."""
    if (end := find_token_end(data, begin)) is not None and end > offset:
        in_value = found["double"] is not None or found["single"] is not None
        return data[:offset] + b"x" * in_value + data[offset:]
    head, close = data[:offset], b"/>"
    if found["double"] is not None or found["single"] is not None:
        close = b'x"/>' if found["double"] is not None else b"x'/>"
    elif found["blank"]:
        head = data[: begin + found.start("blank")]
    elif not found["tag"]:
        close = b"x/>"
    rest = _REST.match(data, offset)
    return head + close + data[rest.end() if rest is not None else offset :]


def _parse(file: SourceFile, data: bytes) -> Document | None:
    """Return the tree of a text, repaired if it is not well-formed; None if that fails."""
    for text in (data, repair_xml(data)):
        try:
            return parse(SourceFile(file.path, text, file.encoding))
        except SourceError:
            continue
    return None
