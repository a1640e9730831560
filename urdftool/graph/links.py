"""End nodes of a joint, also for links that do not exist."""

from __future__ import annotations

from ..model.elements import Joint
from .figure import Figure, Node


def find_ends(figure: Figure, joint: Joint, keys: dict[str, str]) -> tuple[str, str]:
    """Return the keys of the parent's and the child's node.

    A node is added for each link that does not exist, and for each missing name.
    """
    found = []
    for name, element in (
        (joint.parent, joint.parent_element),
        (joint.child, joint.child_element),
    ):
        if name and name in keys:
            found.append(keys[name])
            continue
        mark = "missing link" if name else "not specified"
        node = figure.add(
            Node(
                f"missing:{name}",
                "missing",
                name,
                elements=joint.sources if element is None else [element],
                faults=[mark],
            )
        )
        if name:
            keys[name] = node.key
        found.append(node.key)
    return found[0], found[1]
