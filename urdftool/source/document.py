"""XML tree with the location of every element and attribute.

Expat parses the bytes and reports the byte at which each element starts; attribute spans are
computed on demand, so that a file of a thousand elements is read in a few milliseconds. Names keep
their prefix as written (``xacro:macro``).

Rejected: files larger than ``MAX_BYTES``, and everything that ``well_formed`` rejects.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple
from xml.parsers import expat

from ..dependencies import read_stamp
from ..errors import AccessError, SourceError, XmlError
from ..file_access import AccessRefused
from ..memo import Memo
from ..projects import explain_link_out
from ..workspace import STDIN as STDIN
from ..workspace import Workspace
from .description_formats import find_by_head
from .location import Call, Place, SourceFile
from .well_formed import MAX_DEPTH, run_parser

MAX_BYTES = 32 * 1024 * 1024
"""Of a file of a description; chosen, no source: the largest of 219 real ones has 142 kB."""

MAX_STAGE_BYTES = 1024 * 1024 * 1024
"""Limit of a stage of USD, which contains its meshes."""


class Element:
    """XML element.

    Attributes:
        tag: Name as written, with its prefix.
        attributes: Attribute values by name.
        children: Child elements, in order.
        parent: Enclosing element; None for the root.
        text: Text directly inside the element, joined.
        file: File that contains the start tag.
        start: Byte of the ``<`` in that file.
        calls: xacro calls and includes that lead to the element, innermost first.
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
        """Create an element without children."""
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
        """Return tag and place, for debugging."""
        return f"<{self.tag} at {self.place}>"

    def get(self, name: str, default: str | None = None) -> str | None:
        """Return the value of an attribute, or the default."""
        return self.attributes.get(name, default)

    def find_child(self, tag: str) -> Element | None:
        """Return the first child with a tag, which URDF readers use; None if there is none."""
        for child in self.children:
            if child.tag == tag:
                return child
        return None

    def list_children(self, tag: str) -> Iterator[Element]:
        """Return the children with a tag."""
        return (child for child in self.children if child.tag == tag)

    def describe(self) -> str:
        """Return kind and name of the nearest element with a name, from this one up; or its tag."""
        named: Element | None = self
        while named is not None and "name" not in named.attributes:
            named = named.parent
        return f"{named.tag} '{named.get('name')}'" if named is not None else self.tag

    def walk(self) -> Iterator[Element]:
        """Yield this element and its descendants, in document order."""
        todo = [self]
        while todo:
            element = todo.pop()
            yield element
            if element.children:
                todo += element.children[::-1]

    @property
    def place(self) -> Place:
        """Return the span of the start tag."""
        return Place(self.file, self.start, self.file.find_tag_end(self.start), self.calls)

    @property
    def end(self) -> int:
        """Return the byte after the end tag; after the start tag if the end is unknown."""
        data = self.file.data
        start_tag_end = self.file.find_tag_end(self.start)
        if self._close < 0 or data[start_tag_end - 2 : start_tag_end] == b"/>":
            return start_tag_end
        end = data.find(b">", self._close)
        return len(data) if end < 0 else end + 1

    def locate_attribute(self, name: str) -> Place:
        """Return the span of an attribute, name and value; of the start tag if it is absent."""
        span = self.file.locate_attributes(self.start).get(name)
        return self.place if span is None else Place(self.file, *span, self.calls)


class Comment(NamedTuple):
    """XML comment: its text, and the span from ``<!--`` to ``-->``."""

    text: str
    start: int
    end: int


class Document:
    """File, root element and comments, which do not change.

    Attributes:
        file: The file.
        root: Its root element.
        comments: Its comments.
        memo: Values computed once for it.
    """

    __slots__ = ("comments", "file", "memo", "root")

    def __init__(self, file: SourceFile, root: Element, comments: list[Comment]) -> None:
        """Create a document of its parts."""
        self.file = file
        self.root = root
        self.comments = comments
        self.memo = Memo()

    @property
    def elements(self) -> list[Element]:
        """Return all elements in document order, collected once."""
        return self.memo.get("elements", lambda: list(self.root.walk()))

    @property
    def elements_by_tag(self) -> dict[str, list[Element]]:
        """Return all elements in document order by tag, collected once."""
        return self.memo.get("by tag", self._sort_elements)

    def _sort_elements(self) -> dict[str, list[Element]]:
        found: dict[str, list[Element]] = {}
        for element in self.elements:
            found.setdefault(element.tag, []).append(element)
        return found


def read_file(path: str | Path, workspace: Workspace | None = None) -> SourceFile:
    """Read a file, or standard input for ``-``.

    Raises:
        AccessError: The workspace may not read it.
        SourceError: It is missing, a folder, unreadable, empty or larger than ``MAX_BYTES``, or
            ``MAX_STAGE_BYTES`` for USD.
    """
    shown = str(path)
    named = STDIN if shown == "-" else shown
    workspace = workspace or Workspace()
    copy = workspace.get_overlay(named)
    if copy is not None:
        workspace.record("file", named)
        return SourceFile(named, copy)
    outside = explain_link_out(shown, workspace.restrict(None), of_repository=True)
    if outside and named != STDIN:
        raise AccessError(f"is not read: it {outside}, or pass --trust", path=shown)
    try:
        if shown == "-":
            shown = STDIN
            data, limit = _read_bounded(sys.stdin.buffer)
        else:
            with workspace.open(shown, is_named=True) as stream:
                data, limit = _read_bounded(stream)
    except FileNotFoundError:
        raise SourceError("no such file", path=shown) from None
    except IsADirectoryError:
        raise SourceError("is a folder, not a description", path=shown) from None
    except AccessRefused as error:
        raise AccessError(error.strerror or "", path=shown) from None
    except PermissionError:
        raise SourceError("cannot be read: permission denied", path=shown) from None
    except (OSError, ValueError) as error:
        raise SourceError(f"cannot be read: {_get_reason(error)}", path=shown) from None
    if len(data) > limit:
        raise SourceError(
            f"is larger than {limit // (1024 * 1024)} MiB, the limit of a robot description; "
            "move meshes to separate files",
            path=shown,
            line=1,
        )
    if not data.strip():
        raise SourceError("is empty; a description requires a <robot> element", path=shown, line=1)
    return SourceFile(shown, data)


def _read_bounded(stream: BinaryIO) -> tuple[bytes, int]:
    """Return at most one byte more than the limit of a description, and the limit."""
    data = stream.read(MAX_BYTES + 1)
    if find_by_head(data) is None:
        return data, MAX_BYTES
    return data + stream.read(MAX_STAGE_BYTES + 1 - len(data)), MAX_STAGE_BYTES


def _get_reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)


def read_included_file(path: str, workspace: Workspace) -> SourceFile:
    """Read a file as :func:`read_file`, once until it changes on the disk.

    Files that robots share, and those that an editor does not change, are read and parsed once.

    Raises:
        SourceError: It cannot be read.
    """
    stamp = read_stamp(("file", path)) if workspace.get_overlay(path) is None else None
    if stamp is None:
        return read_file(path, workspace)
    key = read_included_file, path, stamp
    return workspace.memoize(key, lambda inner: read_file(path, inner))


def parse_once(file: SourceFile) -> Document:
    """Parse a file as :func:`parse`; the tree is kept with the file, and must not be changed.

    Raises:
        XmlError: It is not well-formed, declares entities, or is nested too deeply.
    """
    if not isinstance(file.document, Document):
        file.document = parse(file)
    return file.document


def parse(file: SourceFile) -> Document:
    """Parse a file.

    Raises:
        XmlError: It is not well-formed, declares entities, or is nested too deeply.
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
                f"elements are nested more than {MAX_DEPTH} deep, the limit of a robot description",
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
