"""Policy of file access: which files a description may read.

A description may be untrusted. It reads files of its project, of packages that the user, ROS or
Gazebo names, and of packages in its ROS workspace. Decisions are made for real paths, so that a
symbolic link does not lead out. Hidden files and folders, devices and pipes are never read.
"""

from __future__ import annotations

import os
from collections.abc import Hashable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from ..errors import AccessError, PackageNotFound
from ..file_access import IRREGULAR, AccessRefused
from ..projects import (
    TRUST_REMEDY,
    find_project,
    find_repository,
    is_shared,
    is_trusted,
    is_within,
    list_above,
    list_asset_folders,
)
from ..workspace import Workspace

if TYPE_CHECKING:
    from .location import Place

MODEL_PATHS = (
    *("SDF_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "GAZEBO_MODEL_PATH"),
)
"""Environment variables that list folders of Gazebo models."""

_PACKAGE_PATHS = ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH")
_SYSTEM = Path("/opt/ros")
_MODEL_MARK = "model.config"


def _is_model(folder: Path, files: Workspace) -> bool:
    return files.is_file(folder / _MODEL_MARK)


def require_companion(mesh: Path, path: Path) -> Path:
    """Check a file that a mesh file refers to: it is in the project of the mesh.

    Returns:
        The other file.

    Raises:
        OSError: It is outside, hidden, a device or a pipe.
    """
    files = Workspace()
    if _is_irregular(path, files):
        raise AccessRefused(IRREGULAR, path)
    if is_trusted(files):
        return path
    real = Path(_resolve(files, path))
    mesh = Path(_resolve(files, mesh))
    folders = (find_project(mesh, files) or mesh.parent, *list_asset_folders(mesh, files))
    if not any(is_within(real, folder) for folder in folders):
        raise AccessRefused(f"is outside of the project of {mesh.name}; {TRUST_REMEDY}", path)
    return path


def list_companions(mesh: Path, pattern: str) -> list[Path]:
    """Return files in the folder of a mesh that match a pattern and to which the mesh may refer."""
    files = Workspace()
    companions = files.list_matches(mesh.parent, pattern)
    return [path for path in companions if files.is_file(path) and is_companion_allowed(mesh, path)]


def is_companion_allowed(mesh: Path, path: Path) -> bool:
    """Tell whether a mesh file may refer to a file; see :func:`require_companion`."""
    try:
        require_companion(mesh, path)
    except OSError:
        return False
    return True


class PackageFolders(Protocol):
    """Packages of a description.

    Attributes:
        file: Path of the description.
        files: Access to files, without restriction.
        named: Folders by package name that the user named.
        paths: Folders that contain packages.
    """

    file: Path
    files: Workspace
    named: dict[str, Path]
    paths: list[Path]

    def list_configured(self) -> list[Path]:
        """Return the configured folders that the description may read."""

    def find_owner(self, path: Path) -> tuple[str, Path] | None:
        """Return name and folder of the package of a file."""

    def find_by_manifest(self, name: str) -> Path | None:
        """Return the folder of a package; None without a manifest.

        Raises:
            PackageNotFound: It may not be read.
        """


class FileAccess:
    """Decision which files one description may read."""

    def __init__(self, packages: PackageFolders) -> None:
        """Store the packages of the description; folders are searched on demand."""
        self._packages = packages
        self._allowed: list[Path] = []
        self._included: list[FileAccess] = []
        self._rules: tuple[Hashable, list[Path], list[Path]] | None = None

    @property
    def key(self) -> Hashable:
        """Return the identity of the policy: equal for descriptions that may read the same."""
        return self._get_rules()[0]

    def allow(self, path: str | Path) -> None:
        """Allow a file or folder that the tool made, or that was checked for another reader."""
        real = Path(_resolve(self._packages.files, path))
        if real not in self._allowed:
            self._allowed.append(real)
            self._rules = None

    def include(self, other: FileAccess) -> None:
        """Allow what another description may read, from which this one was made."""
        self._included.append(other)
        self._rules = None

    def with_packages(self, packages: PackageFolders) -> FileAccess:
        """Return the policy for the same description with another finder."""
        other = FileAccess(packages)
        other._allowed = self._allowed.copy()
        other._included = self._included.copy()
        return other

    def _get_rules(self) -> tuple[Hashable, list[Path], list[Path]]:
        """Return the key, the files of the description itself, and the folders that it reads."""
        if self._rules is None:
            files = self._packages.files
            own = self._list_own_files(files)
            roots = self._list_roots(files)
            included = [other.key for other in self._included]
            key = FileAccess, is_trusted(files), *map(str, (*own, *roots)), *included
            self._rules = key, own, roots
        return self._rules

    def check(self, path: str | Path, at: Place | None = None) -> None:
        """Check that the description may read a file, which need not exist.

        Raises:
            AccessError: It may not, or the file is a device or a pipe.
        """
        reason = self.explain_refusal(path)
        if reason:
            raise AccessError(f"{path} {reason}", at=at, rule="include-not-found")

    def explain_refusal(self, path: str | Path, files: Workspace | None = None) -> str:
        """Return why a file may not be read, as a predicate with a remedy; empty if it may be.

        Args:
            path: The file, which need not exist.
            files: The workspace that asks, without restriction; None is that of the description.
        """
        files = files or self._packages.files
        key = FileAccess.explain_refusal, self.key, os.fspath(path)
        return files.memoize(key, lambda inner: self._decide(path, inner))

    def _decide(self, path: str | Path, files: Workspace) -> str:
        try:
            real = Path(_resolve(files, path))
        except ValueError as error:
            return f"is not a path: {error}"
        if _is_irregular(real, files):
            return IRREGULAR
        _, own, roots = self._get_rules()
        if is_trusted(files) or real in own:
            return ""
        if any(is_within(real, root) for root in roots):
            return ""
        if self._is_in_package(real, files) or self._is_in_model(real, files):
            return ""
        if any(not other.explain_refusal(path, files) for other in self._included):
            return ""
        linked = "" if str(real) == os.path.abspath(path) else f"is a link to {real}, which "
        if any(real.is_relative_to(root) for root in roots):
            return f"{linked}is a hidden file or in a hidden folder; {TRUST_REMEDY}"
        return f"{linked}is outside of the project; {self._suggest_package(real, files)}"

    def _list_own_files(self, files: Workspace) -> list[Path]:
        """Return the file of the description, which the user named, as given and without links."""
        file = self._packages.file
        return list(dict.fromkeys((file, Path(_resolve(files, file)))))

    def _list_roots(self, files: Workspace) -> list[Path]:
        """Return the real paths of the folders below which the description reads."""
        packages = self._packages
        roots: list[str | Path | None] = [
            find_project(file, files) for file in self._list_own_files(files)
        ]
        roots += list_asset_folders(self._list_own_files(files)[-1], files)
        roots += [*packages.named.values(), *packages.paths, *packages.list_configured()]
        for variable in (*_PACKAGE_PATHS, *MODEL_PATHS):
            roots += (files.read_variable(variable) or "").split(os.pathsep)
        roots.append(_SYSTEM)
        named = tuple(str(folder) for folder in roots if folder)
        real = files.memoize((FileAccess, named), lambda inner: _resolve_all(inner, named))
        return list(dict.fromkeys((*real, *self._allowed)))

    def _is_in_package(self, real: Path, files: Workspace) -> bool:
        """Tell whether a file is in a package that ``$(find …)`` finds by a ``package.xml``."""
        own = self._packages.find_owner(real)
        if own is None or not is_within(real, own[1]) or is_shared(own[1], files):
            return False
        try:
            folder = self._packages.find_by_manifest(own[0])
        except PackageNotFound:  # a configuration that came along names a foreign folder
            return False
        if folder is not None and Path(_resolve(files, folder)) == own[1]:
            # a link of the project itself must not lead to the packages of others
            projects = filter(None, (find_project(f, files) for f in self._list_own_files(files)))
            return not any(folder.is_relative_to(project) for project in projects)
        prefixes = (files.read_variable("AMENT_PREFIX_PATH") or "").split(os.pathsep)
        manifests = (Path(one, "share", own[0], "package.xml") for one in prefixes if one)
        # `colcon build --symlink-install` links installed files to the sources
        return any(Path(_resolve(files, one)).parent == own[1] for one in manifests)

    def _is_in_model(self, real: Path, files: Workspace) -> bool:
        """Tell whether a file is in a Gazebo model next to that of the description."""
        for file in self._get_rules()[1]:
            own = next((f for f in list_above(file.parent, files) if _is_model(f, files)), None)
            if own is None or is_shared(own.parent, files) or not is_within(real, own.parent):
                continue
            repository = find_repository(own, files)
            if repository is not None and not own.parent.is_relative_to(repository):
                continue
            if _is_model(own.parent / real.relative_to(own.parent).parts[0], files):
                return True
        return False

    def _suggest_package(self, real: Path, files: Workspace) -> str:
        """Return the remedy for a file outside: the folder around it and the description."""
        try:
            around = Path(os.path.commonpath((self._list_own_files(files)[-1].parent, real)))
        except ValueError:  # on another drive
            around = real.parent
        if is_shared(around, files) or around.name.startswith("."):
            return f"set the package with --package NAME=DIR, or {TRUST_REMEDY}"
        return f"pass --package {around.name}={_shorten(around)}, or {TRUST_REMEDY}"


def _is_irregular(path: Path, files: Workspace) -> bool:
    return files.exists(path) and not files.is_file(path) and not files.is_folder(path)


def _resolve(files: Workspace, path: str | Path) -> str:
    return files.resolve_links(os.path.abspath(path))


def _resolve_all(files: Workspace, paths: Iterable[str]) -> list[Path]:
    return [Path(_resolve(files, path)) for path in paths]


def _shorten(folder: Path) -> str:
    here = os.path.relpath(folder)
    return here if not here.startswith("../..") else str(folder)
