"""DOT text to a picture, by the Graphviz that the wheel of pygraphviz carries.

Graphviz is C in this process. It talks to standard error, so that is kept from it; and it cannot
be told to stop, so a large graph is drawn in a process of its own: this module, run by
:func:`draw`, reads the text from its standard input.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager

from ..errors import MissingDependency, UrdftoolError

FORMATS = ("pdf", "svg", "png")
MAX_SECONDS = 45.0

_LARGE = 800  # edges; below, a second is enough


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
    if text.count(" -> ") < _LARGE:
        return _draw_here(text, format)
    return _draw_apart(text, format)


def _draw_here(text: str, format: str) -> bytes:
    with _stderr_kept():
        try:
            from pygraphviz import AGraph
        except ImportError as error:
            raise MissingDependency(
                f"a picture needs pygraphviz ({error}); pip install pygraphviz, "
                "or write .gv, .mmd or .json, which need nothing"
            ) from None
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
    import subprocess

    command = [sys.executable, "-m", __name__, format]
    try:
        done = subprocess.run(
            command, input=text.encode("utf-8"), capture_output=True, timeout=MAX_SECONDS
        )
    except subprocess.TimeoutExpired:
        edges = text.count(" -> ")
        raise DrawError(
            f"Graphviz has not laid out this graph of {edges} edges in {MAX_SECONDS:g} s, and was "
            "stopped; --fold-fixed makes it smaller, and .gv, .mmd and .json need no layout"
        ) from None
    if done.returncode == 0 and done.stdout:
        return done.stdout
    said = done.stderr.decode("utf-8", "replace").strip().splitlines()
    if done.returncode == 4:
        raise MissingDependency(said[-1])
    reason = f"it was ended by signal {-done.returncode}" if done.returncode < 0 else said[-1:]
    raise DrawError(
        f"Graphviz breaks on this graph ({reason}); --fold-fixed makes it smaller, "
        "and .gv, .mmd and .json need no layout"
    )


def _main() -> int:
    try:
        data = _draw_here(sys.stdin.buffer.read().decode("utf-8"), sys.argv[1])
    except UrdftoolError as error:
        sys.stderr.write(f"{error}\n")
        return 4 if isinstance(error, MissingDependency) else 2
    sys.stdout.buffer.write(data)
    return 0


if __name__ == "__main__":
    raise SystemExit(_main())
