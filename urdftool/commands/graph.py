"""``urdftool graph``: draw the kinematic tree as a picture, a text file or at the terminal."""

from __future__ import annotations

import os
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..console import Console
from .grouped_help import GroupedCommand
from .options import add_package_options, add_robot_argument, make_output_option

if TYPE_CHECKING:
    from ..graph.faults import Fault
    from ..graph.figure import Figure
    from ..model.elements import Robot

TEXTS = (".gv", ".dot", ".mmd", ".json")
PICTURES = (".pdf", ".svg", ".png")


@click.command("graph", cls=GroupedCommand, groups={"Output": "output style fold_fixed linted"})
@add_robot_argument
@make_output_option(
    "Output file: .gv, .dot, .pdf, .svg, .png, .mmd (Mermaid) or .json; '-' prints a tree.  "
    "[default: ROBOT.gv and ROBOT.pdf]"
)
@click.option(
    "--style",
    type=click.Choice(["ros", "detailed"]),
    help="Drawing style: ros as urdf_to_graphiz, or detailed with types, axes, limits, masses, "
    "geometry, sensors and controllers.  [default: ros for .gv, .dot and pictures]",
)
@click.option("--fold-fixed", is_flag=True, help="Draw links with fixed joints as one node.")
@click.option("--lint", "linted", is_flag=True, help="Mark links and joints with lint findings.")
@add_package_options
@click.pass_obj
def command(
    console: Console,
    robot: tuple[str, dict[str, str]],
    output: str | None,
    style: str | None,
    fold_fixed: bool,
    linted: bool,
    package: dict[str, Path],
    package_path: tuple[str, ...],
) -> int:
    """Draw the kinematic tree of the robot IN: its links and joints.

    Without -o, it writes ROBOT.gv and ROBOT.pdf to the current folder, as urdf_to_graphiz does.
    Nodes of an SVG file have a tooltip and a link to their source line.

    \b
        urdftool graph arm.urdf
        urdftool graph arm.urdf.xacro prefix:=left_ -o arm.svg --style detailed --lint
        urdftool graph arm.urdf.xacro -o -

    Exit code 1: the links are not a tree, or --lint finds an error or a warning.
    """  # noqa: D301 -- click reads the escape
    suffix = _get_suffix(output)
    if suffix in (None, "", *PICTURES):
        from ..extras import is_installed, require
        from ..graph.graphviz import GraphvizWorker

        if suffix in PICTURES:
            require(f"a graph as {suffix}", "pygraphviz")
        can_draw = is_installed("pygraphviz")
        artist: AbstractContextManager[GraphvizWorker | None] = (
            GraphvizWorker() if can_draw else nullcontext()
        )
    else:
        artist = nullcontext()
    with artist as pencil:
        from ..graph.faults import find_faults, group_by_message
        from .graph_write import write_one, write_pair
        from .load_tolerant import load_tolerant

        path, arguments = robot
        model = load_tolerant(console, path, arguments, package, package_path)
        faults = list(find_faults(model))
        drawn_style = style or (
            "ros" if suffix in (None, "", ".gv", ".dot", *PICTURES) else "detailed"
        )
        figure = _make_figure(console, model, faults, drawn_style, fold_fixed, linted)
        if suffix in (None, ""):
            write_pair(console, model, figure, path, output, pencil)
        else:
            write_one(console, model, figure, faults, output or "-", suffix, pencil)
    for fault in group_by_message(faults):
        console.print_note(f"{fault.location}: {fault.message}")
    return int(bool(faults) or (linted and _is_marked(figure)))


def _get_suffix(output: str | None) -> str | None:
    """Return the output format; ``-`` for the terminal, empty for the stem of two files."""
    if output is None or output == "-":
        return output
    suffix = os.path.splitext(output)[1].lower()
    if suffix not in ("", *TEXTS, *PICTURES):
        raise click.UsageError(
            f"the suffix of '{output}' is unknown; use {', '.join((*TEXTS, *PICTURES))}"
        )
    return suffix


def _make_figure(
    console: Console, model: Robot, faults: list[Fault], style: str, fold: bool, linted: bool
) -> Figure:
    from ..errors import ModelError
    from ..graph.marks import mark_faults, mark_findings

    if not model.links and not model.joints:
        raise ModelError("the robot has no links; there is nothing to draw", at=model.place)
    if style == "ros":
        from ..graph.ros import make_ros_figure as figure_of
    else:
        from ..graph.detailed import create_detailed_figure as figure_of
    figure = figure_of(model)
    mark_faults(figure, faults)
    if linted:
        from ..api.lint import check

        mark_findings(figure, check(model, config=console.config))
    if fold:
        from ..graph.fold import fold_fixed

        figure = fold_fixed(figure)
    return figure


def _is_marked(figure: Figure) -> bool:
    from ..diagnostic import Severity

    nodes = [finding for node in figure.nodes.values() for finding in node.findings]
    return any(f.severity >= Severity.WARNING for f in (*nodes, *figure.findings))
