"""Fixes in the SRDF beside a robot."""

from __future__ import annotations

import re

from ...source.document import Element
from ..moveit.configuration import action_of, as_double, not_doubles, without_action
from ..rule import Problem
from .proposal import (
    Around,
    Proposal,
    Span,
    after,
    attribute_at,
    insert,
    meant,
    put,
    quote,
    safe,
    unsafe,
)


def moveit_parameter_type(problem: Problem, around: Around) -> Proposal | None:
    """The same number with a point, for each of them."""
    name = problem.place.path.replace("\\", "/").rpartition("/")[2]
    spans = [
        Span(node.file, node.start, node.end, text.encode())
        for _, node in not_doubles(around.robot, around.description, name)
        if (text := as_double(node))
    ]
    return safe("write doubles", *spans) if spans else None


def moveit_controller_incomplete(problem: Problem, around: Around) -> Proposal | None:
    """The action of its type, on a line before the others."""
    for name, section in without_action(around.robot, around.description):
        if name.place.start != problem.place.start or name.file.path != problem.place.path:
            continue
        data, at = section.file.data, section.start
        text = f"action_ns: {action_of(section)}".encode()
        if data[at : at + 1] == b"{":
            at, text = at + 1, text + b", "
        else:
            text += b"\n" + data[data.rfind(b"\n", 0, at) + 1 : at]  # indented as it is
        return unsafe("name the action of its type", Span(section.file, at, at, text))
    return None


def srdf_robot_name(problem: Problem, around: Around) -> Proposal | None:
    """The robot's."""
    name = around.robot.name
    if not name:
        return None
    return safe(f"write '{name}'", put(problem.element, "name", name))


def srdf_unknown_link(problem: Problem, around: Around) -> Proposal | None:
    """The link that was meant."""
    return _rename(problem)


def srdf_unknown_joint(problem: Problem, around: Around) -> Proposal | None:
    """The joint that was meant."""
    return _rename(problem)


def _rename(problem: Problem) -> Proposal | None:
    found = attribute_at(problem)
    name = meant(problem, found[0].get(found[1]) or "") if found is not None else ""
    if found is None or not name:
        return None
    return unsafe(f"write '{name}'", put(*found, name))


def group_state_out_of_bounds(problem: Problem, around: Around) -> Proposal | None:
    """The limit that it is beyond."""
    joint = around.robot.joint.get(problem.element.get("name") or "")
    if joint is None or joint.limit is None:
        return None
    low, high = joint.limit.lower or 0.0, joint.limit.upper or 0.0
    nearest = min(max(float(problem.element.get("value") or 0), low), high)
    return unsafe(f"write {nearest:.12g}", put(problem.element, "value", f"{nearest:.12g}"))


def missing_virtual_joint(problem: Problem, around: Around) -> Proposal | None:
    """A fixed one, which is what MoveIt assumes."""
    root = around.robot.tree.root
    if root is None or "world_joint" in around.robot.joint:
        return None
    line = (
        '<virtual_joint name="world_joint" type="fixed" parent_frame="world" '
        f'child_link="{quote(root.name)}"/>'
    )
    return unsafe("add a fixed one", insert(problem.element, line))


def adjacent_pair_not_disabled(problem: Problem, around: Around) -> Proposal | None:
    """Write it behind the pairs that are there; MoveIt does not check the two from then on."""
    names, root = re.findall(r"links '([^']+)' and '([^']+)' touch", problem.message), problem.at
    if not names or not isinstance(root, Element):
        return None
    one, other = map(quote, names[0])
    line = f'<disable_collisions link1="{one}" link2="{other}" reason="Adjacent"/>'
    pairs = list(root.all("disable_collisions"))
    change = after(pairs[-1], line) if pairs else insert(root, line)
    return unsafe("let them touch", change)
