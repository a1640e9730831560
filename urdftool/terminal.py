"""Escape control characters in text that goes to a terminal.

Names, paths and lines of a file may contain sequences that move the cursor, set the title, hide
text or change its direction. Terminal output passes through :class:`SanitizingStream`; pipes and
files get results unchanged. Kept are the colors and the clearing of a line that urdftool writes.
"""

from __future__ import annotations

import codecs
import io
import os
import re
import sys
from typing import Any, BinaryIO, cast

from .control_characters import LINES, escape_controls

_COLOR = r"\x1b\[(?:(?:[0-3]|3[1-6]|9[0-7])(?:;(?:[0-3]|3[1-6]|9[0-7]))*)?m"
_OURS = {
    "stdout": re.compile(rf"({_COLOR}|\r\n)"),
    "stderr": re.compile(rf"({_COLOR}|\r\n|\r\x1b\[K)"),
}
"""Written by urdftool, by stream: bold, dim, italic and the colors of text; on standard error also
the start of a line of progress. Not concealed or blinking text, and no color of the background.
"""

_UNFINISHED = re.compile(r"(?:\r(?:\x1b\[?)?|\x1b(?:\[[0-9;]{0,16})?)\Z")


def escape_text(text: str, name: str = "stdout") -> str:
    """Return a text with control characters escaped, except those that urdftool writes.

    Args:
        text: The text.
        name: Stream for which it is meant: ``stdout`` or ``stderr``.
    """
    if text.isprintable():
        return text
    parts = _OURS[name].split(text)
    parts[::2] = [escape_controls(part, LINES) for part in parts[::2]]
    return "".join(parts)


class SanitizingStream(io.RawIOBase):
    """Stream that escapes control characters on the way to a terminal.

    A character or sequence that is cut by the end of a write is completed by the next one.
    """

    def __init__(self, stream: BinaryIO, name: str = "stdout", encoding: str = "utf-8") -> None:
        """Wrap the binary stream of a name in an encoding; what is written here is UTF-8."""
        super().__init__()
        self.stream, self.encoding = stream, encoding
        self._name = name
        self._decoder = codecs.getincrementaldecoder("utf-8")("surrogateescape")
        self._rest = ""

    def writable(self) -> bool:
        """Return True."""
        return True

    def isatty(self) -> bool:
        """Tell whether the wrapped stream is a terminal."""
        return self.stream.isatty()

    def fileno(self) -> int:
        """Return the file descriptor of the wrapped stream."""
        return self.stream.fileno()

    def write(self, data: bytes) -> int:  # type: ignore[override]
        """Write escaped bytes and flush; return the number of bytes given."""
        text = self._rest + self._decoder.decode(bytes(data))
        cut = _UNFINISHED.search(text)
        end = len(text) if cut is None else cut.start()
        self._rest = text[end:]
        self._write(text[:end])
        return len(data)

    def close(self) -> None:
        """Write what an end of the output left incomplete."""
        if not self.closed:
            rest = self._rest + self._decoder.decode(b"", final=True)
            self._rest = ""
            if rest:  # at the end of Python 3.13 the names of modules may be cleared
                self._write(rest)
        super().close()

    def _write(self, text: str) -> None:
        self.stream.write(escape_text(text, self._name).encode(self.encoding, "backslashreplace"))
        self.stream.flush()


def install() -> None:
    """Route standard error, and standard output on a terminal, through :class:`SanitizingStream`.

    A character that the encoding of standard output lacks is escaped there, too.
    """
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if not isinstance(stream, io.TextIOWrapper):
            continue
        stream.reconfigure(errors="backslashreplace")
        # on Windows click translates colors for the console, which needs the stream of Python
        if sys.platform == "win32" or (name == "stdout" and not stream.isatty()):
            continue
        if stream is not getattr(sys, f"__{name}__"):  # the null device, or that of a caller
            continue
        stream.flush()
        way: Any = SanitizingStream(stream.buffer, name, stream.encoding)
        raw = io.BufferedWriter(cast(io.RawIOBase, way))
        text = io.TextIOWrapper(raw, "utf-8", "backslashreplace", line_buffering=True)
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
