"""Conversion of a figure to Mermaid, which GitHub and GitLab render in Markdown."""

from __future__ import annotations

from collections.abc import Iterator

from .dot import COLORS
from .figure import Edge, Figure, Node
from .formatting import shorten_name

MAX_EDGES = 500
"""Default of ``maxEdges`` of Mermaid, above which it draws nothing."""

MAX_CHARACTERS = 50_000
"""Default of ``maxTextSize`` of Mermaid, above which it draws nothing."""

_PLAIN = frozenset(" _.,:+-/=×°·…")
_BRACKETS = {
    "link": ('["', '"]'),
    "joint": ('(["', '"])'),
    "sensor": ('>"', '"]'),
    "plugin": ('[["', '"]]'),
    "controller": ('{{"', '"}}'),
    "missing": ('["', '"]'),
}
_LOOKS = {
    "link": "fill:#e9eff6,stroke:#5a6b7d,color:#1b2733",
    "joint": "fill:#fff3d1,stroke:#5a6b7d,color:#1b2733",
    "sensor": "fill:#e7e0f5,stroke:#5a6b7d,color:#1b2733",
    "plugin": "fill:#e4f1e4,stroke:#5a6b7d,color:#1b2733",
    "controller": "fill:#dcefef,stroke:#5a6b7d,color:#1b2733",
    "missing": "fill:#ffffff,stroke:#5a6b7d,color:#1b2733,stroke-dasharray:4",
}


def to_mermaid(figure: Figure) -> str:
    """Convert a figure to a Mermaid flowchart."""
    return "".join(f"{line}\n" for line in _write_lines(figure))


def explain_size(figure: Figure, text: str) -> str:
    """Explain which default limit of Mermaid a figure exceeds; return "" if none."""
    if len(figure.edges) > MAX_EDGES:
        return f"{len(figure.edges)} edges, but Mermaid's default limit (maxEdges) is {MAX_EDGES}"
    if len(text) > MAX_CHARACTERS:
        return (
            f"{len(text)} characters, but Mermaid's default limit (maxTextSize) is {MAX_CHARACTERS}"
        )
    return ""


def label(text: str) -> str:
    """Escape a text for Mermaid: special characters of Mermaid and HTML become character codes."""
    coded = "".join(c if c.isalnum() or c in _PLAIN else f"#{ord(c)};" for c in shorten_name(text))
    return coded.replace("#92;n", "#92;#8288;n")  # an encoded \n is a line break, too


def _write_lines(figure: Figure) -> Iterator[str]:
    numbers = {key: f"n{number}" for number, key in enumerate(figure.nodes)}
    yield "flowchart TB"
    for node in figure.nodes.values():
        begin, end = _BRACKETS[node.kind]
        yield f"  {numbers[node.key]}{begin}{_format_text(node)}{end}:::{node.kind}"
    for edge in figure.edges:
        yield f"  {numbers[edge.tail]} {_format_arrow(edge)} {numbers[edge.head]}"
    for kind in dict.fromkeys(node.kind for node in figure.nodes.values()):
        yield f"  classDef {kind} {_LOOKS[kind]}"
    for node in figure.nodes.values():
        if node.severity is not None:
            color = COLORS[node.severity]
            yield f"  style {numbers[node.key]} stroke:{color},stroke-width:3px,color:{color}"


def _format_text(node: Node) -> str:
    name = label(node.name) if node.name.strip() else "no name"
    lines = [f"+ {member}" for member in node.members] + node.lines
    lines += [mark for mark, _ in node.list_marks()]
    return "<br>".join([name, *map(label, lines)])


def _format_arrow(edge: Edge) -> str:
    if edge.kind == "mimic":
        return '-.->|"mimic"|'
    if edge.kind == "holds":
        return "-.-"
    labels = [f"{name} {text}" for name, text in (("xyz", edge.xyz), ("rpy", edge.rpy)) if text]
    return f'-->|"{"<br>".join(map(label, labels))}"|' if labels else "-->"
