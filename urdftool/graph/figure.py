"""Data of a drawn graph: nodes, edges, and their faults and findings."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ..diagnostic import Severity
from ..finding import Finding
from ..source.location import Place

if TYPE_CHECKING:
    from ..model.provenance import Provenance


@dataclass(slots=True)
class Node:
    """A link, a joint, or a part attached to one.

    Attributes:
        key: Unique key in the figure.
        kind: ``link``, ``joint``, ``sensor``, ``plugin``, ``controller``, or ``missing`` for a link
            that is referred to but does not exist.
        name: Name in the description.
        lines: Lines of text in a detailed figure.
        facts: The same information as data, in meters, radians and kilograms.
        elements: Sources of what the node represents, its own first: XML elements of URDF.
        members: Names of the links that were folded into this one.
        faults: Short descriptions of the defects of the tree at this node.
        findings: Lint findings at this node.
    """

    key: str
    kind: str
    name: str
    lines: list[str] = field(default_factory=list)
    facts: dict[str, Any] = field(default_factory=dict)
    elements: list[Provenance] = field(default_factory=list)
    members: list[str] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)

    @property
    def place(self) -> Place | None:
        """Return the location in the source; None without an element."""
        return self.elements[0].place if self.elements else None

    @property
    def severity(self) -> Severity | None:
        """Return the highest severity at this node; a fault of the tree is an error."""
        if self.faults:
            return Severity.ERROR
        return max((finding.severity for finding in self.findings), default=None)

    def list_marks(self) -> Iterator[tuple[str, Severity]]:
        """Yield short texts of faults and findings with their severity, the highest first."""
        yield from ((fault, Severity.ERROR) for fault in self.faults)
        counts: dict[tuple[Severity, str], int] = {}
        for finding in self.findings:
            key = finding.severity, finding.code
            counts[key] = counts.get(key, 0) + 1
        for (severity, rule), count in sorted(counts.items(), key=lambda item: -item[0][0]):
            yield f"{severity.label}: {rule}" + (f" (×{count})" if count > 1 else ""), severity


@dataclass(slots=True)
class Edge:
    """An edge between two nodes.

    Attributes:
        tail: Key of the start node.
        head: Key of the end node.
        kind: ``joint`` within the tree, ``mimic`` from the leading joint, ``holds`` to a part
            attached to a link or joint.
        xyz: Position of the joint in the parent's frame [m], as text; may be empty.
        rpy: Rotation of the joint in the parent's frame [rad], as text; may be empty.
    """

    tail: str
    head: str
    kind: str = "joint"
    xyz: str = ""
    rpy: str = ""


@dataclass(slots=True)
class Figure:
    """A drawn robot.

    Attributes:
        name: Name of the robot.
        style: ``ros`` or ``detailed``.
        nodes: Nodes by key, in drawing order.
        edges: Edges in drawing order.
        findings: Lint findings that concern no node.
    """

    name: str
    style: str
    nodes: dict[str, Node] = field(default_factory=dict)
    edges: list[Edge] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)

    def add(self, node: Node) -> Node:
        """Add a node; change its key if it is taken."""
        base, count = node.key, 1
        while node.key in self.nodes:
            count += 1
            node.key = f"{base} ({count})"
        self.nodes[node.key] = node
        return node

    def list_nodes(self, *kinds: str) -> Iterator[Node]:
        """Return the nodes of some kinds."""
        return (node for node in self.nodes.values() if node.kind in kinds)
