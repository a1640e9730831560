"""DOT text to a picture, by the Graphviz that the wheel of pygraphviz carries.

Graphviz is C that talks to standard error, cannot be told to stop, and may break on a graph and
take its process along. So it works in a child of this process that is forked for it, which costs
a millisecond; where that cannot be had, a large graph is drawn in a Python of its own, which is
this module run as a program.
"""

from __future__ import annotations

import os
import select
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import NoReturn

from ..errors import MissingDependency, UrdftoolError
from ..extras import missing

FORMATS = ("pdf", "svg", "png")
MAX_SECONDS = 45.0

_LARGE = 800  # edges; below, a second is enough
_FAILED, _BROKEN, _MISSING = 2, 3, 4  # exit codes of a process that draws


class DrawError(UrdftoolError):
    """Graphviz could not draw a graph, or not in time."""


def draw(text: str, format: str) -> bytes:
    """A picture of a graph.

    Args:
        text: The graph in DOT.
        format: One of ``FORMATS``.

    Raises:
        DrawError: It takes longer than ``MAX_SECONDS``, or Graphviz breaks on it.
        MissingDependency: pygraphviz is not installed, or not for this machine.
    """
    with Artist() as artist:
        return artist.draw(text, format)


class Artist:
    """Draws one graph, in a fork of this process that gets ready while the graph is made.

    Where it cannot be forked, it is drawn when it is wanted: here, or in a Python of its own.
    """

    def __init__(self) -> None:
        """Fork; the child loads Graphviz and waits for a graph."""
        self._child = 0
        self._source = self._sink = -1
        if sys.platform == "linux" and threading.active_count() == 1:
            asked, self._sink = os.pipe()
            self._source, answer = os.pipe()
            self._child = os.fork()
            if self._child == 0:
                os.close(self._sink)
                os.close(self._source)
                _serve(asked, answer)
            os.close(asked)
            os.close(answer)

    def __enter__(self) -> Artist:
        return self

    def __exit__(self, *_: object) -> None:
        """End the child, if it has not ended."""
        self._hang_up()
        if self._child:
            os.kill(self._child, signal.SIGKILL)
            os.waitpid(self._child, 0)
            self._child = 0

    def draw(self, text: str, format: str) -> bytes:
        """A picture of a graph, once; as :func:`draw`."""
        if not self._child:
            return (_draw_here if text.count(" -> ") < _LARGE else _draw_apart)(text, format)
        end = time.monotonic() + MAX_SECONDS
        self._ask(f"{format}\n{text}".encode())
        data = bytearray()
        while (left := end - time.monotonic()) > 0:
            if not select.select([self._source], [], [], left)[0]:
                break
            piece = os.read(self._source, 1 << 20)
            if not piece:
                status = os.waitstatus_to_exitcode(os.waitpid(self._child, 0)[1])
                self._child = 0
                return _result(bytes(data), status)
            data += piece
        raise _too_slow(text)

    def _ask(self, question: bytes) -> None:
        rest = memoryview(question)
        try:
            while rest:
                rest = rest[os.write(self._sink, rest) :]
        except BrokenPipeError:  # it has ended, and its exit code says why
            pass
        os.close(self._sink)
        self._sink = -1

    def _hang_up(self) -> None:
        for end in (self._source, self._sink):
            if end >= 0:
                os.close(end)
        self._source = self._sink = -1


def _serve(asked: int, answer: int) -> NoReturn:
    """Load Graphviz, read what is to be drawn, draw it, and end this process."""
    try:
        with suppress(Exception), _stderr_kept():
            import pygraphviz  # noqa: F401
        with open(asked, "rb") as stream:
            format, _, text = stream.read().decode("utf-8").partition("\n")
        if format:
            _answer(answer, text, format)
    finally:
        os._exit(_BROKEN)


def _answer(sink: int, text: str, format: str) -> NoReturn:
    """Draw, hand over a picture or the reason why there is none, and end this process."""
    code = _BROKEN
    try:
        try:
            data, code = _draw_here(text, format), 0
        except MissingDependency as error:
            data, code = str(error).encode(), _MISSING
        except UrdftoolError as error:
            data, code = str(error).encode(), _FAILED
        rest = memoryview(data)
        while rest:
            rest = rest[os.write(sink, rest) :]
    finally:
        os._exit(code)


def _result(data: bytes, code: int) -> bytes:
    """The picture that another process has drawn, or its error raised here."""
    if code == 0 and data:
        return data
    if code in (_MISSING, _FAILED):
        message = data.decode("utf-8", "replace").strip()
        if code == _MISSING:
            raise MissingDependency(message, library="pygraphviz")
        raise DrawError(message)
    reason = f"signal {-code}" if code < 0 else f"code {code}"
    raise DrawError(
        f"Graphviz breaks on this graph ({reason}); --fold-fixed makes it smaller, "
        "and .gv, .mmd and .json need no layout"
    )


def _too_slow(text: str) -> DrawError:
    edges = text.count(" -> ")
    return DrawError(
        f"Graphviz has not laid out this graph of {edges} edges in {MAX_SECONDS:g} s, and was "
        "stopped; --fold-fixed makes it smaller, and .gv, .mmd and .json need no layout"
    )


def _draw_here(text: str, format: str) -> bytes:
    with _stderr_kept():
        try:
            from pygraphviz import AGraph
        except ModuleNotFoundError:
            raise MissingDependency(
                f"{missing('pygraphviz', f'a graph as .{format}')}; .gv, .mmd, .json and the tree "
                "at the terminal (-o -) require nothing",
                library="pygraphviz",
            ) from None
        except ImportError as error:
            raise DrawError(f"pygraphviz cannot be loaded on this machine: {error}") from None
        try:
            data = AGraph(string=_labelled(text)).draw(format=format, prog="dot")
        except (ValueError, OSError) as error:
            raise DrawError(f"Graphviz cannot draw this graph: {error}") from error
    if not data:
        raise DrawError(f"Graphviz draws nothing; it has no writer of {format} here")
    return bytes(data)


def _labelled(text: str) -> str:
    """The text with what the ``dot`` command says first: a node is labelled with its name."""
    head, brace, rest = text.partition("{\n")
    return f'{head}{brace}node [label="\\N"];\n{rest}'


@contextmanager
def _stderr_kept() -> Iterator[None]:
    """Keep what C libraries say on standard error: fonts, sizes, versions."""
    sys.stderr.flush()
    try:
        kept = os.dup(2)
    except OSError:  # it is closed
        yield
        return
    with tempfile.TemporaryFile() as said:
        os.dup2(said.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(kept, 2)
            os.close(kept)


def _draw_apart(text: str, format: str) -> bytes:
    """Draw in a Python of its own."""
    import subprocess

    command = [sys.executable, "-m", __name__, format]
    try:
        done = subprocess.run(
            command, input=text.encode("utf-8"), stdout=subprocess.PIPE, timeout=MAX_SECONDS
        )
    except subprocess.TimeoutExpired:
        raise _too_slow(text) from None
    return _result(done.stdout, done.returncode)


if __name__ == "__main__":
    _answer(1, sys.stdin.buffer.read().decode("utf-8"), sys.argv[1])
