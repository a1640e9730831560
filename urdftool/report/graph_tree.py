"""A figure as a tree for the terminal, by rich."""

from __future__ import annotations

import io
from collections.abc import Iterator

from rich.text import Text
from rich.tree import Tree

from ..diagnostic import Severity
from ..graph.figure import Figure, Node
from ..graph.formatting import shorten_name
from ..model.elements import Robot
from .tables import WIDEST, create_text_console

_STYLES = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.INFO: "blue"}
_DEEPEST = 40  # levels of the tree that are indented


def format_tree_text(robot: Robot, figure: Figure, *, colors: bool = False, width: int = 80) -> str:
    """Format each root with its subtree, one line for each joint and its link.

    Args:
        robot: The robot.
        figure: The robot as a detailed figure.
        colors: Whether to color the text.
        width: Columns of the terminal; longer lines wrap.
    """
    stream = io.StringIO()
    console = create_text_console(stream, colors=colors, width=max(width, 40) if colors else WIDEST)
    title = Text(shorten_name(robot.name) or "no name", style="bold")
    for finding in figure.findings:
        title.append(f"  {finding.severity.label}: {finding.code}", _STYLES[finding.severity])
    console.print(title, soft_wrap=True)
    for tree in _list_trees(figure):
        console.print(tree, soft_wrap=True)
    lines = (line.rstrip() for line in stream.getvalue().splitlines())
    return "".join(f"{line}\n" for line in lines)


def _list_trees(figure: Figure) -> Iterator[Tree]:
    """Yield a tree for each root; a branch that is too deep continues in a separate tree."""
    below, child_of = _get_below(figure)
    hanging = {key for keys in below.values() for key in keys} | set(child_of.values())
    starts = [*(key for key in figure.nodes if key not in hanging), *figure.nodes]
    starts.reverse()
    seen: set[str] = set()
    while starts:
        start = starts.pop()
        if start in seen:
            continue
        seen.add(start)
        tree = Tree(_make_line(figure.nodes[start]), guide_style="dim")
        todo = [(tree, key, 1) for key in reversed(below.get(start, ()))]
        deeper: list[str] = []
        while todo:
            branch, key, depth = todo.pop()
            line = _make_line(figure.nodes[key])
            end = child_of.get(key, key)
            if end != key:
                seen.add(key)
                line.append(" → ", "dim").append_text(_make_line(figure.nodes[end]))
            if end in seen:
                branch.add(line.append(" (shown elsewhere)", "dim"))
            elif depth >= _DEEPEST:
                branch.add(line.append(" (goes on below)", "dim"))
                deeper.append(end)
            else:
                seen.add(end)
                twig = branch.add(line)
                held = below.get(key, []) if end != key else []
                todo.extend((twig, k, depth + 1) for k in reversed(held + below.get(end, [])))
        starts.extend(reversed(deeper))
        yield tree


def _get_below(figure: Figure) -> tuple[dict[str, list[str]], dict[str, str]]:
    """Return the nodes attached to each node, and separately the child link of each joint."""
    below: dict[str, list[str]] = {}
    child_of: dict[str, str] = {}
    for edge in figure.edges:
        if edge.kind == "joint" and figure.nodes[edge.tail].kind == "joint":
            child_of[edge.tail] = edge.head
        elif edge.kind != "mimic":
            below.setdefault(edge.tail, []).append(edge.head)
    return below, child_of


def _make_line(node: Node) -> Text:
    style = {"link": "bold", "joint": "cyan", "missing": "red"}.get(node.kind, "magenta")
    line = Text(shorten_name(node.name) or "no name", style=style)
    for member in node.members:
        line.append(f" + {shorten_name(member)}", "bold")
    if node.lines:
        line.append(f"  {', '.join(map(shorten_name, node.lines))}", "dim")
    for mark, severity in node.list_marks():
        line.append(f"  ! {mark}", _STYLES[severity])
    return line
