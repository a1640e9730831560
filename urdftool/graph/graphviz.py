"""Rendering of DOT text by Graphviz, from the wheel of pygraphviz.

Graphviz prints to standard error, cannot be interrupted, and may crash on a graph, so it runs in an
isolated process.
"""

from __future__ import annotations

from ..errors import MissingDependency, UrdftoolError
from ..extras import make_missing_error
from ..isolated import IsolatedProcess, ProcessDied, ProcessTimeout

FORMATS = ("pdf", "svg", "png")
MAX_SECONDS = 45.0
"""Time [s] after which Graphviz is ended. Chosen, no source."""


class DrawError(UrdftoolError):
    """Graphviz could not draw a graph, or not in time."""


def draw(text: str, format: str) -> bytes:
    """Render a graph in DOT in one of ``FORMATS``.

    Raises:
        DrawError: Rendering takes longer than ``MAX_SECONDS``, or Graphviz crashes.
        MissingDependency: pygraphviz is not installed, or not available for this machine.
    """
    with GraphvizWorker() as artist:
        return artist.draw(text, format)


class GraphvizWorker:
    """Renderer of one graph in an isolated process, which loads Graphviz in advance."""

    def __init__(self) -> None:
        """Start the process."""
        self._process = IsolatedProcess("pygraphviz")

    def __enter__(self) -> GraphvizWorker:
        return self

    def __exit__(self, *_: object) -> None:
        """End the process."""
        self._process.__exit__()

    def draw(self, text: str, format: str) -> bytes:
        """Render a graph, once; see :func:`draw`."""
        try:
            data: bytes = self._process.call(
                __name__, "render", text, format, time_limit=MAX_SECONDS
            )
        except ProcessTimeout:
            edges = text.count(" -> ")
            raise DrawError(
                f"Graphviz did not finish the layout of {edges} edges in {MAX_SECONDS:g} s; "
                "reduce the graph with --fold-fixed, or write .gv, .mmd or .json"
            ) from None
        except ProcessDied as error:
            raise DrawError(
                f"Graphviz crashed on this graph ({error.message}); reduce it with --fold-fixed, "
                "or write .gv, .mmd or .json"
            ) from None
        return data


def render(text: str, format: str) -> bytes:
    """Render a graph in this process; see :func:`draw`."""
    try:
        from pygraphviz import AGraph
    except ModuleNotFoundError:
        raise MissingDependency(
            f"{make_missing_error('pygraphviz', f'a graph as .{format}')}; .gv, .mmd, .json and "
            "'-' do not "
            "require it",
            library="pygraphviz",
        ) from None
    except ImportError as error:
        raise DrawError(f"pygraphviz cannot be loaded on this machine: {error}") from None
    try:
        data = AGraph(string=_add_default_label(text)).draw(format=format, prog="dot")
    except (ValueError, OSError) as error:
        raise DrawError(f"Graphviz cannot draw this graph: {error}") from error
    if not data:
        raise DrawError(f"this installation of Graphviz cannot write {format}")
    return bytes(data)


def _add_default_label(text: str) -> str:
    """Add the default of the ``dot`` command: nodes are labeled with their names."""
    head, brace, rest = text.partition("{\n")
    return f'{head}{brace}node [label="\\N"];\n{rest}'
