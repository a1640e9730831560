"""Report meshes that MuJoCo finds, and others do not, and the reverse."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ...model.elements import Robot
from ...source.description import Description
from ...source.packages import shorten_path
from ..mujoco import is_found_by_mujoco, locate_in_mujoco, read_mesh_folder
from ..rule import WARNING, Problem
from .mesh_uses import MeshUse


def report_lost(lost: list[MeshUse], robot: Robot, description: Description) -> Iterator[Problem]:
    """Report files that exist, and that MuJoCo searches elsewhere because of its settings."""
    folder = read_mesh_folder(robot)
    if folder.element is None:
        return
    uses = list({use.uri: use for use in lost if use.exists}.values())
    paths = [path for use in uses if (path := locate_in_mujoco(use, folder, description))]
    if not paths:
        return
    more = f" (and {len(paths) - 1} more)" if len(paths) > 1 else ""
    yield Problem(
        uses[0].link,
        f"MuJoCo does not find mesh '{uses[0].uri}'{more}: because of its <compiler>, it opens "
        f"'{shorten_path(paths[0])}'; write URIs relative to meshdir, or correct meshdir and "
        "strippath",
        at=folder.element,
        severity=WARNING,
        data={"uri": uses[0].uri, "path": str(paths[0]), "count": len(paths)},
        effects=["mujoco (folder)" if not folder.strippath else "mujoco"],
    )


def take_found_by_mujoco(
    missing: dict[Path, list[MeshUse]], robot: Robot, description: Description
) -> list[MeshUse]:
    """Remove the missing files that MuJoCo finds in its folder of meshes, and return their uses."""
    folder = read_mesh_folder(robot)
    there = [
        path
        for path, uses in missing.items()
        if folder.element is not None
        and all(is_found_by_mujoco(use, folder, description) for use in uses)
    ]
    return [use for path in there for use in missing.pop(path)]


def report_found_by_mujoco(robot: Robot, uses: list[MeshUse], effects: list[str]) -> Problem:
    """Report files that only MuJoCo finds."""
    first, count = uses[0], len({use.uri for use in uses})
    more = f" (and {count - 1} more)" if count > 1 else ""
    return Problem(
        first.link,
        f"only MuJoCo finds mesh '{first.uri}'{more}, in its meshdir "
        f"'{read_mesh_folder(robot).meshdir}'; for other readers, and MuJoCo since 3.7, write "
        "paths relative to the description, and remove meshdir",
        at=first.mesh.locate_attribute("filename"),
        severity=WARNING,
        data={"uri": first.uri, "count": count},
        effects=effects,
    )
