"""Conversion of a figure to DOT, the language of Graphviz.

Names are untrusted data: each is quoted and escaped for Graphviz, or escaped for XML in an
HTML-like label.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator

from ..control_characters import escape_controls
from ..diagnostic import Severity
from .figure import Edge, Figure, Node
from .formatting import shorten_name

COLORS = {Severity.ERROR: "#c0271b", Severity.WARNING: "#c77700", Severity.INFO: "#2f6fb5"}

_ENTITY = re.compile(r"&(?=#?\w+;)")
_FILLS = {
    "link": "#e9eff6",
    "joint": "#fff3d1",
    "sensor": "#e7e0f5",
    "plugin": "#e4f1e4",
    "controller": "#dcefef",
    "missing": "#ffffff",
}
_FIXED = "#ededed"
_SHAPES = {"joint": "box", "plugin": "note", "controller": "component", "sensor": "tab"}
_MOST_MEMBERS = 8
"""Number of links that a node names. Chosen, no source."""


def to_dot(figure: Figure, folder: str | None = None) -> str:
    """Convert a figure to DOT text.

    Args:
        figure: The figure; in style ``ros``, the text is that of ``urdf_to_graphiz``, with
            additional attributes only for faults, findings, tooltips and links.
        folder: Folder of the output file, from which links to the source are relative; None for
            neither tooltips nor links.
    """
    lines = _write_ros(figure, folder) if figure.style == "ros" else _write_detailed(figure, folder)
    return "".join(f"{line}\n" for line in lines)


def quote_text(text: str) -> str:
    """Quote a text so that Graphviz shows it literally, without escapes or entities."""
    text = escape_controls(text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{_ENTITY.sub("&amp;", text)}"'


def _join_lines(lines: list[str]) -> str:
    """Join the lines of a label or tooltip in one pair of quotes.

    Empty lines are dropped, as Graphviz sometimes fails on them.
    """
    return '"' + "\\n".join(quote_text(line)[1:-1] for line in lines if line) + '"'


def _write_ros(figure: Figure, folder: str | None) -> Iterator[str]:
    yield "digraph G {"
    yield from _write_caption(figure)
    yield "node [shape=box];"
    for node in figure.list_nodes("link"):
        yield (
            f"{quote_text(node.key)} "
            f"[label={_make_ros_label(node)}{_make_ros_attributes(node, folder)}];"
        )
    yield "node [shape=ellipse, color=blue, fontcolor=blue];"
    for node in figure.list_nodes("joint", "missing"):
        more = _make_ros_attributes(node, folder)
        label = _make_ros_label(node)
        if more or label != f'"{node.key}"':
            yield f"{quote_text(node.key)} [label={label}{more}];"
    for edge in figure.edges:
        label = f' [label="xyz: {edge.xyz} \\nrpy: {edge.rpy}"]' if edge.xyz else ""
        yield f"{quote_text(edge.tail)} -> {quote_text(edge.head)}{label}"
    yield "}"


def _make_ros_label(node: Node) -> str:
    return _join_lines(
        [node.name or "(no name)", *_list_members(node), *(mark for mark, _ in node.list_marks())]
    )


def _make_ros_attributes(node: Node, folder: str | None) -> str:
    found = {}
    if node.severity is not None:
        color = COLORS[node.severity]
        found = {"color": f'"{color}"', "fontcolor": f'"{color}"', "penwidth": "2"}
    found |= _make_links(node, folder)
    return "".join(f", {name}={value}" for name, value in found.items())


def _write_detailed(figure: Figure, folder: str | None) -> Iterator[str]:
    yield f"digraph {quote_text(figure.name)} {{"
    yield from _write_caption(figure)
    yield 'graph [fontname="Helvetica", nodesep=0.25, ranksep=0.35];'
    yield 'node [fontname="Helvetica", fontsize=12, shape=box, style=filled, color="#5a6b7d"];'
    yield 'edge [fontname="Helvetica", fontsize=9, fontcolor="#5a6b7d", color="#5a6b7d"];'
    for node in figure.nodes.values():
        attributes = {
            "label": f"<{_format_html(node)}>",
            **_look(node),
            **_make_links(node, folder),
        }
        texts = ", ".join(f"{name}={value}" for name, value in attributes.items())
        yield f"{quote_text(node.key)} [{texts}];"
    for edge in figure.edges:
        yield f"{quote_text(edge.tail)} -> {quote_text(edge.head)}{_format_edge(edge)};"
    yield "}"


def _write_caption(figure: Figure) -> Iterator[str]:
    """Yield a caption with the findings that concern no node."""
    if figure.findings:
        texts = list(dict.fromkeys(f"{f.severity.label}: {f.code}" for f in figure.findings))
        color = COLORS[max(finding.severity for finding in figure.findings)]
        label = _join_lines([shorten_name(figure.name), *texts])
        yield f'graph [label={label}, fontcolor="{color}"];'


def _list_members(node: Node) -> list[str]:
    more = len(node.members) - _MOST_MEMBERS
    names = [f"+ {shorten_name(name)}" for name in node.members]
    return [*names[: _MOST_MEMBERS - 1], f"+ {more + 1} more"] if more > 0 else names


def _format_html(node: Node) -> str:
    """Format a node as an HTML-like label: name in bold, small lines, faults and findings."""
    name = _escape_html(shorten_name(node.name))
    rows = [f"<B>{name}</B>" if name.strip() else "<I>no name</I>"]
    small = [_escape_html(shorten_name(line)) for line in (*_list_members(node), *node.lines)]
    if small:
        rows.append(f'<FONT POINT-SIZE="10">{"<BR/>".join(small)}</FONT>')
    marks = [
        f'<FONT POINT-SIZE="10" COLOR="{COLORS[severity]}"><B>{_escape_html(mark)}</B></FONT>'
        for mark, severity in node.list_marks()
    ]
    if marks:
        rows.append("<BR/>".join(marks))
    cells = "".join(f"<TR><TD>{row}</TD></TR>" for row in rows)
    return f'<TABLE BORDER="0" CELLSPACING="0" CELLPADDING="1">{cells}</TABLE>'


def _escape_html(text: str) -> str:
    """Escape a text for an HTML-like label, where Graphviz also interprets backslashes."""
    for plain, written in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ("\\", "\\\\")):
        text = text.replace(plain, written)
    return text


def _look(node: Node) -> dict[str, str]:
    fixed = node.facts.get("type") == "fixed"
    look = {"fillcolor": f'"{_FIXED if node.kind == "joint" and fixed else _FILLS[node.kind]}"'}
    if node.kind in _SHAPES:
        look["shape"] = _SHAPES[node.kind]
    if node.kind == "joint":
        look["style"] = '"filled,rounded"'
    if node.kind == "missing":
        look["style"] = '"filled,dashed"'
    if node.severity is not None:
        look |= {"color": f'"{COLORS[node.severity]}"', "penwidth": "2.5"}
    return look


def _format_edge(edge: Edge) -> str:
    if edge.kind == "mimic":
        return ' [style=dashed, constraint=false, label="mimic"]'
    if edge.kind == "holds":
        return " [style=dotted, arrowhead=none]"
    lines = [f"{name} {text}" for name, text in (("xyz", edge.xyz), ("rpy", edge.rpy)) if text]
    return f" [label={_join_lines([f'  {line}' for line in lines])}]" if lines else ""


def _make_links(node: Node, folder: str | None) -> dict[str, str]:
    """Return a tooltip with all faults and findings, and a link to the source of the node."""
    if folder is None:
        return {}
    from urllib.parse import quote  # half as slow as all other imports

    place = node.place
    lines = [f"{node.kind} {node.name}", *node.lines, *node.faults]
    lines += [f"{f.severity.label}: {f.message} [{f.code}]" for f in node.findings]
    links = {}
    if place is not None:
        lines.insert(1, f"{place.path}:{place.line}")
        if not place.path.startswith("<"):
            path = os.path.relpath(os.path.abspath(place.path), os.path.abspath(folder))
            links["URL"] = f'"{quote(path.replace(os.sep, "/"))}#L{place.line}"'
    # Graphviz resolves the escapes of a tooltip twice
    links["tooltip"] = _join_lines(
        [line.replace("\\", "\\\\") for line in map(escape_controls, lines)]
    )
    return links
