"""A figure as JSON; the schema is ``docs/schemas/graph.json``."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..finding import Finding
from ..graph.faults import Fault
from ..graph.figure import Edge, Figure, Node
from ..model.elements import Robot
from ..source.location import Place
from .json_text import format_json


def to_json(robot: Robot, figure: Figure, faults: Iterable[Fault]) -> str:
    """Format nodes, edges, and defects of the tree as one object."""
    graph = {
        "version": 1,
        "name": robot.name,
        "nodes": [_build_node(node) for node in figure.nodes.values()],
        "edges": [_build_edge(edge) for edge in figure.edges],
        "faults": [{"message": fault.message, **_build_where(fault.location)} for fault in faults],
        "findings": [_build_finding(finding) for finding in figure.findings],
    }
    return format_json(graph, 1) + "\n"


def _build_node(node: Node) -> dict[str, Any]:
    return {
        "key": node.key,
        "kind": node.kind,
        "name": node.name,
        **_build_where(node.place),
        "folded": node.members,
        "facts": node.facts,
        "faults": node.faults,
        "findings": [_build_finding(finding) for finding in node.findings],
    }


def _build_edge(edge: Edge) -> dict[str, Any]:
    return {"from": edge.tail, "to": edge.head, "kind": edge.kind}


def _build_finding(finding: Finding) -> dict[str, Any]:
    return {
        "rule": finding.code,
        "severity": finding.severity.label,
        "message": finding.message,
        **_build_where(finding.location),
    }


def _build_where(place: Place | None) -> dict[str, Any]:
    if place is None:
        return {"path": None, "line": None, "column": None}
    line, column = place.file.position(place.start)
    return {"path": place.path, "line": line, "column": column}
