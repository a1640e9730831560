"""Byte-exact edits of source text.

An edit replaces a span of bytes. Bytes outside the spans are unchanged: comments, order,
whitespace, line ends and a byte order mark. Inserted text gets the indentation and the line ends of
its surroundings.

Elements to edit must come from :func:`parse_source`, since the end of an element moved by xacro is
unknown.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import NamedTuple

from ..errors import SourceError
from .document import Document, Element, parse
from .escape import escape, unescape
from .location import SourceFile
from .tags import locate_value

_BLANK = re.compile(rb"[ \t]*")
_REST_OF_LINE = re.compile(rb"(?:[ \t]|<!--(?:(?!--)[^\n])*-->)*(?=\r?\n)")
_QUOTES = {"&quot;": '"', "&apos;": "'"}


class Edit(NamedTuple):
    """Replacement of the bytes from ``start`` to ``end``; an insertion if both are equal."""

    start: int
    end: int
    text: bytes


class Source:
    """Editable file: its bytes, and its elements by the byte of their start."""

    def __init__(self, file: SourceFile) -> None:
        """Parse the file as written, without expansion.

        Raises:
            SourceError: The text was re-encoded for reading, so that its offsets are not offsets in
                the file.
        """
        self.file = file
        data = file.data
        self.document: Document = parse(file)
        if file.data != data or file.encoding.startswith(("utf-16", "utf-32")):
            raise SourceError("cannot be edited in this encoding; save it as UTF-8", path=file.path)
        self.elements: dict[int, Element] = {e.start: e for e in self.document.root.walk()}
        self._inner: dict[int, bytes | None] = {}
        self.line_end = b"\r\n" if b"\r\n" in data else b"\n"

    def get_indentation(self, element: Element) -> bytes | None:
        """Return the whitespace before an element; None if other text precedes it on its line."""
        data, start = self.file.data, element.start
        while start and data[start - 1] in b" \t":
            start -= 1
        return data[start : element.start] if not start or data[start - 1] in b"\n" else None

    def get_inner_indentation(self, element: Element) -> bytes | None:
        """Return the whitespace before the children of an element; None if it is on one line."""
        if element.start not in self._inner:
            self._inner[element.start] = self._find_inner_indentation(element)
        return self._inner[element.start]

    def _find_inner_indentation(self, element: Element) -> bytes | None:
        own = self.get_indentation(element)
        for child in element.children:
            inner = self.get_indentation(child)
            if inner is not None:
                return inner
        if own is None or element.children:
            return None
        return own + self.step

    @cached_property
    def step(self) -> bytes:
        """Return the indentation of one level in this file."""
        for element in self.elements.values():
            inner, outer = self.get_indentation(element), None
            if element.parent is not None:
                outer = self.get_indentation(element.parent)
            if inner is not None and outer is not None and len(inner) > len(outer):
                return inner[len(outer) :] if inner.startswith(outer) else inner
        return b"  "


def parse_source(file: SourceFile) -> Source:
    """Parse a file once, as written, without expansion.

    Raises:
        SourceError: Its encoding is not supported for edits.
    """
    if not isinstance(file.editable, Source):
        file.editable = Source(file)
    return file.editable


def read_literal(element: Element, name: str) -> str | None:
    """Return the value of an attribute as written, with references resolved; None if absent."""
    span = element.file.locate_attributes(element.start).get(name)
    if span is None:
        return None
    start, end = locate_value(element.file.data, span)
    return unescape(element.file.data[start:end].decode(element.file.encoding), _QUOTES)


def set_attribute(source: Source, element: Element, name: str, value: str) -> Edit:
    """Return the edit that sets an attribute, appended if it is not written."""
    data = source.file.data
    spans = source.file.locate_attributes(element.start)
    if name in spans:
        start, end = locate_value(data, spans[name])
        return Edit(start, end, _get_attribute_bytes(value, data[start - 1 : start]))
    at = max((end for _, end in spans.values()), default=element.start + 1 + len(element.tag))
    return Edit(at, at, f' {name}="'.encode() + _get_attribute_bytes(value, b'"') + b'"')


def _get_attribute_bytes(value: str, quote: bytes) -> bytes:
    entities = {'"': "&quot;"} if quote == b'"' else {"'": "&apos;"}
    return escape(value, entities).encode("ascii", "xmlcharrefreplace")


def insert_child(
    source: Source, parent: Element, lines: Sequence[str], *, after: Element | None = None
) -> Edit:
    """Return the edit that inserts an element as the first child or after a child.

    If the children are on separate lines, the new one is too, and only whole lines are added; if
    the parent is on one line, the element is inserted on that line.

    Args:
        source: The file.
        parent: Element to insert into.
        lines: Lines of the new element, indented by one tab for each level.
        after: The preceding child; None inserts before all children.
    """
    data = source.file.data
    inner = source.get_inner_indentation(parent)
    tag_end = source.file.find_tag_end(parent.start)
    closed = data[tag_end - 2 : tag_end] == b"/>"
    if inner is None:
        text = "".join(line.strip("\t") for line in lines).encode("ascii")
    else:
        shown = [line.encode("ascii") for line in lines]
        step = _step_within(source, parent, inner)
        text = b"".join(
            source.line_end + inner + step * (len(line) - len(line.lstrip(b"\t"))) + line.lstrip()
            for line in shown
        )
    if closed:
        own = source.get_indentation(parent) or b""
        tail = b"" if inner is None else source.line_end + own
        begin = len(data[: tag_end - 2].rstrip())
        return Edit(begin, tag_end, b">" + text + tail + f"</{parent.tag}>".encode())
    at = tag_end if after is None else after.end
    if inner is not None:
        rest = _REST_OF_LINE.match(data, at)
        if rest is None and after is None and not parent.children:
            own = source.get_indentation(parent) or b""
            blank = _BLANK.match(data, at)
            end = blank.end() if blank else at
            if data.startswith(b"</", end):
                return Edit(at, end, text + source.line_end + own)
        # a comment at the end of the line belongs to the element before it
        at = rest.end() if rest else at
    return Edit(at, at, text)


def replace_element(source: Source, element: Element, blocks: Sequence[Sequence[str]]) -> Edit:
    """Return the edit that replaces an element by other elements.

    Args:
        source: The file.
        element: Element to replace.
        blocks: Lines of each new element, indented by one tab for each level.
    """
    own = source.get_indentation(element)
    step = source.step
    parts = []
    for lines in blocks:
        shown = [line.encode("ascii", "xmlcharrefreplace") for line in lines]
        if own is None:
            parts.append(b"".join(line.lstrip(b"\t") for line in shown))
            continue
        deep = [step * (len(line) - len(line.lstrip(b"\t"))) + line.lstrip(b"\t") for line in shown]
        parts.append((source.line_end + own).join(deep))
    between = b"" if own is None else source.line_end + own
    return Edit(element.start, element.end, between.join(parts))


def remove_element(source: Source, element: Element) -> Edit:
    """Return the edit that removes an element, with its line if nothing else is on it."""
    data = source.file.data
    start, end = element.start, element.end
    own = source.get_indentation(element)
    rest = re.compile(rb"[ \t]*\r?\n").match(data, end)
    if own is not None and rest is not None:
        return Edit(start - len(own), rest.end(), b"")
    return Edit(start, end, b"")


def _step_within(source: Source, parent: Element, inner: bytes) -> bytes:
    own = source.get_indentation(parent)
    if own is not None and inner.startswith(own) and len(inner) > len(own):
        return inner[len(own) :]
    return source.step


def apply(file: SourceFile, edits: Iterable[Edit]) -> bytes:
    """Return the bytes of a file with edits applied; insertions at one place keep their order.

    Raises:
        ValueError: Two edits overlap.
    """
    parts: list[bytes] = []
    position = 0
    for edit in sorted(edits, key=lambda e: (e.start, e.end)):
        if edit.start < position:
            raise ValueError(f"edits overlap at byte {edit.start} of {file.path}")
        parts += [file.data[position : edit.start], edit.text]
        position = edit.end
    return b"".join([*parts, file.data[position:]])
