"""Joints in ``<gazebo>`` that close loops, which some operations cannot keep."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from ..errors import ModelError
from ..model.mechanism import Closure
from .draft import Draft


def _refuse(closure: Closure, why: str) -> ModelError:
    return ModelError(
        f"joint '{closure.name}' closes a loop of links '{closure.parent}' and '{closure.child}', "
        f"{why}; remove it first",
        at=closure.place,
    )


def check_loops(draft: Draft, links: Collection[str], why: str) -> None:
    """Check that no closing joint is at one of some links.

    Raises:
        ModelError: One is; the message has the reason.
    """
    for closure in draft.robot.closures:
        if closure.parent in links or closure.child in links:
            raise _refuse(closure, why)


def check_zeros(draft: Draft, joints: Iterable[str]) -> None:
    """Check that no joint within a loop gets another zero: loops are closed where all are zero.

    Raises:
        ModelError: One does.
    """
    tree, changed = draft.robot.tree, set(joints)
    for closure in draft.robot.closures:
        ways = []
        for name in (closure.parent, closure.child):
            links = [name, *tree.list_ancestors(name)]
            found = (tree.get_parent_joint(link) for link in links)
            ways.append({joint.name for joint in found if joint is not None})
        inside = changed & (ways[0] ^ ways[1])
        if inside:
            raise _refuse(closure, f"which joint '{min(inside)}' would close elsewhere")


def cut_loops(draft: Draft, links: Collection[str]) -> None:
    """Remove the closing joints within a branch.

    Raises:
        ModelError: One connects the branch to what is kept.
    """
    for closure in draft.robot.closures:
        ends = [name in links for name in (closure.parent, closure.child)]
        if any(ends) and not all(ends):
            raise _refuse(closure, "of which one would be cut")
        if all(ends):
            element = closure.element
            block = element.parent
            is_alone = block is not None and block.tag == "gazebo" and len(block.children) == 1
            draft.remove(block if is_alone and block is not None else element)


def list_ends(draft: Draft) -> set[str]:
    """Return the links of closing joints."""
    return {name for c in draft.robot.closures for name in (c.parent, c.child)}
