"""Write a graph to a pair of files, one file, or the terminal."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..console import Console
from ..extras import make_missing_error
from ..output import check_targets, write_file, write_result

if TYPE_CHECKING:
    from ..graph.faults import Fault
    from ..graph.figure import Figure
    from ..graph.graphviz import GraphvizWorker
    from ..model.elements import Robot


def write_pair(
    console: Console,
    model: Robot,
    figure: Figure,
    source: str,
    output: str | None,
    artist: GraphvizWorker | None,
) -> None:
    """Write NAME.gv and NAME.pdf, and print the messages of ``urdf_to_graphiz``.

    NAME is the output, the robot's name, or the stem of the source; without an artist there is no
    PDF.

    Raises:
        MissingDependency: pygraphviz is not installed; NAME.gv is written.
    """
    from ..graph.dot import to_dot
    from ..graph.formatting import make_file_name

    stem = "robot" if source == "-" else Path(source).name.partition(".")[0] or "robot"
    name = output or make_file_name(model.name, stem)
    text = to_dot(figure)
    files = {f"{name}.gv": text.encode("utf-8")}
    if artist is not None:
        files[f"{name}.pdf"] = artist.draw(text, "pdf")
    check_targets(tuple(files), inputs=_read(model))
    for path, data in files.items():
        _put(data, path, model)
        if not console.quiet:
            click.echo(f"Created file {path}")
    if artist is None:
        raise make_missing_error("pygraphviz", f"{name}.pdf")


def write_one(
    console: Console,
    model: Robot,
    figure: Figure,
    faults: Sequence[Fault],
    output: str,
    suffix: str,
    artist: GraphvizWorker | None,
) -> None:
    """Write one file of the format of its suffix, or print a tree for ``-``."""
    if suffix == "-":
        from ..report.graph_tree import format_tree_text

        write_result(format_tree_text(model, figure, colors=console.has_colors()), None)
        return
    folder = os.path.dirname(output) or "."
    if suffix == ".json":
        from ..report.graph_json import to_json

        data = to_json(model, figure, faults).encode("utf-8")
    elif suffix == ".mmd":
        from ..graph.mermaid import explain_size, to_mermaid

        text = to_mermaid(figure)
        if explain_size(figure, text):
            console.print_note(
                f"{output}: warning: the graph has {explain_size(figure, text)}; try --fold-fixed"
            )
        data = text.encode("utf-8")
    else:
        from ..graph.dot import to_dot

        linked = suffix == ".svg" or (figure.style == "detailed" and suffix in (".gv", ".dot"))
        text = to_dot(figure, folder if linked else None)
        data = text.encode("utf-8")
        if artist is not None:
            data = artist.draw(text, suffix[1:])
    _put(data, output, model)
    console.print_note(f"Created file {output}")


def _put(data: bytes, target: str, model: Robot) -> None:
    write_file(target, data, inputs=_read(model))


def _read(model: Robot) -> list[str]:
    """Return the source files of the description."""
    return [file.path for file in model.source.files] if model.source is not None else []
