"""Where something was written: a file, bytes in it, and the xacro calls it came through."""

from __future__ import annotations

from bisect import bisect_right
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from .edit import Source


class SourceFile:
    """The bytes of one file, as they are on disk, and the lines in them.

    Attributes:
        path: The path as the user would type it, or ``<stdin>``.
        data: The bytes.
        encoding: The encoding the bytes are in, for counting columns.
    """

    __slots__ = ("_editable", "_starts", "_tags", "data", "encoding", "path")

    def __init__(self, path: str, data: bytes, encoding: str = "utf-8") -> None:
        """Keep the bytes; nothing is computed before it is asked for."""
        self.path = path
        self.data = data
        self.encoding = encoding
        self._starts: list[int] | None = None
        self._tags: dict[int, dict[str, tuple[int, int]]] = {}
        self._editable: Source | None = None

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle the bytes alone, and nothing that was computed from them."""
        return SourceFile, (self.path, self.data, self.encoding)

    @property
    def line_starts(self) -> list[int]:
        """Byte offset at which each line starts."""
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
        """Line and column of a byte, both from 1; the column counts characters."""
        starts = self.line_starts
        line = bisect_right(starts, offset)
        start = starts[line - 1]
        if start == 0 and self.data.startswith(b"\xef\xbb\xbf"):
            start = min(3, offset)
        text = self.data[start:offset]
        return line, len(text.decode(self.encoding, "replace")) + 1

    def line_text(self, line: int) -> str:
        """The text of a line (from 1), without its end."""
        starts = self.line_starts
        if not 1 <= line <= len(starts):
            return ""
        end = starts[line] if line < len(starts) else len(self.data)
        text = self.data[starts[line - 1] : end].decode(self.encoding, "replace")
        return text.rstrip("\r\n").removeprefix("\ufeff")

    def attribute_spans(self, start: int) -> dict[str, tuple[int, int]]:
        """Byte span of each attribute (name to closing quote) of the tag that starts at a byte."""
        spans = self._tags.get(start)
        if spans is None:
            from .tags import attribute_spans

            spans = self._tags[start] = attribute_spans(self.data, start)
        return spans

    def tag_end(self, start: int) -> int:
        """Byte after the ``>`` of the tag that starts at a byte."""
        from .tags import tag_end

        return tag_end(self.data, start)

    def editable(self) -> Source:
        """Parse the file as it is written, macros and all, once.

        Raises:
            SourceError: It is in an encoding that is not edited.
        """
        if self._editable is None:
            from .edit import Source

            self._editable = Source(self)
        return self._editable


class Call(NamedTuple):
    """A xacro macro call or an include that an element came through.

    Attributes:
        file: The file in which the call is written.
        start: Byte at which the calling tag starts.
        macro: The macro's name; empty for an include.
        arguments: The arguments of the call, as they were evaluated.
    """

    file: SourceFile
    start: int
    macro: str
    arguments: tuple[tuple[str, str], ...] = ()

    @property
    def line(self) -> int:
        """Line of the call, from 1."""
        return self.file.position(self.start)[0]

    @property
    def column(self) -> int:
        """Column of the call, from 1."""
        return self.file.position(self.start)[1]

    @property
    def what(self) -> str:
        """The call in words: ``macro 'wheel' prefix=left_`` or ``include``."""
        if not self.macro:
            return "include"
        return " ".join([f"macro '{self.macro}'", *(f"{k}={v}" for k, v in self.arguments)])


class Place(NamedTuple):
    """A span of bytes in a source file, and the calls it came through.

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
        """Path of the file."""
        return self.file.path

    @property
    def line(self) -> int:
        """First line, from 1."""
        return self.file.position(self.start)[0]

    @property
    def column(self) -> int:
        """First column in characters, from 1."""
        return self.file.position(self.start)[1]

    @property
    def end_position(self) -> tuple[int, int]:
        """Line and column after the last character."""
        return self.file.position(self.end)

    def __str__(self) -> str:
        """``FILE:LINE:COLUMN``."""
        line, column = self.file.position(self.start)
        return f"{self.file.path}:{line}:{column}"
