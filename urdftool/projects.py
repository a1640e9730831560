"""Projects: the folder around a file that belongs together, and links that lead out of it.

A project is the repository around a file, else the nearest folder above with a project file, else
the folder of the file, with the folders of meshes next to it. Folders that everybody uses, such as
the home folder, are never projects.
What is in a project may be untrusted, its symbolic links among it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from .workspace import Workspace, memoize_by_workspace

TRUST = "URDFTOOL_TRUST"
"""Environment variable that trusts descriptions, also in child processes; ``--trust`` sets it."""

TRUST_REMEDY = "pass --trust if the input is trusted"

_REPOSITORY_MARKS = (".git", ".hg")
_PROJECT_MARKS = (
    *("package.xml", "model.config", "pyproject.toml", "CMakeLists.txt"),
    *("setup.py", "setup.cfg", "urdftool.toml", ".urdftool.toml"),
)
_DESCRIPTIONS = ("urdf", "xacro", "robots", "xml", "xmls", "mjcf", "mujoco", "sdf", "usd")
_ASSETS = (
    *("meshes", "mesh", "dae", "stl", "obj", "glb", "assets", "visual", "collision"),
    *("materials", "textures"),
)
"""Folders of descriptions and of what they show: the names that packages on PyPI use, counted."""

_LIBRARIES = ("site-packages", "dist-packages")
_HOMES = ("home", "Users")
_OWN_FOLDERS = ("HOME", "USERPROFILE", "TMPDIR", "TEMP", "TMP")
_SHARED = frozenset(
    (
        *("bin", "boot", "dev", "etc", "home", "lib", "lib32", "lib64", "media", "mnt", "opt"),
        *("proc", "root", "run", "sbin", "srv", "sys", "tmp", "usr", "var"),
        *("Applications", "Library", "System", "Users", "Volumes", "cores", "private"),
    )
)
"""Folders below the root of the file system that hold more than one project."""


def disable_sandbox() -> None:
    """Trust all descriptions in this process and its children."""
    os.environ[TRUST] = "1"


def is_trusted(files: Workspace) -> bool:
    """Tell whether the user trusts all descriptions."""
    return files.read_variable(TRUST) == "1"


def find_project(path: str | Path, files: Workspace) -> Path | None:
    """Return the project of a file, which need not exist; None in a folder that everybody uses."""
    found = _find_project(files, os.path.dirname(os.path.abspath(path)))
    return None if found is None else Path(found)


@memoize_by_workspace
def _find_project(files: Workspace, folder: str) -> str | None:
    above = list(list_above(Path(folder), files))
    if not above:
        return None
    if above[-1].parent.name in _LIBRARIES or _is_cmeel(above[-1].parent):
        return str(above[-1])
    for marks in (_REPOSITORY_MARKS, _PROJECT_MARKS):
        for place in above:
            if any(files.exists(place / mark) for mark in marks):
                return str(place)
    return folder


def list_above(folder: Path, files: Workspace) -> Iterator[Path]:
    """Yield a folder and those above it that can be a project."""
    for place in (folder, *folder.parents):
        if is_shared(place, files):
            return
        yield place
        if place.name.startswith("."):
            return  # a hidden folder, such as a cache, is not a part of what is around it


def _is_cmeel(folder: Path) -> bool:
    """Tell whether a folder holds packages that cmeel installs."""
    return folder.parts[-2:] == ("cmeel.prefix", "share")


def list_asset_folders(path: str | Path, files: Workspace) -> list[Path]:
    """Return the folders of meshes and images next to the folder of a file without a project mark.

    ``robot/urdf/robot.urdf`` without a mark of a project belongs to ``robot/meshes``, as in
    a package; other folders of ``robot`` and its own files may be anybody's.

    Args:
        path: The real path of the file, which need not exist: a description, a mesh or its part.
        files: Access to files without restriction.
    """
    own = Path(path).parent
    if find_project(path, files) != own:
        return []
    homes = (p.parent for p in (own, own.parent) if p.name in (*_DESCRIPTIONS, *_ASSETS))
    folders = (home / name for home in homes for name in _ASSETS if not is_shared(home, files))
    return [f for f in folders if files.is_folder(f) and files.resolve_links(f) == str(f)]


def is_shared(folder: Path, files: Workspace) -> bool:
    """Tell whether a folder holds more than one project: a system, home or temporary folder."""
    return _is_shared(files, folder)


@memoize_by_workspace
def _is_shared(files: Workspace, folder: Path) -> bool:
    if len(folder.parts) <= 1 or folder.name in _LIBRARIES or _is_cmeel(folder):
        return True
    inner = folder.parts[1:]
    if len(inner) == 1 and inner[0] in _SHARED:
        return True
    if len(inner) == 2 and (inner[0] in _HOMES or inner in (("var", "tmp"), ("usr", "share"))):
        return True
    for variable in _OWN_FOLDERS:
        own = files.read_variable(variable) or ""
        if os.path.isabs(own):
            real = Path(files.resolve_links(own))
            if real.is_relative_to(folder) or Path(own).is_relative_to(folder):
                return True
    return False


def is_within(path: Path, root: Path) -> bool:
    """Tell whether a file is below a folder and not hidden there."""
    if not path.is_relative_to(root):
        return False
    return not any(part.startswith(".") for part in path.relative_to(root).parts)


def explain_link_out(path: str | Path, files: Workspace, *, of_repository: bool = False) -> str:
    """Return why a link on a path is not followed, as a predicate; empty if all links may be.

    A link that is in a project and leads out of it may have come with the project, so that neither
    its author nor the user chose the file on this machine.

    Args:
        path: The file, which need not exist.
        files: Access to files without restriction.
        of_repository: Consider only links in repositories.
    """
    if is_trusted(files):
        return ""
    full = Path(os.path.abspath(path))
    for place in (*reversed(full.parents), full):
        if not os.path.islink(place):
            continue
        project = _find_link_project(place, files, of_repository=of_repository)
        real = Path(files.resolve_links(place))
        if project is None or is_within(real, Path(files.resolve_links(project))):
            continue
        link = "" if place == full else f"is below {place}, which "
        where = f"{real}, outside of its project or hidden there"
        return f"{link}is a link to {where}; name {real / full.relative_to(place)} itself"
    return ""


def _find_link_project(place: Path, files: Workspace, *, of_repository: bool) -> Path | None:
    if not of_repository:
        return find_project(place, files)
    return find_repository(place.parent, files)


def find_repository(folder: Path, files: Workspace) -> Path | None:
    """Return the repository around a folder; None if there is none below the shared folders."""
    return _find_repository(files, folder)


@memoize_by_workspace
def _find_repository(files: Workspace, folder: Path) -> Path | None:
    for place in list_above(folder, files):
        if any(files.exists(place / mark) for mark in _REPOSITORY_MARKS):
            return place
    return None
