"""Equality of two texts as XML."""

from __future__ import annotations

from typing import Any
from xml.parsers import expat

from ..source.location import SourceFile
from ..source.well_formed import run_parser

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
