"""Read the compiler settings of a robot for MuJoCo, and find the files that it opens."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ..model.elements import Mesh, Robot
from ..model.mesh_formats import READ_BY, get_suffix
from ..source.description import Description
from ..source.document import Element
from .mesh.mesh_uses import MeshUse, get_mesh_uses


def keeps_visuals(robot: Robot) -> bool:
    """Tell whether MuJoCo keeps the visuals; from a URDF it discards them by default."""
    if robot.xml is None:
        return True
    return any(
        (compiler.get("discardvisual") or "").strip() == "false"
        for compiler in _list_compilers(robot)
    )


def reads_collisions(robot: Robot) -> bool:
    """Tell whether MuJoCo has a decoder for every collision mesh, by file suffix."""
    return all(
        get_suffix(shape.geometry.filename) in READ_BY["mujoco"]
        for link in robot.links
        for shape in link.collisions
        if isinstance(shape.geometry, Mesh)
    )


def _list_compilers(robot: Robot) -> Iterator[Element]:
    if robot.xml is not None:
        for mujoco in robot.xml.list_children("mujoco"):
            yield from mujoco.list_children("compiler")


class MeshFolder(NamedTuple):
    """Where MuJoCo looks for meshes.

    Attributes:
        meshdir: Folder, relative to the description or absolute; empty for its folder.
        strippath: Whether it removes the folders from the names of files.
        element: The last ``<compiler>`` with one of them; None without.
    """

    meshdir: str
    strippath: bool
    element: Element | None


def read_mesh_folder(robot: Robot) -> MeshFolder:
    """Read the folder of the meshes from the ``<compiler>`` elements, of which the last wins.

    Without ``strippath``, MuJoCo since 3.7 keeps the folders; earlier versions remove them.
    """
    folder = MeshFolder("", False, None)
    for compiler in _list_compilers(robot):
        meshdir = compiler.get("meshdir") or compiler.get("assetdir")
        strip = (compiler.get("strippath") or "").strip()
        if meshdir or strip:
            folder = MeshFolder(
                meshdir or folder.meshdir,
                strip == "true" if strip else folder.strippath,
                compiler,
            )
    return folder


def locate_in_mujoco(use: MeshUse, folder: MeshFolder, description: Description) -> Path | None:
    """Return the file that MuJoCo opens for the URI of a mesh (run with MuJoCo 4.0).

    Args:
        use: The use of the mesh.
        folder: Where it looks for meshes.
        description: The description; a relative path starts in the folder of its file.

    Returns:
        None for a URI with a scheme, such as ``package://``, which it does not resolve.
    """
    name = use.uri
    if folder.strippath:
        name = name.replace("\\", "/").rpartition("/")[2]
    elif "://" in name:
        return None
    return Path(os.path.normpath(description.packages.file.parent / folder.meshdir / name))


def is_found_by_mujoco(use: MeshUse, folder: MeshFolder, description: Description) -> bool:
    """Tell whether the file exists that MuJoCo opens for the URI of a mesh."""
    path = locate_in_mujoco(use, folder, description)
    return path is not None and use.workspace.is_file(path)


def find_rejected_by_mujoco(robot: Robot, description: Description) -> list[MeshUse]:
    """Find the meshes for which MuJoCo rejects the robot: it opens them and finds no file.

    These include every URI with a scheme, even if its file exists (run with MuJoCo 4.0).
    """
    folder, keeps = read_mesh_folder(robot), keeps_visuals(robot)
    return [
        use
        for use in get_mesh_uses(robot, description)
        if (keeps or use.collides)
        and use.uri.strip()
        and not use.is_unread
        and "${" not in use.uri
        and "$(" not in use.uri
        and not is_found_by_mujoco(use, folder, description)
    ]


def find_lost_in_mujoco(robot: Robot, description: Description) -> list[MeshUse]:
    """Find the meshes whose file MuJoCo would not find without their scheme, either.

    A URI with a scheme counts only if its file is known to be missing, or its package is a folder
    that only PyBullet takes as one.
    """
    strips = read_mesh_folder(robot).strippath
    return [
        use
        for use in find_rejected_by_mujoco(robot, description)
        if "://" not in use.uri
        or strips
        or (use.path and not use.exists)
        or get_assumed_package(use, description)
    ]


def get_assumed_package(use: MeshUse, description: Description) -> str:
    """Get the package of a mesh in whose place a folder of the same name is read, if one is."""
    scheme, _, rest = use.uri.partition("://")
    name = rest.lstrip("/").partition("/")[0]
    return name if scheme == "package" and name in description.packages.assumed else ""
