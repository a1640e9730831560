"""A figure as a tree for the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import click

from ..control_characters import escape_controls
from ..diagnostic import Severity
from ..graph.figure import Figure, Node
from ..graph.formatting import shorten_name
from ..model.elements import Robot

_COLORS = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.INFO: "blue"}
_COLORS_OF_KINDS = {"joint": "cyan", "missing": "red"}
_OTHER = "magenta"
"""Color of nodes that are neither links nor joints."""
_DEEPEST = 40  # levels of the tree that are indented; chosen


@dataclass
class _Branch:
    """A line of the tree, and the lines below it."""

    parts: list[_Part]
    below: list[_Branch] = field(default_factory=list)

    def add(self, parts: list[_Part]) -> _Branch:
        """Add a line below this one, and return it."""
        branch = _Branch(parts)
        self.below.append(branch)
        return branch


_Part = tuple[str, str]
"""A text, and a color, ``bold`` or ``dim``; empty for none."""


def format_tree_text(robot: Robot, figure: Figure, *, colors: bool = False) -> str:
    """Format each root with its subtree, one line for each joint and its link."""
    title = [(shorten_name(robot.name) or "no name", "bold")]
    for finding in figure.findings:
        text = f"  {finding.severity.label}: {finding.code}"
        title.append((text, _COLORS[finding.severity]))
    lines = [title]
    for tree in _list_trees(figure):
        lines += _list_lines(tree)
    texts = (
        "".join(_paint(*part) if colors else escape_controls(part[0]) for part in line)
        for line in lines
    )
    return "".join(f"{text.rstrip()}\n" for text in texts)


def _list_lines(branch: _Branch, lead: str = "") -> Iterator[list[_Part]]:
    """Yield the lines of a tree of at most ``_DEEPEST`` levels, each with its guides."""
    yield branch.parts
    for number, below in enumerate(branch.below, 1):
        is_last = number == len(branch.below)
        guide, more = ("└── ", "    ") if is_last else ("├── ", "│   ")
        first, *others = _list_lines(below, lead + more)
        yield [(lead + guide, "dim"), *first]
        yield from others


def _paint(text: str, style: str) -> str:
    shown = escape_controls(text)
    if style in ("bold", "dim"):
        return click.style(shown, bold=style == "bold" or None, dim=style == "dim" or None)
    return click.style(shown, fg=style or None)


def _list_trees(figure: Figure) -> Iterator[_Branch]:
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
        tree = _Branch(_make_line(figure.nodes[start]))
        todo = [(tree, key, 1) for key in reversed(below.get(start, ()))]
        deeper: list[str] = []
        while todo:
            branch, key, depth = todo.pop()
            line = _make_line(figure.nodes[key])
            end = child_of.get(key, key)
            if end != key:
                seen.add(key)
                line += [(" → ", "dim"), *_make_line(figure.nodes[end])]
            if end in seen:
                branch.add([*line, (" (shown elsewhere)", "dim")])
            elif depth >= _DEEPEST:
                branch.add([*line, (" (goes on below)", "dim")])
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


def _make_line(node: Node) -> list[_Part]:
    """Return the texts of a node: its name, members, properties and findings."""
    style = "bold" if node.kind == "link" else _COLORS_OF_KINDS.get(node.kind, _OTHER)
    line = [(shorten_name(node.name) or "no name", style)]
    line += [(f" + {shorten_name(member)}", "bold") for member in node.members]
    if node.lines:
        line.append((f"  {', '.join(map(shorten_name, node.lines))}", "dim"))
    line += [(f"  ! {mark}", _COLORS[severity]) for mark, severity in node.list_marks()]
    return line
