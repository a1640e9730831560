"""Locations in source files: a file, a span of bytes, and the xacro calls that lead to it."""

from __future__ import annotations

from bisect import bisect_right
from typing import NamedTuple


class SourceFile:
    """Bytes of a file as on disk, with its lines.

    Attributes:
        path: Path as the user would type it, or ``<stdin>``.
        data: The bytes.
        encoding: Encoding of the bytes, for counting columns.
        part: Path of one part, such as ``</robot/arm>``, of a file without lines; empty for text.
        editable: The file as :func:`edit.parse_source` parsed it; None before.
        tree: The file as :func:`xacro_parse.parse_xacro` parsed it, without calls; None before.
        document: The file as :func:`document.parse_once` parsed it; None before.
    """

    __slots__ = (
        *("_starts", "_tags", "data", "document", "editable", "encoding", "part", "path", "tree"),
    )

    def __init__(self, path: str, data: bytes, encoding: str = "utf-8", part: str = "") -> None:
        """Store the bytes; derived values are computed on demand."""
        self.part = part
        self.path = path
        self.data = data
        self.encoding = encoding
        self._starts: list[int] | None = None
        self._tags: dict[int, dict[str, tuple[int, int]]] = {}
        self.editable: object = None
        self.document: object = None
        self.tree: object = None

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle the bytes without derived values."""
        return SourceFile, (self.path, self.data, self.encoding, self.part)

    @property
    def line_starts(self) -> list[int]:
        """Return the byte offset of the start of each line."""
        if self._starts is None:
            starts = [0]
            find = self.data.find
            newline = find(b"\n")
            while newline >= 0:
                starts.append(newline + 1)
                newline = find(b"\n", newline + 1)
            self._starts = starts
        return self._starts

    def position(self, offset: int) -> tuple[int, int]:
        """Return line and column of a byte, both from 1; the column counts characters."""
        starts = self.line_starts
        line = bisect_right(starts, offset)
        start = starts[line - 1]
        if start == 0 and self.data.startswith(b"\xef\xbb\xbf"):
            start = min(3, offset)
        text = self.data[start:offset]
        return line, len(text.decode(self.encoding, "replace")) + 1

    def get_line_text(self, line: int) -> str:
        """Return the text of a line (from 1), without its end."""
        starts = self.line_starts
        if not 1 <= line <= len(starts):
            return ""
        end = starts[line] if line < len(starts) else len(self.data)
        text = self.data[starts[line - 1] : end].decode(self.encoding, "replace")
        return text.rstrip("\r\n").removeprefix("\ufeff")

    def locate_attributes(self, start: int) -> dict[str, tuple[int, int]]:
        """Return the byte span (name to closing quote) of each attribute of the tag at a byte."""
        spans = self._tags.get(start)
        if spans is None:
            from .tags import locate_attributes

            spans = self._tags[start] = locate_attributes(self.data, start)
        return spans

    def find_tag_end(self, start: int) -> int:
        """Return the byte after the ``>`` of the tag at a byte."""
        from .tags import find_tag_end

        return find_tag_end(self.data, start)


class Call(NamedTuple):
    """xacro macro call or include that leads to an element."""

    file: SourceFile
    start: int
    macro: str
    arguments: tuple[tuple[str, str], ...] = ()

    @property
    def line(self) -> int:
        """Return the line of the call, from 1."""
        return self.file.position(self.start)[0]

    @property
    def column(self) -> int:
        """Return the column of the call, from 1."""
        return self.file.position(self.start)[1]

    @property
    def what(self) -> str:
        """Return a description of the call: ``macro 'wheel' prefix=left_`` or ``include``."""
        if not self.macro:
            return "include"
        return " ".join([f"macro '{self.macro}'", *(f"{k}={v}" for k, v in self.arguments)])


class Place(NamedTuple):
    """Span of bytes in a source file, and the xacro calls that lead to it.

    Attributes:
        file: The file.
        start: First byte.
        end: Byte after the last.
        calls: Macro calls and includes, innermost first; empty in a plain URDF.
    """

    file: SourceFile
    start: int
    end: int
    calls: tuple[Call, ...] = ()

    @property
    def path(self) -> str:
        """Return the path of the file."""
        return self.file.path

    @property
    def line(self) -> int:
        """Return the first line, from 1."""
        return self.file.position(self.start)[0]

    @property
    def column(self) -> int:
        """Return the first column in characters, from 1."""
        return self.file.position(self.start)[1]

    @property
    def end_position(self) -> tuple[int, int]:
        """Return line and column after the last character."""
        return self.file.position(self.end)

    def __str__(self) -> str:
        """Return ``FILE:LINE:COLUMN``, or file and part."""
        if self.file.part:
            return f"{self.file.path}{self.file.part}"
        line, column = self.file.position(self.start)
        return f"{self.file.path}:{line}:{column}"
