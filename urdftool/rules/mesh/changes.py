"""Change the URIs of meshes, and write mesh files in place or under new names."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path

from ...diagnostic import FileRewrite
from ...errors import MeshError
from ...source.document import Element
from ...source.packages import shorten_path
from ..file_rewrites import compute_rewritten_bytes
from ..fix import Change, FixContext, Proposal, find_attribute, prepend_child, unsafe
from ..rule import Problem
from .mesh_uses import MeshUse, get_mesh_uses


def find_uses(problem: Problem, context: FixContext) -> list[MeshUse]:
    """List the uses of the mesh whose name or scale a problem points at.

    Returns:
        An empty list if it points at no attribute.
    """
    found = find_attribute(problem)
    if found is None:
        return []
    uri = found[0].get("filename")
    return [use for use in get_mesh_uses(context.robot, context.description) if use.uri == uri]


def find_existing_uses(problem: Problem, context: FixContext) -> list[MeshUse]:
    """List the uses of the mesh whose name a problem points at.

    Returns:
        An empty list if the file does not exist.
    """
    return [use for use in find_uses(problem, context) if use.exists and use.path is not None]


def change_uses(
    problem: Problem, context: FixContext, change: Callable[[MeshUse], Change | None]
) -> list[Change]:
    """Change each use of the mesh whose name a problem points at.

    Returns:
        An empty list if one of them cannot be changed.
    """
    changes = [change(use) for use in find_uses(problem, context)]
    return [] if None in changes else [one for one in changes if one is not None]


def rewrite_in_place(uses: Iterable[MeshUse], how: str) -> list[FileRewrite]:
    """Rewrite the files of meshes.

    Use it for changes after which all readers load the same geometry, or for files that no other
    description of the package uses.

    Args:
        uses: The meshes.
        how: Content to write, one of the constants of :mod:`urdftool.rules.file_rewrites`.
    """
    paths = dict.fromkeys(shorten_path(use.path) for use in uses if use.path is not None)
    return [FileRewrite(path, path, how) for path in paths]


def write_new_file(use: MeshUse, name: str, how: str) -> list[FileRewrite]:
    """Write a new file, computed from a mesh, to its folder.

    Args:
        use: The mesh.
        name: Name of the new file.
        how: Content to write, one of the constants of :mod:`urdftool.rules.file_rewrites`.

    Returns:
        An empty list if a file of that name with other content exists. Robots share meshes: a
        file that was written for another robot is reused.
    """
    old = Path(str(use.path))
    new = old.with_name(name)
    rewrite = FileRewrite(shorten_path(new), shorten_path(old), how)
    workspace = use.workspace
    if workspace.exists_or_is_link(new):
        try:
            same = workspace.read_bytes(new) == compute_rewritten_bytes(workspace, rewrite)
        except (MeshError, OSError):
            return []
        return [rewrite] if same else []
    return [rewrite]


def propose_compiler(context: FixContext) -> Proposal | None:
    """Propose a ``<mujoco><compiler>`` with the folder of the meshes.

    Returns:
        None if there is a ``<mujoco>`` element, or the meshes are in several folders.
    """
    root: Element = context.robot.element
    if root.find_child("mujoco") is not None:
        return None
    folders = {
        os.path.dirname(context.workspace.resolve_links(use.path))
        for use in get_mesh_uses(context.robot, context.description)
        if use.path is not None and use.exists
    }
    if len(folders) != 1 or context.description.path == "-":
        return None
    here = os.path.dirname(context.workspace.resolve_links(context.description.files[0].path))
    folder = os.path.relpath(folders.pop(), here).replace(os.sep, "/")
    line = f'\t<compiler meshdir="{folder}" discardvisual="false" strippath="true"/>'
    return unsafe(
        "add a <mujoco> element with the folder of the meshes",
        prepend_child(root, "<mujoco>", line, "</mujoco>"),
    )
