"""What a terminal obeys is shown there instead of obeyed.

Names, paths and lines of a file may hold what moves the cursor, sets the title, hides text or
turns its direction. What goes to a terminal passes here, whoever prints it; pipes and files get
results as they are. Colours, and clearing a line, are what urdftool itself says to a terminal.
"""

from __future__ import annotations

import io
import os
import re
import sys
from typing import Any, BinaryIO, cast

_OBEYED = re.compile(
    rb"\x1b\[[0-9;]*m|\r\x1b\[K|\r\n"  # ours, which pass
    rb"|([\0-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xd8\x9c"
    rb"|\xe2\x80[\x8e\x8f\xa8-\xae]|\xe2\x81[\xa6-\xa9])"
)


_CONTROL = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")


def visible(text: str) -> str:
    """A message, which has no colours, with control characters but a line's end written out."""
    return _CONTROL.sub(lambda match: match[0].encode("unicode_escape").decode(), text)


def shown(data: bytes) -> bytes:
    """UTF-8 text with what a terminal would obey written out as its number."""
    return _OBEYED.sub(_written, data)


def _written(match: re.Match[bytes]) -> bytes:
    if match[1] is None:
        return match[0]
    return match[1].decode("utf-8").encode("unicode_escape")


class Shown(io.RawIOBase):
    """The bytes of a stream on their way to a terminal."""

    def __init__(self, stream: BinaryIO) -> None:
        """Take what leads there."""
        super().__init__()
        self.stream = stream

    def writable(self) -> bool:
        """It is."""
        return True

    def isatty(self) -> bool:
        """It leads to one."""
        return True

    def fileno(self) -> int:
        """Of the stream."""
        return self.stream.fileno()

    def write(self, data: bytes) -> int:  # type: ignore[override]
        """Pass on, at once."""
        self.stream.write(shown(bytes(data)))
        self.stream.flush()
        return len(data)


def guard() -> None:
    """Let standard output and standard error pass here, each where it is a terminal."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if isinstance(stream, io.TextIOWrapper) and stream.isatty():
            stream.flush()
            way: Any = io.BufferedWriter(cast(io.RawIOBase, Shown(stream.buffer)))
            text = io.TextIOWrapper(way, stream.encoding, stream.errors, line_buffering=True)
            setattr(sys, name, text)


def open_streams() -> None:
    """Let standard streams that are closed lead nowhere; no file that is opened takes their place.

    Who closed them wants the exit code only.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free: this one
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
    if sys.stdin is None:
        sys.stdin = open(os.devnull, encoding="utf-8")  # noqa: SIM115
