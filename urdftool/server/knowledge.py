"""Open documents, the robots of the workspace, and what was read of each at its last check."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..errors import SourceError, UrdftoolError
from ..formats.detect import read_other_format
from ..lint.options import Options
from ..lint.repository import Repository
from ..lint.robot_search import find_robots
from ..lint.settings import Settings, check_selectors, check_targets
from ..model.elements import Robot
from ..projects import find_project
from ..source.description import Description
from ..source.description_formats import OWN_XML_SUFFIXES
from ..source.document import Document, parse, read_file
from ..source.expansion_server import ExpansionServer
from ..source.location import SourceFile
from ..source.packages import Packages
from ..workspace import Workspace
from .positions import LineTable
from .repair import repair_xml
from .words import WordTable

MOST_ROBOTS = 8
"""Robots that are checked for one file of macros; chosen: a check takes up to 0.2 s."""

MOST_BYTES = 4 << 20
"""Size [bytes] of a document that is checked while it is edited, and whose names are known; chosen:
the largest of 219 has 142 kB, and a check of 2 MB takes 30 s."""

_NOT_ALONE = (".srdf", ".srdf.xacro")
_ROOT = re.compile(rb"<(robot|mujoco|sdf)[\s>/]")
_DECLARED = re.compile(r"<\?xml[^>]*?encoding\s*=\s*[\"']([\w.:-]+)")


@dataclass
class RobotState:
    """What was read of a robot.

    Attributes:
        descriptions: Description and robot of each set of arguments; the last that could be read.
        files: Resolved paths of its files.
        version: Number of changes of documents after which it was read.
        reported: Resolved paths of the files with a finding of the last check, such as its SRDF.
    """

    descriptions: list[tuple[Description, Robot]] = field(default_factory=list)
    files: set[str] = field(default_factory=set)
    version: int = -1
    reported: set[str] = field(default_factory=set)


class Knowledge:
    """State of the checking process.

    Attributes:
        encoding: Unit of columns of the editor.
        states: State by resolved path of each checked robot.
        version: Number of changes of documents and files.
        read_robots: Reads the robots of a file, if that was not done since the last change.
        expansion_server: Process that prepares expansions between two changes.
    """

    def __init__(self) -> None:
        """Create a state without documents and folders."""
        self.encoding = "utf-16"
        self.states: dict[str, RobotState] = {}
        self.version = 0
        self.memo: dict[Any, Any] = {}
        self._texts: dict[str, bytes] = {}
        self._folders: tuple[str, ...] = ()
        self._options = Options(read_other=read_other_format)
        self.expansion_server = ExpansionServer()
        self._base = self._make_base()
        self._repositories: dict[str, Repository] = {}
        self._workspace: Workspace | None = None
        self.read_robots: Callable[[str], None] = lambda path: None
        self._words: dict[str, tuple[bytes, WordTable | None]] = {}
        self._paths: dict[str, str] = {}

    # Documents and settings ----------------------------------------------------------------

    def configure(
        self,
        encoding: str,
        folders: Iterable[str],
        packages: dict[str, str],
        package_paths: Iterable[str],
        targets: Iterable[str],
        select: Iterable[str] | None,
        ignore: Iterable[str],
    ) -> None:
        """Store the settings of the editor.

        Raises:
            ConfigError: A rule or target is unknown.
        """
        self.encoding, self._folders = encoding, tuple(folders)
        chosen = Settings(
            select=None if select is None else check_selectors(select),
            ignore=check_selectors(ignore),
            targets=check_targets(targets),
        )
        self._options = Options(chosen, packages=packages, package_paths=tuple(package_paths))
        self._options.read_other = read_other_format
        self.refresh()

    def set_document(self, path: str, text: str | None) -> None:
        """Store the text of an open document; None for one that was closed."""
        key = os.path.realpath(path)
        is_new = text is not None and key not in self._texts and self._is_unknown(key)
        if text is None:
            self._texts.pop(key, None)
        else:
            self._texts[key] = _encode(text)
        if is_new:
            self.refresh()
        else:
            self._forget()

    def _is_unknown(self, real: str) -> bool:
        """Tell whether the robots of a folder were found, and a file is none of their files.

        It may have been written since then: not every editor reports new files.
        """
        found = self._repositories.values()
        return bool(found) and not any(
            real in one.robots or any(real in one.list_files(robot) for robot in one.robots)
            for one in found
        )

    def refresh(self) -> None:
        """Forget what was read from the disk, which has changed."""
        self._base = self._make_base()
        self._repositories = {}
        self._paths = {}
        self._forget()

    def _make_base(self) -> Workspace:
        base = Workspace()
        base.expansion_server = self.expansion_server
        return base

    def _forget(self) -> None:
        self.version += 1
        self._workspace = None
        self.memo = {}

    @property
    def workspace(self) -> Workspace:
        """Return access to files, with the texts of open documents."""
        if self._workspace is None:
            self._workspace = self._base.get_with_overlay(self._texts)
        return self._workspace

    def make_workspace(self, contents: Mapping[str, bytes]) -> Workspace:
        """Return access to files with other contents, by resolved path, of some of them."""
        return self._base.get_with_overlay({**self._texts, **contents})

    def is_in_workspace(self, path: str) -> bool:
        """Tell whether a file is in a folder of the workspace, or in the project of a document."""
        real = os.path.realpath(path)
        folders = [os.path.realpath(folder) for folder in self._folders]
        projects = [find_project(one, self._base) for one in self._texts]
        folders += [os.path.realpath(one) for one in projects if one is not None]
        return real in self._texts or any(real.startswith(one + os.sep) for one in folders)

    def is_open(self, real: str) -> bool:
        """Tell whether a resolved path is an open document."""
        return real in self._texts

    def make_options(self, real: str) -> Options:
        """Return the options of a check of a robot, by its resolved path."""
        from dataclasses import replace

        repository = self.get_repository(real)
        robot = repository.robots.get(real)
        variants = {real: robot.variants} if robot is not None and robot.variants else {}
        return replace(self._options, workspace=self.workspace, variants=variants)

    # Files ---------------------------------------------------------------------------------

    def get_repository(self, path: str) -> Repository:
        """Return the robots of the folder of the workspace, or of the project, around a file."""
        real = os.path.realpath(path)
        inside = [
            folder
            for folder in map(os.path.realpath, self._folders)
            if real.startswith(folder + os.sep)
        ]
        project = None if inside else find_project(real, self._base)
        folder = max(inside, key=len) if inside else str(project) if project else ""
        if folder not in self._repositories:
            self._repositories[folder] = self._find_robots(folder) if folder else Repository()
        return self._repositories[folder]

    def _find_robots(self, folder: str) -> Repository:
        try:
            return find_robots(
                [folder],
                packages=self._options.packages,
                package_paths=self._options.package_paths,
                workspace=self._base,
            )
        except UrdftoolError:  # each check reports a wrong configuration
            return Repository()

    def list_robots(self, path: str) -> list[str]:
        """Return the resolved paths of the robots that a file is or belongs to.

        Robots that are open come first; at most ``MOST_ROBOTS`` include it.
        """
        real = os.path.realpath(path)
        repository = self.get_repository(real)
        found = [
            robot
            for robot in repository.robots
            if robot != real
            and (real in repository.list_files(robot) or real in self._get_files(robot))
        ]
        found.sort(key=lambda robot: not self.is_open(robot))
        return [*([real] if real in repository.robots else []), *found[:MOST_ROBOTS]]

    def list_reporting_robots(self, path: str) -> list[str]:
        """Return the resolved paths of the robots with a finding in a file, such as an SRDF."""
        real = os.path.realpath(path)
        return [robot for robot, state in self.states.items() if real in state.reported]

    def _get_files(self, robot: str) -> set[str]:
        state = self.states.get(robot)
        return set() if state is None else state.files

    def is_large(self, path: str) -> bool:
        """Tell whether a file is too large to be checked while it is edited."""
        size = self.workspace.get_size(os.path.realpath(path))
        return size is not None and size > MOST_BYTES

    def is_description(self, path: str) -> bool:
        """Tell whether a file that belongs to no robot can be checked by itself."""
        name = os.path.basename(path)
        if name.endswith(_NOT_ALONE) or name == "package.xml":
            return False
        if name.endswith(OWN_XML_SUFFIXES):
            return True
        return name.endswith(".xml") and bool(_ROOT.search(self.read(path).data[:4096]))

    def read(self, path: str) -> SourceFile:
        """Return a file as the editor has it; an empty one if it cannot be read."""
        try:
            return read_file(os.path.realpath(path), self.workspace)
        except SourceError:
            return SourceFile(path, self._texts.get(os.path.realpath(path), b""))

    def parse(self, path: str) -> Document | None:
        """Return the source tree of a file; None if it is not well-formed."""
        key = "document", os.path.realpath(path)
        if key not in self.memo:
            try:
                self.memo[key] = parse(self.read(path))
            except SourceError:
                self.memo[key] = None
        found: Document | None = self.memo[key]
        return found

    def parse_leniently(self, path: str) -> Document | None:
        """Return the source tree of a file, without half-typed tags; None if that fails."""
        found = self.parse(path)
        if found is not None:
            return found
        file = self.read(path)
        try:
            return parse(SourceFile(file.path, repair_xml(file.data), file.encoding))
        except SourceError:
            return None

    def get_words(self, path: str) -> WordTable | None:
        """Return the names in a file; None if it is too large, or cannot be parsed at all."""
        real, data = os.path.realpath(path), self.read(path).data
        if len(data) > MOST_BYTES:
            return None
        known = self._words.get(real)
        if known is None or known[0] != data:
            document = self.parse_leniently(path)
            known = data, None if document is None else WordTable(document)
            self._words[real] = known
        return known[1]

    def make_packages(self, path: str) -> Packages:
        """Return a finder of packages for a file that no robot has."""
        options = self._options
        return Packages(
            path, named=options.packages, paths=options.package_paths, workspace=self.workspace
        )

    def list_connected(self, path: str) -> list[str]:
        """Return the resolved paths of the files that a robot has together with a file."""
        real = os.path.realpath(path)
        repository = self.get_repository(real)
        found = {real: None, **dict.fromkeys(sorted(repository.list_files(real)))}
        for other in repository.includes:
            files = repository.list_files(other)
            if real in files:
                found.update(dict.fromkeys(sorted(files)))
        for state in self.list_states(path):
            found.update(dict.fromkeys(sorted(state.files)))
        return list(found)

    def make_table(self, file: SourceFile) -> LineTable:
        """Return the lines of a file, in the unit of the editor."""
        key = "lines", id(file)
        if key not in self.memo:
            self.memo[key] = LineTable(file, self.encoding), file  # keeps the id in use
        table: LineTable = self.memo[key][0]
        return table

    def get_path(self, path: str) -> str:
        """Return a path as :func:`make_path`, computed once until the disk changes."""
        if path not in self._paths:
            self._paths[path] = make_path(path)
        return self._paths[path]

    def get_offset(self, params: dict[str, Any]) -> int:
        """Return the byte of the position of a question."""
        return self.make_table(self.read(params["path"])).get_offset(params["position"])

    def list_states(self, path: str) -> list[RobotState]:
        """Return what was read of the robots that a file belongs to."""
        real = os.path.realpath(path)
        return [state for state in self.states.values() if real in state.files]

    def list_descriptions(self, path: str) -> list[tuple[Description, Robot]]:
        """Return descriptions and robots that a file belongs to, for each set of arguments."""
        return [pair for state in self.list_states(path) for pair in state.descriptions]

    def read_descriptions(self, path: str) -> list[tuple[Description, Robot]]:
        """Read the robots of a file where necessary, and return them."""
        self.read_robots(path)
        return self.list_descriptions(path)


def _encode(text: str) -> bytes:
    """Return the bytes of a text in the encoding that its first line declares."""
    declared = _DECLARED.match(text[:200])
    try:
        return text.encode(declared[1] if declared else "utf-8", "surrogatepass")
    except (LookupError, UnicodeEncodeError):
        return text.encode("utf-8", "replace")


def make_path(path: str | Path) -> str:
    """Return a path as the editor knows it, without symbolic links."""
    return os.path.realpath(path)
