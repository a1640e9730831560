"""Fixes of links and joints by name."""

from __future__ import annotations

import re

from ..rule import Problem
from .elsewhere import check_not_included
from .proposal import (
    Around,
    Proposal,
    attribute_at,
    first,
    is_always_there,
    is_computed,
    meant,
    put,
    remove,
    safe,
    same,
    unsafe,
)

_ORPHAN = re.compile(r"did you mean '([^']*)'\? It is the child of no joint")


def unknown_parent_link(problem: Problem, around: Around) -> Proposal | None:
    """Declare ``world``; write the link that was meant for another.

    A world is declared in a description that is a robot whatever its arguments are: a part that
    another robot includes gets its world from there.
    """
    joint = around.joint(problem)
    if joint.parent != "world":
        return _other_link(problem)
    check_not_included(around)
    made = first(around.robot.element, '<link name="world"/>')
    parent = joint.parent_element
    sure = parent is not None and is_always_there(parent) and not is_computed(parent, "link")
    known = any(_WORLD.search(file.data) for file in around.description.files)
    return (safe if sure and not known else unsafe)('add <link name="world"/>', made)


_WORLD = re.compile(rb"<link\b[^>]*\bname\s*=\s*[\"']world[\"']")


def unknown_child_link(problem: Problem, around: Around) -> Proposal | None:
    """The link that was meant, if it is no joint's child yet."""
    orphan = _ORPHAN.search(problem.message)
    found = attribute_at(problem)
    if orphan is not None and found is not None:
        return unsafe(f"write '{orphan[1]}'", put(*found, orphan[1]))
    name = meant(problem, around.joint(problem).child)
    if any(joint.child == name for joint in around.robot.joints):
        return None
    return _other_link(problem)


def _other_link(problem: Problem) -> Proposal | None:
    found = attribute_at(problem)
    name = meant(problem, found[0].get(found[1]) or "") if found is not None else ""
    if found is None or not name:
        return None
    return unsafe(f"write '{name}'", put(*found, name))


def duplicate_joint_name(problem: Problem, around: Around) -> Proposal | None:
    """A number behind the second."""
    joint = around.joint(problem)
    name = _free(joint.name, {*around.robot.joint, *around.robot.link})
    return unsafe(f"call it '{name}'", put(joint.element, "name", name))


def _free(name: str, taken: set[str]) -> str:
    number = 2
    while f"{name}_{number}" in taken:
        number += 1
    return f"{name}_{number}"


def conflicting_material(problem: Problem, around: Around) -> Proposal | None:
    """Remove the second of two that are equal.

    In xacro another robot, or other arguments, may have the second alone.
    """
    element = problem.element
    if element.tag != "material" or element.parent is not around.robot.element:
        return None
    name = element.get("name")
    firsts = [m.element for m in around.robot.materials if m.name == name]
    if firsts[0] is element or not same(firsts[0], element):
        return None
    if (firsts[0].file.path, firsts[0].start) == (element.file.path, element.start):
        return None  # one place that is included twice
    make = safe if around.description.expansion is None else unsafe
    return make("keep the first, which is equal", remove(element))
