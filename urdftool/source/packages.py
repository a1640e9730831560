"""Search for ROS packages, without ROS.

One resolver for ``$(find NAME)``, ``package://``, ``model://``, ``file://`` and relative paths,
for every command. Search order: ``--package`` and ``--package-path``; the package of the file (the
nearest ``package.xml`` above it, by its ``<name>``); packages next to it and below the root of its
workspace; ``[tool.urdftool.packages]`` of the configuration; ``ROS_PACKAGE_PATH``;
``AMENT_PREFIX_PATH``; last, a folder above the file with the name of the package, even without a
``package.xml``. For ``package://`` only, a folder of that name near the file replaces a package
that is not found, if it is the only one that contains the file.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from copy import copy
from dataclasses import dataclass
from pathlib import Path

from ..errors import AccessError, PackageNotFound
from ..projects import find_project, find_repository, is_shared, is_trusted, is_within
from ..suggestions import find_nearest, fold
from ..workspace import Workspace, memoize_by_workspace
from .access import FileAccess
from .install_rules import InstallRule, find_installed, is_installed_as, read_install_rules

_NAME = re.compile(rb"<name\s*>\s*([^<\s]+)\s*</name\s*>")
_ENDING = re.compile(r"_(description|gazebo|bringup|msgs|support|resources|moveit_config)s?$")
_MAX_MANIFEST = 1 << 20  # bytes of a package.xml that are searched; chosen, real ones have 2 kB
_IGNORE_FILES = frozenset(("CATKIN_IGNORE", "COLCON_IGNORE", "AMENT_IGNORE"))
_SKIP_FOLDERS = frozenset(("node_modules", "build", "install", "devel", "log", "__pycache__"))
_WORKSPACE_MARKS = (".git", ".hg", "src", ".catkin_workspace", ".catkin_tools", ".colcon")
_MAX_DEPTH = 7  # levels of folders that a search visits; chosen, no source
_MAX_FOLDERS = 20_000  # folders that one search visits; chosen, no source
_MAX_CLIMB = 6  # folders from a file upward that are searched; chosen, no source
_NEAR = 3  # folders above a file in which a package is assumed; chosen, no source


@memoize_by_workspace
def _read_package_name(workspace: Workspace, folder: str) -> str | None:
    try:
        with workspace.open(os.path.join(folder, "package.xml")) as stream:
            text = stream.read(_MAX_MANIFEST)
    except OSError:
        return None
    start, *rest = text.split(b"<!--")
    match = _NAME.search(start + b"".join(part.partition(b"-->")[2] for part in rest))
    return match[1].decode("utf-8", "replace") if match else os.path.basename(folder)


def find_own_package(path: Path, workspace: Workspace | None = None) -> tuple[str, Path] | None:
    """Return name and folder of the package of a file: the nearest ``package.xml`` above it."""
    return _find_owner((workspace or Workspace()).restrict(None), os.path.dirname(path))


@memoize_by_workspace
def _find_owner(workspace: Workspace, folder: str) -> tuple[str, Path] | None:
    name = _read_package_name(workspace, folder)
    if name is not None:
        return name, Path(folder)
    parent = Path(folder).parent
    return None if is_shared(parent, workspace) else _find_owner(workspace, str(parent))


def find_packages(folder: Path, workspace: Workspace | None = None) -> dict[str, Path]:
    """Return all packages in a folder and below it, by name; the topmost of duplicates.

    Hidden folders, build output and folders with an ``…_IGNORE`` file are skipped; packages within
    packages are not searched.
    """
    return _scan_packages((workspace or Workspace()).restrict(None), str(folder))


@memoize_by_workspace
def _scan_packages(workspace: Workspace, folder: str) -> dict[str, Path]:
    packages: dict[str, Path] = {}
    level = [folder]
    seen: set[str] = set()
    for _ in range(_MAX_DEPTH):
        following: list[str] = []
        for place in level:
            real = workspace.resolve_links(place)
            if real in seen:  # links lead to folders above
                continue
            seen.add(real)
            if len(seen) > _MAX_FOLDERS:
                return packages
            try:
                listing = workspace.list_folder(place)
            except OSError:
                continue
            names = {entry.name for entry in listing}
            if names & _IGNORE_FILES:
                continue
            if "package.xml" in names:
                name = _read_package_name(workspace, place)
                if name:
                    packages.setdefault(name, Path(place))
                continue
            following.extend(
                entry.path
                for entry in listing
                if not entry.name.startswith(".")
                and entry.name not in _SKIP_FOLDERS
                and entry.is_folder
            )
        level = sorted(following)
    return packages


def shorten_path(path: str | Path) -> str:
    """Return a path relative to the current folder if it is below it."""
    text = os.path.normpath(path)
    here = os.getcwd() + os.sep
    return text[len(here) :] if text.startswith(here) else text


@dataclass(frozen=True)
class ConfiguredFolder:
    """Folder of a package in a configuration file that was found near the description.

    It came with the description, so it may name only folders of the project, and below itself.
    """

    folder: Path
    file: str
    line: int


class Packages:
    """Finder of packages and files for one description.

    Attributes:
        files: Access to files for the search of packages, without restriction.
        access: Policy that decides which files the description may read.
        file: The description; ``-`` in the current folder for standard input.
        used: Packages found so far, by name.
        assumed: Folders that replace a missing package of their name in ``package://``.
    """

    def __init__(
        self,
        file: str | Path | None = None,
        *,
        named: Mapping[str, str | Path] | None = None,
        paths: Iterable[str | Path] = (),
        configured: Mapping[str, str | Path | ConfiguredFolder] | None = None,
        workspace: Workspace | None = None,
    ) -> None:
        """Store the search paths; the search starts on demand."""
        self.files = (workspace or Workspace()).restrict(None)
        self.access = FileAccess(self)
        self._given = "-" if file is None else str(file)
        self.file = Path.cwd() / "-" if file is None else Path(os.path.abspath(file))
        self.named = {name: Path(os.path.abspath(folder)) for name, folder in (named or {}).items()}
        self.paths = [Path(os.path.abspath(folder)) for folder in paths]
        self.configured = dict(configured or {})
        self.used: dict[str, Path] = {}
        self.assumed: dict[str, Path] = {}
        self._missing: dict[str, tuple[str, list[str]]] = {}
        self._near: dict[tuple[str, str], Path | None] = {}
        self._rules: dict[str, list[InstallRule]] = {}

    @property
    def workspace(self) -> Workspace:
        """Return the workspace of the description's readers: it opens what the policy allows."""
        return self.files.restrict(self.access)

    def with_workspace(self, workspace: Workspace) -> Packages:
        """Return the same finder with another workspace."""
        other = copy(self)
        other.files = workspace.restrict(None)
        other._missing, other._near = {}, {}
        other.access = self.access.with_packages(other)
        return other

    def shorten_path(self, path: str | Path) -> str:
        """Return a path in the style of the description's: absolute, or relative with ``..``."""
        if os.path.isabs(self._given):
            return os.path.normpath(path)
        if self._given.startswith(os.pardir):
            return os.path.relpath(path)
        return "." if os.path.normpath(path) == os.getcwd() else shorten_path(path)

    def make_finder_for(self, path: str | Path) -> Packages:
        """Return a finder for another file of the same robot, which reads what this one reads."""
        other = Packages(
            path,
            named=self.named,
            paths=self.paths,
            configured=self.configured,
            workspace=self.files,
        )
        other.used = self.used.copy()
        other.access.include(self.access)
        return other

    def find_owner(self, path: Path) -> tuple[str, Path] | None:
        """Return name and folder of the package of a file: the nearest ``package.xml`` above it."""
        return find_own_package(path, self.files)

    def find_by_manifest(self, name: str) -> Path | None:
        """Return the folder in which :meth:`find` finds a package; None without a manifest."""
        folders = (folder for _, folder in self._list_packages(name) if folder is not None)
        return next((folder for folder in folders if self.files.is_folder(folder)), None)

    def list_configured(self) -> list[Path]:
        """Return the configured folders that the description may read."""
        return [
            Path(entry.folder if isinstance(entry, ConfiguredFolder) else entry)
            for entry in self.configured.values()
            if not (isinstance(entry, ConfiguredFolder) and self._is_foreign(entry))
        ]

    def _is_foreign(self, entry: ConfiguredFolder) -> bool:
        """Tell whether a configured folder is outside of the project and of its configuration."""
        if is_trusted(self.files):
            return False
        above = Path(os.path.dirname(os.path.abspath(entry.file)))
        roots = {find_project(self.file, self.files)}
        roots |= {None if is_shared(above, self.files) else above}
        real = Path(self.files.resolve_links(entry.folder))
        known = (Path(self.files.resolve_links(root)) for root in roots if root is not None)
        return not any(is_within(real, root) for root in known)

    @property
    def own(self) -> tuple[str, Path] | None:
        """Return name and folder of the package of the description; None without a package."""
        return find_own_package(self.file, self.files)

    def find(self, name: str) -> Path:
        """Return the folder of a package.

        Raises:
            PackageNotFound: It was not found; the notes list the searched places.
        """
        if name in self.used:
            return self.used[name]
        if name in ("", ".", "..") or "/" in name or os.sep in name:
            raise PackageNotFound(
                f"'{name}' is not a package name",
                rule="package-not-found",
            )
        if name not in self._missing:
            searched: list[str] = []
            for where, folder in self._list_candidates(name):
                if folder is not None and self.files.is_folder(folder):
                    self.used[name] = folder
                    return folder
                searched.append(where)
            self._missing[name] = self.suggest_package(name), searched
        near, searched = self._missing[name]
        meant = f"did you mean '{near}'? Otherwise " if near else ""
        raise PackageNotFound(
            f"package '{name}' is not found; {meant}set its folder with --package {name}=DIR "
            "or --package-path DIR",
            notes=[f"searched {where}" for where in searched],
            rule="package-not-found",
        )

    def suggest_package(self, name: str) -> str:
        """Return the package of the workspace whose name is nearest; empty if none is near."""
        own = self.own
        known = [own[0]] if own else []
        for root in (*self.paths, *self._list_workspace_roots(own[1] if own else None)):
            known += self._find_packages(root)
        near = find_nearest(name, (*known, *self.named, *self.configured), 0.8)
        stems = [_ENDING.sub("", one) for one in (name, near)]  # ur_description is not pr2_…
        alike = fold(name) == fold(near) or stems[0] == stems[1]
        if stems[0] == name and stems[1] != near:  # the ending may be what is misspelled
            alike = alike or find_nearest(name, (near,), 0.9) != ""
        return near if alike or find_nearest(stems[0], stems[1:], 0.8) else ""

    def list_neighbors(self) -> list[Path]:
        """Return the folders of the packages around the file, its own first.

        Without a package, return the folder of the file.
        """
        own = self.own
        if own is None:
            return [self.file.parent]
        roots = self._list_workspace_roots(own[1])
        siblings = [folder for root in roots for folder in self._find_packages(root).values()]
        return list(dict.fromkeys([own[1], *siblings]))

    def find_folder_with(self, name: str, inner: str) -> Path | None:
        """Return a folder near the file that contains a file at a path below it; None if none does.

        Searched are the folders above the file, folders called ``name`` in the two nearest of them,
        and packages nearby. This finds files whose package has been renamed.

        Args:
            name: Name of the package in a URI; PyBullet interprets it as a folder near the file.
            inner: Path after the name.
        """
        if (name, inner) not in self._near:
            key = Packages.find_folder_with, self.file, name, inner
            self._near[name, inner] = self.files.memoize(
                key, lambda files: self.with_workspace(files)._find_folder_with(name, inner)
            )
        return self._near[name, inner]

    def _find_folder_with(self, name: str, inner: str) -> Path | None:
        inner = inner.lstrip("/")
        own = self.own
        roots = self._list_workspace_roots(own[1] if own else None)
        above = [folder for folder in self.file.parents if len(folder.parts) > 2][:_MAX_CLIMB]
        siblings = [folder for root in roots for folder in self._find_packages(root).values()]
        parts = inner.split("/")
        named = [folder / name for folder in above[:2]]
        for folder in (*above, *named, *siblings) if inner and ".." not in parts else ():
            if self.files.is_file(folder / inner):
                return folder
        return None

    def _find_folder_named(self, name: str, inner: str) -> Path | None:
        """Return the only folder of a name near the description that contains a file.

        PyBullet reads ``package://meshes/arm.stl`` as the file ``meshes/arm.stl`` next to the
        description or above it. None if no folder or several contain the file.
        """
        if name in self.assumed:
            return self.assumed[name]
        if not inner or {"", ".", ".."} & {name, *inner.split("/")}:
            return None
        above = [folder for folder in self.file.parents if len(folder.parts) > 2][:_NEAR]
        files = self.files
        folders = [folder / name for folder in above if files.is_file(folder / name / inner)]
        if len({files.resolve_links(folder) for folder in folders}) != 1:
            return None
        self.assumed[name] = folders[0]
        return folders[0]

    def _list_candidates(self, name: str) -> Iterator[tuple[str, Path | None]]:
        """Yield each searched place: its text for the notes, and the folder, if it exists."""
        yield from self._list_packages(name)
        for folder in self.file.parents:
            if folder.name == name:
                yield f"a folder above the file named {name}", folder
        yield f"for a folder named '{name}' above the file", None

    def _list_packages(self, name: str) -> Iterator[tuple[str, Path | None]]:
        """Yield the places as :meth:`_list_candidates`, without folders above the file.

        Raises:
            PackageNotFound: A configuration that came with the description names a foreign folder.
        """
        if name in self.named:
            yield f"--package {name}={self.named[name]} (does not exist)", self.named[name]
        for path in self.paths:
            yield f"--package-path {path}", self._find_packages(path).get(name)
        own = self.own
        if own:
            yield (
                f"the file's own package '{own[0]}' in {self.shorten_path(own[1])}",
                own[1] if own[0] == name else None,
            )
        else:
            yield f"for a package.xml above {self.shorten_path(self.file)}", None
        for root in self._list_workspace_roots(own[1] if own else None):
            yield f"packages below {self.shorten_path(root)}", self._find_packages(root).get(name)
        if own and is_installed_as(own[1], name, self.files):
            yield f"the file's own package, which CMake installs as {name}", own[1]
        if name in self.configured:
            entry = self.configured[name]
            if isinstance(entry, ConfiguredFolder) and self._is_foreign(entry):
                raise PackageNotFound(
                    f"package '{name}' is set to {entry.folder} in {shorten_path(entry.file)}:"
                    f"{entry.line}, which is outside of the project; pass --package "
                    f"{name}={shorten_path(entry.folder)} to use it",
                    rule="package-not-found",
                )
            folder = Path(entry.folder if isinstance(entry, ConfiguredFolder) else entry)
            yield f"the configuration: {name} = {folder} (does not exist)", folder
        for variable in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"):
            value = self.files.read_variable(variable) or ""
            if not value:
                yield f"{variable} (not set)", None
            for entry in filter(None, value.split(os.pathsep)):
                if variable == "ROS_PACKAGE_PATH":
                    folder_or_none = self._find_packages(Path(entry)).get(name)
                else:
                    share = Path(entry) / "share" / name
                    folder_or_none = share if self.files.is_folder(share) else None
                yield f"{variable}: {entry}", folder_or_none
        for path in self.paths:  # a package of that name wins over a folder of that name
            yield f"a folder '{name}' in --package-path {path}", self._find_child(path, name)

    def _find_packages(self, folder: Path) -> dict[str, Path]:
        return find_packages(folder, self.files)

    def _find_child(self, path: Path, name: str) -> Path | None:
        """Return a folder of that name directly in a search path; it needs no ``package.xml``."""
        folder = path / name
        return folder if name and self.files.is_folder(folder) else None

    def _list_workspace_roots(self, package: Path | None) -> list[Path]:
        """Return the folders to search, from the parent of the package to the workspace root."""
        start = package.parent if package else self.file.parent
        repository = find_repository(package or start, self.files)
        # what is next to a repository belongs to others, except in a workspace
        is_own = repository is None or start.is_relative_to(repository)
        roots = []
        for folder in (start, *start.parents)[:_MAX_CLIMB]:
            if len(folder.parts) <= 2 or is_shared(folder, self.files):
                break  # do not search /, /tmp or the home folder
            roots.append(folder)
            if any(self.files.exists(folder / mark) for mark in _WORKSPACE_MARKS):
                return roots
        return roots[:1] if is_own else []

    def find_installed(self, path: str | Path) -> Path:
        """Return the source file that is installed at a path inside a found package.

        Returns:
            The path itself if it exists or no install rule applies to it.
        """
        path = Path(path)
        if self.files.exists_or_is_link(path):
            return path
        normal = Path(os.path.normpath(path))
        for name, folder in self.used.items():
            try:
                relative = normal.relative_to(folder)
            except ValueError:
                continue
            if name not in self._rules:
                self._rules[name] = read_install_rules(folder, name, self.files)
            if source := find_installed(self._rules[name], relative.as_posix(), self.files):
                return source
        return path

    def resolve(self, uri: str, relative_to: str | Path | None = None) -> Path:
        """Return the file of a URI or path, which may not exist.

        A missing package is replaced by a folder of its name if exactly one near the description
        contains the file; ``assumed`` then lists it.

        Args:
            uri: ``package://NAME/…``, ``model://NAME/…``, ``file://…`` or a path.
            relative_to: File to which a relative path refers; None is the description.

        Raises:
            PackageNotFound: The package was not found.
            AccessError: The file exists, and the description may not read it.
        """
        path = self.locate(uri, relative_to)
        reason = self.access.explain_refusal(path) if self.files.exists_or_is_link(path) else ""
        if reason:
            message = f"{shorten_path(path)} {reason}"
            raise AccessError(message, data={"reason": reason})
        return path

    def locate(self, uri: str, relative_to: str | Path | None = None) -> Path:
        """Return the place of a file, which is not read, as :meth:`resolve` does."""
        scheme, separator, rest = uri.partition("://")
        if separator and scheme in ("package", "model"):
            name, _, inner = rest.lstrip("/").partition("/")
            try:
                folder = self.find(name)
            except PackageNotFound as error:
                same = self._find_folder_named(name, inner) if scheme == "package" else None
                if same is not None:
                    return same / inner
                near = self.find_folder_with(name, inner)
                if near is None:
                    raise
                raise PackageNotFound(
                    f"package '{name}' is not found; {suggest_folder(name, near)}",
                    notes=error.notes,
                    rule=error.rule,
                ) from None
            return self.find_installed(folder / inner.lstrip("/"))
        if separator and scheme == "file":
            return self.find_installed(rest)
        above = (Path(os.path.abspath(relative_to)) if relative_to else self.file).parent
        if ".." in uri and not self.files.is_folder(above):
            return Path(os.path.normpath(self.files.resolve_links(above) + f"/{uri}"))
        return self.find_installed(above / uri)


def suggest_folder(name: str, folder: Path) -> str:
    """Return the remedy for a missing package whose file is in another folder."""
    shown = shorten_path(folder)
    return f"the file exists in {shown}; to use it, pass --package {name}={shown}"
