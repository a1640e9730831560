"""Change how meshes are named, wherever a robot uses them."""

from __future__ import annotations

import os
from collections.abc import Callable

from ...source.document import Element
from ..fix import Change, FixContext, Proposal, attribute_at, prepend_child, unsafe
from ..rule import Problem
from .uses import MeshUse, mesh_uses


def uses_at(problem: Problem, context: FixContext) -> list[MeshUse]:
    """List the uses of the mesh whose name a problem points at.

    Returns:
        Nothing where it points at no attribute.
    """
    found = attribute_at(problem)
    if found is None:
        return []
    uri = found[0].get(found[1])
    return [use for use in mesh_uses(context.robot, context.description) if use.uri == uri]


def change_uses(
    problem: Problem, context: FixContext, change: Callable[[MeshUse], Change | None]
) -> list[Change]:
    """Change each use of the mesh whose name a problem points at.

    Args:
        problem: The problem.
        context: The robot and its description.
        change: Gives the change of one use, or None where it cannot be changed.

    Returns:
        Nothing where one of them cannot be changed.
    """
    changes = [change(use) for use in uses_at(problem, context)]
    return [] if None in changes else [one for one in changes if one is not None]


def propose_compiler(context: FixContext) -> Proposal | None:
    """Propose a ``<mujoco><compiler>`` with the folder of the meshes.

    Returns:
        None where there is a ``<mujoco>``, or the meshes are not in one folder.
    """
    root: Element = context.robot.element
    if root.child("mujoco") is not None:
        return None
    folders = {
        os.path.dirname(os.path.realpath(use.path))
        for use in mesh_uses(context.robot, context.description)
        if use.path is not None and use.exists
    }
    if len(folders) != 1 or context.description.path == "-":
        return None
    here = os.path.dirname(os.path.realpath(context.description.files[0].path))
    folder = os.path.relpath(folders.pop(), here).replace(os.sep, "/")
    line = f'\t<compiler meshdir="{folder}" discardvisual="false" strippath="true"/>'
    return unsafe(
        "add <mujoco> with the folder of the meshes",
        prepend_child(root, "<mujoco>", line, "</mujoco>"),
    )
