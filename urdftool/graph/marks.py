"""Faults and lint findings at the nodes they concern."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from operator import itemgetter

from ..finding import Finding
from ..source.document import Element
from ..source.location import Call, Place
from .faults import Fault
from .figure import Figure, Node


def mark_faults(figure: Figure, faults: Iterable[Fault]) -> None:
    """Add the defects of the tree to their nodes."""
    # a link without a name shares its joint's element, and the fault belongs to the joint
    nodes = sorted(figure.nodes.values(), key=lambda node: node.kind != "missing")
    by_element = {id(element): node for node in nodes for element in node.elements[:1]}
    for fault in faults:
        node = by_element.get(id(fault.part.provenance))
        if node is not None and fault.mark not in node.faults:
            node.faults.append(fault.mark)


def mark_findings(figure: Figure, findings: Iterable[Finding]) -> None:
    """Add findings to the nodes they concern, or to the figure if they concern none.

    A finding belongs to the link or joint that it names, else to the node whose XML contains it. A
    finding with several macro instances marks the node of each instance.
    """
    named: dict[tuple[str, str], list[Node]] = {}
    for node in figure.nodes.values():
        named.setdefault((node.kind, node.name), []).append(node)
    owners = _Owners(figure)
    for finding in findings:
        place = finding.location
        found: dict[str, Node] = {}
        for name, calls in ((finding.name, place.calls), *finding.others):
            nodes = named.get((finding.kind, name), []) if name else []
            owner = owners.find_node(place, calls)
            if owner is not None and (owner in nodes or not nodes):
                nodes = [owner]
            found.update((node.key, node) for node in nodes)
        for node in found.values():
            node.findings.append(finding)
        if not found:
            figure.findings.append(finding)


class _Owners:
    """Index of the node to which the bytes of a file belong, for each macro expansion."""

    def __init__(self, figure: Figure) -> None:
        self._starts: dict[tuple[str, tuple[Call, ...]], list[tuple[int, Node]]] = {}
        for node in figure.nodes.values():
            for element in (e for e in node.elements if isinstance(e, Element)):
                for inner in element.walk():
                    key = inner.file.path, inner.calls
                    self._starts.setdefault(key, []).append((inner.start, node))
        for starts in self._starts.values():
            starts.sort(key=itemgetter(0))

    def find_node(self, place: Place, calls: tuple[Call, ...]) -> Node | None:
        """Return the node whose XML has a tag at a place."""
        starts = self._starts.get((place.file.path, calls), [])
        index = bisect_right(starts, place.start, key=itemgetter(0)) - 1
        if index < 0:
            return None
        start, node = starts[index]
        return node if place.start < place.file.find_tag_end(start) else None
