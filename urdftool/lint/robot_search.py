"""Search of the robots below folders: which files are robots, with which arguments.

Below a folder, robots are

- ``.urdf`` and ``.urdf.xacro`` files, except for xacro files that another file includes and whose
  ``<robot>`` has no name, and for URDF files that use arguments without declaring one while another
  file includes files by computed names,
- other ``.xacro`` files whose ``<robot>`` has a name, that have links or call macros, and that no
  other file includes,
- files that the configuration names (``lint.robots``, ``lint.variants``),
- files that a launch file or a ``CMakeLists.txt`` expands; the arguments that it passes are
  variants.

Files are read, not expanded: that a file has no link is known only after it was checked.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ..configuration import Configuration, find_configuration
from ..errors import ConfigError, UrdftoolError
from ..rules.unexpanded import is_part
from ..source.document import Element, parse, read_file
from ..source.packages import Packages
from ..source.xacro_names import CONDITIONS
from ..workspace import Workspace
from .discover import ENDINGS, has_ending, list_files
from .launches import UNKNOWN, Use, read_uses
from .repository import Repository, RobotFile
from .variants import list_variant_files

_DEFINITIONS = frozenset(f"xacro:{word}" for word in ("macro", "property", "arg", "include"))
_FIND = re.compile(r"^(?:file://)?\$\(find ([\w.-]+)\)/")
_AFTER_EXPRESSION = re.compile(r"^.*(?:\)|\}|\*)", re.DOTALL)
_LAUNCHES = (".launch", ".launch.py", ".launch.xml", "_launch.py", "_launch.xml", "CMakeLists.txt")
_MOST_BYTES = 1 << 20
"""Size [bytes] above which a launch file is not read; chosen."""


def find_robots(
    folders: Sequence[str],
    *,
    config: str | None = None,
    packages: Mapping[str, str | Path] | None = None,
    package_paths: Iterable[str | Path] = (),
    workspace: Workspace,
) -> Repository:
    """Find the robots below folders.

    Raises:
        ConfigError: The configuration is invalid, or names a file that does not exist.
    """
    search = _Search(Repository(), config, packages or {}, tuple(package_paths), workspace)
    for folder in folders:
        for path in list_files(folder, (".urdf", ".xacro"), search.found.links):
            search.add_file(path)
    search.add_by_content()
    for folder in folders:
        search.add_configured(folder)
        for path in list_files(folder, _LAUNCHES):
            search.add_launch(path)
    return search.found


@dataclass
class _Search:
    """State of the search.

    Attributes:
        found: The result.
        config: Configuration file named by the user.
        packages: Folders of ROS packages by name.
        package_paths: Folders that contain ROS packages.
        workspace: Access to files.
        candidates: Why a ``.xacro`` file may be a robot by its content, by resolved path.
        nameless: Resolved paths of xacro files whose ``<robot>`` has no name.
        tails: Ends of the names that xacro computes for the files of ``<xacro:include>``, or that
            are in a package which is not found, after the last expression, by the resolved path of
            the file that includes.
    """

    found: Repository
    config: str | None
    packages: Mapping[str, str | Path]
    package_paths: tuple[str | Path, ...]
    workspace: Workspace
    candidates: dict[str, str] = field(default_factory=dict)
    nameless: set[str] = field(default_factory=set)
    tails: dict[str, list[str]] = field(default_factory=dict)

    def make_packages(self, path: str) -> Packages:
        """Return a finder of packages for a file."""
        configured = find_configuration(path, self.config, self.workspace).packages
        return Packages(
            path,
            named=self.packages,
            paths=self.package_paths,
            configured=configured,
            workspace=self.workspace,
        )

    def add_file(self, path: str) -> None:
        """Record a file, what it includes, and whether it is a robot by its name or content."""
        real = os.path.realpath(path)
        if real in self.found.paths:
            return
        self.found.paths[real] = path
        if has_ending(path, *ENDINGS):
            self.found.robots[real] = RobotFile(path, "by its name")
        if has_ending(path, ".urdf") and not self._may_be_part(path):
            return
        try:
            root = parse(read_file(path, self.workspace)).root
        except UrdftoolError:
            if has_ending(path, ".xacro"):
                self.candidates[real] = "it is not well-formed, and no file includes it"
            return
        if has_ending(path, ".urdf"):
            self.found.parts |= {real} if is_part(root) else set()
            return
        self.found.includes[real] = list(self._resolve_includes(path, real, root))
        if not root.get("name"):
            self.nameless.add(real)
        if not has_ending(path, *ENDINGS) and root.get("name") and _has_content(root):
            self.candidates[real] = "its <robot> has a name and links, and no file includes it"

    def _may_be_part(self, path: str) -> bool:
        """Tell whether a URDF file has text of an argument of xacro."""
        try:
            return b"$(arg " in read_file(path, self.workspace).data
        except UrdftoolError:
            return False

    def _resolve_includes(self, path: str, real: str, root: Element) -> Iterator[str]:
        """Yield the resolved paths of the files that a file includes."""
        packages = self.make_packages(path)
        for element in root.walk():
            target = (element.get("filename") or "").strip()
            if element.tag not in ("xacro:include", "include") or not target:
                continue
            match = _FIND.match(target)
            try:
                if match is not None:
                    target = os.path.join(packages.find(match[1]), target[match.end() :])
            except UrdftoolError:
                self.tails.setdefault(real, []).append(_AFTER_EXPRESSION.sub("", target))
                continue
            if "$" in target or "*" in target:
                self.found.computes.add(real)
                self.tails.setdefault(real, []).append(_AFTER_EXPRESSION.sub("", target))
                continue
            target = os.path.join(os.path.dirname(path), target)
            yield os.path.realpath(packages.find_installed(target))

    def add_by_content(self) -> None:
        """Add the candidates that no other file includes."""
        self._add_computed_includes()
        included = {
            path for real, paths in self.found.includes.items() for path in paths if path != real
        }
        if not self.found.computes:
            self.found.parts.clear()
        for real in self.nameless & included | self.found.parts:
            self.found.robots.pop(real, None)
        for real, why in self.candidates.items():
            if real not in included:
                self.found.robots[real] = RobotFile(self.found.paths[real], why)

    def _add_computed_includes(self) -> None:
        """Record the files whose path ends as a computed name does: ``$(arg dir)/arm.xacro``."""
        for real, tails in self.tails.items():
            ends = tuple(tail for tail in tails if tail.startswith("/") and len(tail) > 1)
            also = [path for path in self.found.paths if path != real and path.endswith(ends)]
            self.found.includes[real] += also if ends else []

    def add_configured(self, folder: str) -> None:
        """Add the files that the configurations of a folder and below it name."""
        places = {os.path.join(folder, "-"), *self.found.paths.values()}
        tables: dict[str, Configuration] = {}
        for place in places:
            configuration = find_configuration(place, self.config, self.workspace)
            if configuration.path:
                tables[configuration.path] = configuration
        for path, configuration in sorted(tables.items()):
            for name in [*_list_named(configuration), *list_variant_files(configuration)]:
                self._add(os.path.join(os.path.dirname(os.path.abspath(path)), name), path, folder)

    def _add(self, path: str, why: str, folder: str) -> RobotFile | None:
        """Add a robot that another file names; None if it is not below the folder."""
        real = os.path.realpath(path)
        inside = os.path.realpath(folder) + os.sep
        if real not in self.found.robots and real in self.found.paths:
            self.found.robots[real] = RobotFile(self.found.paths[real], f"named by {why}")
        elif real not in self.found.robots and real.startswith(inside) and os.path.isfile(real):
            shown = os.path.normpath(os.path.join(folder, os.path.relpath(real, inside)))
            self.found.robots[real] = RobotFile(shown, f"named by {why}")
        return self.found.robots.get(real)

    def add_launch(self, path: str) -> None:
        """Add the descriptions that a launch file or a build uses."""
        try:
            data = read_file(path, self.workspace).data
        except UrdftoolError:
            return
        if len(data) > _MOST_BYTES or (b"xacro" not in data and b".urdf" not in data):
            return
        packages = self.make_packages(path)

        def find(name: str) -> str | None:
            try:
                return str(packages.find(name))
            except UrdftoolError:
                return None

        for use in read_uses(path, data.decode("utf-8", "replace"), find):
            self._add_use(path, use, packages)

    def _add_use(self, path: str, use: Use, packages: Packages) -> None:
        place = f"{path}:{use.line}"
        if UNKNOWN in use.target:
            self.found.unknown.append(place)
            return
        target = os.path.join(os.path.dirname(path), use.target)
        real = os.path.realpath(packages.find_installed(target))
        robot = self.found.robots.get(real)
        if robot is None and real in self.found.paths:
            robot = RobotFile(self.found.paths[real], f"expanded by {place}")
            self.found.robots[real] = robot
        arguments = dict(use.arguments)
        if robot is None or not (has_ending(real, ".xacro") or arguments):
            return
        if arguments not in robot.variants:
            robot.variants.append(arguments)
            robot.places.append(place)
        robot.computed.update(dict.fromkeys(use.computed, place))


def _has_content(root: Element) -> bool:
    """Tell whether a file has links or calls macros outside of its macros."""
    todo = list(root.children)
    while todo:
        element = todo.pop()
        if element.tag == "link":
            return True
        if element.tag in CONDITIONS:
            todo += element.children
        elif element.tag.startswith("xacro:") and element.tag not in _DEFINITIONS:
            return True
    return False


def _list_named(configuration: Configuration) -> list[str]:
    """Return the files of ``lint.robots``, relative to the configuration.

    Raises:
        ConfigError: It is not a list of names, or a file does not exist.
    """
    names = configuration.lint.get("robots", [])
    path = configuration.path
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise ConfigError("lint.robots must be a list of files", path=path)
    folder = os.path.dirname(os.path.abspath(path)) if path else os.getcwd()
    for name in names:
        if not os.path.isfile(os.path.join(folder, name)):
            raise ConfigError(f"lint.robots: file {name} does not exist", path=path)
    return names
