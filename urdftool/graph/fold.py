"""Folding of rigid bodies: links that fixed joints connect become one node."""

from __future__ import annotations

from .figure import Figure, Node
from .formatting import number


def fold_fixed(figure: Figure) -> Figure:
    """Fold the fixed joints of a figure.

    Findings move to the node of the rigid body. Fixed joints at a fault of the tree are not folded.
    """
    above = {edge.head: edge.tail for edge in figure.edges if edge.kind == "joint"}
    below = {edge.tail: edge.head for edge in figure.edges if edge.kind == "joint"}
    into: dict[str, str] = {}
    for joint in figure.list_nodes("joint"):
        parent, child = above.get(joint.key, ""), below.get(joint.key, "")
        ends = figure.nodes.get(parent), figure.nodes.get(child)
        sound = all(node is not None and node.kind == "link" and not node.faults for node in ends)
        if joint.facts.get("type") == "fixed" and sound and not joint.faults:
            into[joint.key] = into[child] = parent
    folded = Figure(figure.name, figure.style, findings=list(figure.findings))
    for key, node in figure.nodes.items():
        if key not in into:
            folded.nodes[key] = node
        else:
            _take(figure.nodes[_find_top(into, key)], node)
    for edge in figure.edges:
        edge.tail, edge.head = _find_top(into, edge.tail), _find_top(into, edge.head)
        if edge.tail != edge.head:
            folded.edges.append(edge)
    return folded


def _find_top(into: dict[str, str], key: str) -> str:
    while key in into:
        key = into[key]
    return key


def _take(body: Node, node: Node) -> None:
    """Move the data of a folded node to the node of its rigid body."""
    body.findings += node.findings
    body.elements += node.elements
    if node.kind == "joint":
        return
    body.members.append(node.name)
    mass = node.facts.get("mass")
    if mass is not None:
        total = (body.facts.get("mass") or 0.0) + mass
        body.facts["mass"] = total
        weighed = f"{number(total)} kg"
        if body.lines and (body.lines[0].endswith(" kg") or body.lines[0] in ("frame", "no mass")):
            body.lines[0] = weighed
    for kind in ("visuals", "collisions"):
        if kind in body.facts:
            body.facts[kind] = [*body.facts[kind], *node.facts.get(kind, ())]
