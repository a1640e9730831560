"""Formatting of one file, with the check that it is the same XML afterwards."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import zip_longest
from typing import Any
from xml.parsers import expat

from ..errors import SourceError
from ..source.location import SourceFile
from ..source.well_formed import WIDE, run_parser
from .layout import format_xml


@dataclass
class Formatted:
    """Bytes of a file before and after."""

    path: str
    before: bytes
    after: bytes

    @property
    def is_changed(self) -> bool:
        """Tell whether the bytes differ."""
        return self.before != self.after

    @property
    def first_line(self) -> int:
        """Return the number of the first line that differs, from 1; 0 if none does."""
        lines = zip_longest(self.before.split(b"\n"), self.after.split(b"\n"))
        return next((n for n, (one, other) in enumerate(lines, 1) if one != other), 0)


def format_file(file: SourceFile) -> Formatted:
    """Return a file with its layout.

    Raises:
        XmlError: The file is not well-formed, or declares entities.
        SourceError: It is in UTF-16 or UTF-32.
        RuntimeError: The result would not be the same XML.
    """
    if any(file.data.startswith(start) for start, _ in WIDE):
        raise SourceError("is UTF-16 or UTF-32; save it as UTF-8", path=file.path)
    before = list_events(file)
    data = format_xml(file.data)
    if data != file.data and list_events(SourceFile(file.path, data)) != before:
        raise RuntimeError(f"{file.path}: its format would change the XML")
    return Formatted(file.path, file.data, data)


Event = tuple[Any, ...]


def list_events(file: SourceFile) -> list[Event]:
    """Return what a parser reads: tags with attributes, comments, instructions and texts.

    White space next to a tag is one event, ``blank`` or ``line``: how much it is does not matter,
    but xacro counts line ends in front of comments, so that a blank line is a third, ``blank
    line``. Attributes keep their order.

    Raises:
        XmlError: The file is not well-formed.
    """
    events: list[Event] = []
    stack: list[_Open] = []
    parser: Any = expat.ParserCreate()

    def start(tag: str, attributes: list[str]) -> None:
        events.append(("start", tag, *attributes))
        stack.append(_Open(tag, parser.CurrentByteIndex))

    def end(tag: str) -> None:
        events.append(("end", tag))
        stack.pop()

    parser.ordered_attributes = True
    parser.buffer_text = True
    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CommentHandler = lambda text: events.append(("comment", text))
    parser.ProcessingInstructionHandler = lambda *parts: events.append(("instruction", *parts))
    parser.CharacterDataHandler = lambda text: events.append(_describe(text))
    run_parser(parser, file, stack)
    return [event for event in events if event != ("blank",)]


class _Open:
    """An element whose end tag has not been read."""

    __slots__ = ("start", "tag")

    def __init__(self, tag: str, start: int) -> None:
        """Store the name and the byte."""
        self.tag = tag
        self.start = start


def _describe(text: str) -> Event:
    """Return the event of a text; line breaks of white space count up to a blank line."""
    if text.strip(" \t\r\n"):
        return "text", text
    return ("blank line",) if text.count("\n") > 1 else ("blank",)
