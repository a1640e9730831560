"""The two nodes that a joint is drawn between, also where a link of it is not there."""

from __future__ import annotations

from ..model.elements import Joint
from .figure import Figure, Node


def ends(figure: Figure, joint: Joint, keys: dict[str, str]) -> tuple[str, str]:
    """Keys of the parent's and the child's node.

    A link that is named and not there gets a node of its own, and each missing name another.

    Args:
        figure: Where such a node is added.
        joint: The joint.
        keys: Keys of nodes by the name of their link; missing links are added to it.
    """
    found = []
    for name, element in (
        (joint.parent, joint.parent_element),
        (joint.child, joint.child_element),
    ):
        if name and name in keys:
            found.append(keys[name])
            continue
        mark = "no such link" if name else "not said"
        node = figure.add(
            Node(
                f"missing:{name}",
                "missing",
                name,
                elements=[joint.element if element is None else element],
                faults=[mark],
            )
        )
        if name:
            keys[name] = node.key
        found.append(node.key)
    return found[0], found[1]
