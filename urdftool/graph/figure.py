"""What is drawn: nodes, edges, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from ..finding import Finding, Severity
from ..source.document import Element
from ..source.location import Place


@dataclass(slots=True)
class Node:
    """A link, a joint, or something that hangs on one.

    Attributes:
        key: Tells it from every other node of the figure.
        kind: ``link``, ``joint``, ``sensor``, ``plugin``, ``controller``, or ``missing`` for a link
            that is named and not there.
        name: Its name in the description.
        lines: What a detailed figure says of it, a line each.
        facts: The same as data, in metres, radians and kilograms.
        elements: The XML it stands for: its own element first.
        members: Names of the links that were folded into this one.
        faults: What keeps the robot from being a tree here, in a few words each.
        findings: What lint finds here.
    """

    key: str
    kind: str
    name: str
    lines: list[str] = field(default_factory=list)
    facts: dict[str, Any] = field(default_factory=dict)
    elements: list[Element] = field(default_factory=list)
    members: list[str] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)

    @property
    def place(self) -> Place | None:
        """Where it is written; None for what is not."""
        return self.elements[0].place if self.elements else None

    @property
    def severity(self) -> Severity | None:
        """The worst of what is wrong here; a fault of the tree is an error."""
        if self.faults:
            return Severity.ERROR
        return max((finding.severity for finding in self.findings), default=None)

    def marks(self) -> Iterator[tuple[str, Severity]]:
        """What is wrong here, in a few words each, the worst first."""
        yield from ((fault, Severity.ERROR) for fault in self.faults)
        counts: dict[tuple[Severity, str], int] = {}
        for finding in self.findings:
            key = finding.severity, finding.rule
            counts[key] = counts.get(key, 0) + 1
        for (severity, rule), count in sorted(counts.items(), key=lambda item: -item[0][0]):
            yield f"{severity.label}: {rule}" + (f" (×{count})" if count > 1 else ""), severity


@dataclass(slots=True)
class Edge:
    """A line from one node to another.

    Attributes:
        tail: Key of the node it starts at.
        head: Key of the node it points to.
        kind: ``joint`` within the tree, ``mimic`` from the joint that is followed, ``holds`` to
            what hangs on a link or joint.
        xyz: Place of the joint in the parent's frame [m], as text; empty where it is not said.
        rpy: How it is turned there [rad], as text.
    """

    tail: str
    head: str
    kind: str = "joint"
    xyz: str = ""
    rpy: str = ""


@dataclass(slots=True)
class Figure:
    """A robot as it is drawn.

    Attributes:
        name: The robot's name.
        style: ``ros`` or ``detailed``.
        nodes: By key, in the order they are drawn.
        edges: In the order they are drawn.
        findings: What lint finds that concerns no node.
    """

    name: str
    style: str
    nodes: dict[str, Node] = field(default_factory=dict)
    edges: list[Edge] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)

    def add(self, node: Node) -> Node:
        """Take a node, under a key that no other has."""
        wanted, count = node.key, 1
        while node.key in self.nodes:
            count += 1
            node.key = f"{wanted} ({count})"
        self.nodes[node.key] = node
        return node

    def of_kind(self, *kinds: str) -> Iterator[Node]:
        """The nodes of some kinds."""
        return (node for node in self.nodes.values() if node.kind in kinds)
