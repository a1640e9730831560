"""The parsed tree, with the place of every element and attribute.

Expat reads the bytes and says at which byte each element starts; nothing else is asked of it, so
that a file of a thousand elements is read in a few milliseconds. Names keep their prefix as it is
written (``xacro:macro``).

Refused in any description: entity declarations (which cover entity bombs and external entities),
nesting deeper than ``MAX_DEPTH`` and files larger than ``MAX_BYTES``.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol
from xml.parsers import expat

from ..errors import SourceError, XmlError
from .location import Call, Place, SourceFile

MAX_BYTES = 32 * 1024 * 1024
MAX_DEPTH = 200
STDIN = "<stdin>"


class Element:
    """One XML element.

    Attributes:
        tag: Its name as written, with its prefix.
        attributes: Attribute values by name.
        children: Child elements, in order.
        parent: The element around it; None for the root.
        text: The text directly inside it, joined.
        file: The file its start tag is written in.
        start: Byte of its ``<`` in that file.
        calls: The xacro calls it came through, innermost first.
    """

    __slots__ = (
        "_close",
        "attributes",
        "calls",
        "children",
        "file",
        "parent",
        "start",
        "tag",
        "text",
    )

    def __init__(
        self,
        tag: str,
        attributes: dict[str, str],
        parent: Element | None,
        file: SourceFile,
        start: int,
        calls: tuple[Call, ...] = (),
    ) -> None:
        """Make an element without children."""
        self.tag = tag
        self.attributes = attributes
        self.parent = parent
        self.file = file
        self.start = start
        self.calls = calls
        self.children: list[Element] = []
        self.text = ""
        self._close = -1

    def __repr__(self) -> str:
        """Tag and place, for debugging."""
        return f"<{self.tag} at {self.place}>"

    def get(self, name: str, default: str | None = None) -> str | None:
        """The value of an attribute, or the default."""
        return self.attributes.get(name, default)

    def child(self, tag: str) -> Element | None:
        """The first child of that name, which is the one that readers of URDF take."""
        for child in self.children:
            if child.tag == tag:
                return child
        return None

    def all(self, tag: str) -> Iterator[Element]:
        """The children of that name."""
        return (child for child in self.children if child.tag == tag)

    def walk(self) -> Iterator[Element]:
        """This element and all below it, in document order."""
        todo = [self]
        while todo:
            element = todo.pop()
            yield element
            todo.extend(reversed(element.children))

    @property
    def place(self) -> Place:
        """The span of its start tag."""
        return Place(self.file, self.start, self.file.tag_end(self.start), self.calls)

    @property
    def end(self) -> int:
        """Byte after its end tag; of its start tag where the end is not known."""
        data = self.file.data
        start_tag_end = self.file.tag_end(self.start)
        if self._close < 0 or data[start_tag_end - 2 : start_tag_end] == b"/>":
            return start_tag_end
        end = data.find(b">", self._close)
        return len(data) if end < 0 else end + 1

    def attribute_place(self, name: str) -> Place:
        """The span of an attribute, name and value; of the start tag if it is not written there."""
        span = self.file.attribute_spans(self.start).get(name)
        return self.place if span is None else Place(self.file, *span, self.calls)


class Comment(NamedTuple):
    """An XML comment: its text, and the bytes from ``<!--`` to ``-->``."""

    text: str
    start: int
    end: int


class Document:
    """A file, its root element and its comments."""

    __slots__ = ("comments", "file", "root")

    def __init__(self, file: SourceFile, root: Element, comments: list[Comment]) -> None:
        """Keep the three."""
        self.file = file
        self.root = root
        self.comments = comments


def read_file(path: str | Path) -> SourceFile:
    """The bytes of a file, or of standard input for ``-``.

    Raises:
        SourceError: It is missing, a folder, unreadable, empty or larger than ``MAX_BYTES``.
    """
    shown = str(path)
    try:
        if shown == "-":
            shown = STDIN
            data = sys.stdin.buffer.read(MAX_BYTES + 1)
        else:
            with open(shown, "rb") as stream:
                data = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise SourceError("no such file", path=shown) from None
    except IsADirectoryError:
        raise SourceError("is a folder; a .urdf or .xacro file is wanted", path=shown) from None
    except PermissionError:
        raise SourceError("may not be read (permission denied)", path=shown) from None
    except (OSError, ValueError) as error:
        raise SourceError(f"cannot be read: {_reason(error)}", path=shown) from None
    if len(data) > MAX_BYTES:
        limit = MAX_BYTES // (1024 * 1024)
        raise SourceError(
            f"is larger than {limit} MiB, which no robot description is; "
            "meshes belong in files of their own",
            path=shown,
            line=1,
        )
    if not data.strip():
        raise SourceError("is empty; a <robot> element is wanted", path=shown, line=1)
    return SourceFile(shown, data)


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)


def parse(file: SourceFile) -> Document:
    """Parse a file.

    Raises:
        XmlError: It is not well-formed, declares entities, or is nested too deep.
    """
    parser = expat.ParserCreate()
    parser.buffer_text = True
    root: Element | None = None
    stack: list[Element] = []
    comments: list[Comment] = []

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal root
        if stack:
            parent = stack[-1]
            element = Element(tag, attributes, parent, file, parser.CurrentByteIndex)
            parent.children.append(element)
        else:
            root = element = Element(tag, attributes, None, file, parser.CurrentByteIndex)
        stack.append(element)
        if len(stack) > MAX_DEPTH:
            raise XmlError(
                f"elements are nested more than {MAX_DEPTH} deep, which no robot description is",
                at=element.place,
            )

    def end(_: str) -> None:
        stack.pop()._close = parser.CurrentByteIndex

    def characters(text: str) -> None:
        if not text.isspace():
            stack[-1].text += text

    def comment(text: str) -> None:
        begin = parser.CurrentByteIndex
        close = file.data.find(b"-->", begin)
        comments.append(Comment(text, begin, len(file.data) if close < 0 else close + 3))

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = characters
    parser.CommentHandler = comment
    run_parser(parser, file, stack)
    assert root is not None  # expat rejects a document without one
    return Document(file, root, comments)


class _Open(Protocol):
    """An element whose end has not been seen: what an error says of it."""

    start: int

    @property
    def tag(self) -> str: ...


def run_parser(parser: Any, file: SourceFile, stack: Sequence[_Open]) -> None:
    """Feed a file to an expat parser, with the refusals that hold for every description.

    Args:
        parser: The parser, its handlers set.
        file: The file.
        stack: The elements that are open, as the handlers keep it.

    Raises:
        XmlError: As :func:`parse`.
    """

    def entity(name: str, *_: object) -> None:
        at = parser.CurrentByteIndex
        raise XmlError(
            f"declares the entity '{name}'; entities are refused in robot descriptions "
            "(write the text itself, or use a xacro property)",
            at=Place(file, at, at),
        )

    def declaration(_: str, encoding: str | None, __: int) -> None:
        if encoding and encoding.lower() not in ("utf-8", "utf8", "us-ascii", "ascii"):
            file.encoding = _codec(encoding)

    parser.EntityDeclHandler = entity
    parser.XmlDeclHandler = declaration
    try:
        parser.Parse(_as_expat_reads(file), True)
    except expat.ExpatError as error:
        offset = min(parser.ErrorByteIndex, len(file.data))
        message, rule = _explain(file, error, offset)
        if stack and "open" in message:
            line = file.position(stack[-1].start)[0]
            message += f" (<{stack[-1].tag}> of line {line} is)"
        raise XmlError(
            message,
            at=Place(file, max(offset, 0), max(offset, 0)),
            rule=rule,
        ) from None
    except (LookupError, UnicodeDecodeError, ValueError) as error:
        raise XmlError(
            f"its text cannot be decoded: {error}; save it as UTF-8", at=Place(file, 0, 0)
        ) from None


def _codec(encoding: str) -> str:
    import codecs

    try:
        return codecs.lookup(encoding).name
    except LookupError:
        return "utf-8"


def _as_expat_reads(file: SourceFile) -> bytes:
    """The bytes; text in UTF-16 or UTF-32 is turned into UTF-8, so that offsets mean characters."""
    for mark, encoding in (
        (b"\xff\xfe\x00\x00", "utf-32"),
        (b"\x00\x00\xfe\xff", "utf-32"),
        (b"\xff\xfe", "utf-16"),
        (b"\xfe\xff", "utf-16"),
    ):
        if file.data.startswith(mark):
            import re

            text = file.data.decode(encoding)
            text = re.sub(r"^(<\?xml[^>]*?)\s+encoding\s*=\s*(\"[^\"]*\"|'[^']*')", r"\1", text)
            file.data = text.encode("utf-8")
            break
    return file.data


def _explain(file: SourceFile, error: expat.ExpatError, offset: int) -> tuple[str, str]:
    """Why expat refused the text and what would be right, in a sentence; and the rule for it."""
    data = file.data
    reason = expat.ErrorString(error.code) or str(error)
    closing = data[offset : data.find(b">", offset)].decode(file.encoding, "replace").strip("</ ")
    if data.startswith(b"version https://git-lfs"):
        return "is a git-lfs pointer, not the file itself; run 'git lfs pull'", "not-well-formed"
    if b"<" not in data[:4096] and offset < 4096:
        return "is not XML; a file that starts with <robot> is wanted", "not-well-formed"
    if (at := data.find(b"<?xml")) > 0 and offset <= at + 5:
        return (
            "something stands before the <?xml …?> declaration, which must be the very first; "
            "move the declaration to the start of the file",
            "content-before-declaration",
        )
    if data.startswith((b"<?xml", b"\xef\xbb\xbf<?xml")) and offset <= data.find(b"?>"):
        reason = f'the XML declaration is wrong ({reason}); <?xml version="1.0"?> is right'
    elif _in_comment(data, offset):
        reason = "a comment holds '--', which XML does not allow; write '- -' or '-'"
    else:
        reason = {
            "mismatched tag": f"</{closing}> closes an element that is not open here",
            "unbound prefix": "a prefix is used that is not declared; for xacro that is "
            'xmlns:xacro="http://www.ros.org/wiki/xacro" on <robot>',
            "no element found": "the file ends while elements are open; is it truncated?",
            "unclosed token": "the file ends within a tag; is it truncated?",
            "junk after document element": "something follows the end of the root element; "
            "one root element is wanted",
            "undefined entity": "there is no such entity; XML has &lt; &gt; &amp; &quot; &apos;",
            "duplicate attribute": "an attribute stands twice in this tag",
        }.get(reason, f"not well-formed XML ({reason})")
    rule = "missing-xmlns" if error.code == _UNBOUND_PREFIX else "not-well-formed"
    return reason, rule


_UNBOUND_PREFIX = 27


def _in_comment(data: bytes, offset: int) -> bool:
    before = data.rfind(b"<!--", 0, offset + 1)
    return before >= 0 and b"-->" not in data[before:offset] and b"--" in data[before + 4 :]


def mend(file: SourceFile) -> SourceFile | None:
    """A file that lax readers take, made readable without moving a byte; None if it cannot be.

    What TinyXML passes over is blanked: a wrong or late ``<?xml …?>`` and ``--`` in comments. It is
    for looking further at a file that has been found not well-formed.
    """
    data = bytearray(file.data)
    at = data.find(b"<?xml")
    end = data.find(b"?>", at)
    if 0 <= at < end:
        data[at : end + 2] = b" " * (end + 2 - at)
    at = data.find(b"<!--")
    while at >= 0:
        end = data.find(b"-->", at + 4)
        if end < 0:
            return None
        inner = bytes(data[at + 4 : end]).replace(b"--", b"  ")
        data[at + 4 : end] = inner.removesuffix(b"-") + b" " if inner.endswith(b"-") else inner
        at = data.find(b"<!--", end)
    return None if data == file.data else SourceFile(file.path, bytes(data), file.encoding)
