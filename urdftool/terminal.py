"""Escape control characters in text that goes to a terminal.

Names, paths and lines of a file may contain sequences that move the cursor, set the title, hide
text or change its direction. Terminal output passes through :class:`SanitizingStream`; pipes and
files get results unchanged. Color codes and clearing a line are kept, since urdftool writes them.
"""

from __future__ import annotations

import io
import os
import re
import sys
from typing import Any, BinaryIO, cast

_OBEYED = re.compile(
    rb"\x1b\[[0-9;]*m|\r\x1b\[K|\r\n"  # written by urdftool, kept
    rb"|([\0-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xd8\x9c"
    rb"|\xe2\x80[\x8e\x8f\xa8-\xae]|\xe2\x81[\xa6-\xa9])"
)


_CONTROL = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")


def escape_controls(text: str) -> str:
    """Return a message with all control characters escaped except tab and line feed."""
    return _CONTROL.sub(lambda match: match[0].encode("unicode_escape").decode(), text)


def escape_bytes(data: bytes) -> bytes:
    """Return UTF-8 text with control characters escaped, except those that urdftool writes."""
    return _OBEYED.sub(_escape_match, data)


def _escape_match(match: re.Match[bytes]) -> bytes:
    if match[1] is None:
        return match[0]
    return match[1].decode("utf-8").encode("unicode_escape")


class SanitizingStream(io.RawIOBase):
    """Stream that escapes control characters on the way to a terminal."""

    def __init__(self, stream: BinaryIO) -> None:
        """Wrap a binary stream of a terminal."""
        super().__init__()
        self.stream = stream

    def writable(self) -> bool:
        """Return True."""
        return True

    def isatty(self) -> bool:
        """Return True."""
        return True

    def fileno(self) -> int:
        """Return the file descriptor of the wrapped stream."""
        return self.stream.fileno()

    def write(self, data: bytes) -> int:  # type: ignore[override]
        """Write escaped bytes and flush; return the number of bytes given."""
        self.stream.write(escape_bytes(bytes(data)))
        self.stream.flush()
        return len(data)


def install() -> None:
    """Route standard output and standard error through :class:`SanitizingStream` on terminals."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if isinstance(stream, io.TextIOWrapper) and stream.isatty():
            stream.flush()
            way: Any = io.BufferedWriter(cast(io.RawIOBase, SanitizingStream(stream.buffer)))
            text = io.TextIOWrapper(way, stream.encoding, stream.errors, line_buffering=True)
            setattr(sys, name, text)


def open_streams() -> None:
    """Redirect closed standard streams to the null device.

    Otherwise a file opened later would get their descriptor.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest free descriptor: this one
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
    if sys.stdin is None:
        sys.stdin = open(os.devnull, encoding="utf-8")  # noqa: SIM115
