"""Files, packages and variables that an expansion requests."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Hashable
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from ..control_characters import LINES, escape_controls
from ..errors import XacroError
from ..suggestions import find_nearest
from .document import read_included_file
from .location import SourceFile
from .packages import Packages
from .sandbox import Sandbox
from .yaml_bounds import MAX_BYTES

if TYPE_CHECKING:
    from .expansion_server import ExpansionServer

T = TypeVar("T")

_MAX_FOLDERS = 6
"""Maximum number of folders after a wildcard; chosen, each may list the folders of all before."""

_MAX_MESSAGES = 10_000  # characters; chosen
_MAX_SEARCHED = 1000  # folders of a package that are searched for a missing file; chosen


class ExpansionFiles:
    """Answers to the requests of an expansion, by the rules of the sandbox.

    Attributes:
        files: XML files that were read, the description itself first.
        messages: Messages of the description, each with its line end.
    """

    def __init__(self, file: SourceFile, packages: Packages) -> None:
        """Set the description and the finder of its packages."""
        self.files = [file]
        self.messages: list[str] = []
        self._packages = packages
        self._sandbox = Sandbox(packages)
        self._indices = {file.path: 0}
        self._read: set[str] = set()
        self._length = 0

    @property
    def trusted(self) -> bool:
        """Tell whether the description is trusted."""
        return self._sandbox.trusted

    @property
    def expansion_server(self) -> ExpansionServer | None:
        """Return the process that prepares expansions; None if the workspace has none."""
        server: ExpansionServer | None = self._packages.workspace.expansion_server
        return server

    @property
    def requests(self) -> dict[str, Callable[..., Any]]:
        """Return the functions that an expansion may request, by name."""
        return {
            "find": self.find_package,
            "locate": self.locate_file,
            "include": self.read_xml,
            "yaml": self.read_yaml,
            "match": self.list_matches,
            "env": self._sandbox.read_variable,
            "optenv": self._sandbox.read_optional_variable,
            "suggest": self.suggest_path,
            "message": self.add_message,
        }

    def get_kept(self, key: Hashable, make: Callable[[], T]) -> T:
        """Return a value that the workspace keeps for the next expansion."""
        return self._packages.files.memoize(key, lambda _: make())

    def find_package(self, name: str) -> str:
        """Return the folder of a package.

        Raises:
            PackageNotFound: It was not found.
        """
        return str(self._packages.find(name))

    def locate_file(self, path: str) -> str:
        """Return a path, or that of its source by the install rules if it does not exist."""
        there = self._packages.workspace.exists(path)
        return path if there else str(self._packages.find_installed(path))

    def read_xml(self, path: str) -> tuple[int, SourceFile]:
        """Return a file to include, and its index in ``files``.

        Raises:
            XacroError: The description may not read it.
            SourceError: It cannot be read.
        """
        installed = self._packages.shorten_path(self._packages.find_installed(path))
        if installed not in self._indices:
            self._sandbox.check_file(installed)
            self.files.append(read_included_file(installed, self._packages.workspace))
            self._indices[installed] = len(self.files) - 1
        index = self._indices[installed]
        return index, self.files[index]

    def read_yaml(self, path: str) -> bytes:
        """Return the contents of a YAML file.

        Raises:
            XacroError: The description may not read it, or it is larger than ``MAX_BYTES``.
            OSError: It cannot be read.
        """
        self._sandbox.check_file(path)
        self._read.add(self._packages.shorten_path(self._packages.find_installed(path)))
        with self._packages.workspace.open(path) as stream:
            data = stream.read(MAX_BYTES + 1)
        if len(data) > MAX_BYTES:
            raise XacroError(
                f"{path}: the file has more than {MAX_BYTES} bytes, the limit of YAML in a "
                "description",
                rule="expansion-failed",
            )
        return data

    def list_matches(self, pattern: str) -> list[str]:
        """Return the paths that match a pattern.

        Raises:
            XacroError: The description may not read the folder.
        """
        fixed, *rest = re.split(r"(?=[*[?])", pattern, maxsplit=1)
        below = "".join(rest).split("/")
        if ".." in below or len(below) > _MAX_FOLDERS:
            raise XacroError(
                f"the folders after a wildcard cannot be '..' or more than {_MAX_FOLDERS}",
                rule="include-not-found",
            )
        self._sandbox.check_file(os.path.dirname(fixed) or ".")
        paths = self._packages.workspace.match(pattern)
        # a link that matches may lead to the folders of others
        return [path for path in paths if not self._packages.access.explain_refusal(path)]

    def suggest_path(self, path: str) -> tuple[str, str]:
        """Return what helps to correct the path of a file that cannot be read.

        Returns:
            The first missing folder of the path, and what is meant, if the description may read
            it: the only file of that name in the package, relative to the folder, or the nearest
            name in the folder; empty if there is none.
        """
        folder, name = os.path.split(path)
        workspace = self._packages.workspace
        try:
            self._sandbox.check_file(folder or ".")
            there = [entry.name for entry in workspace.list_folder(folder or ".")]
        except XacroError:
            return "", ""
        except OSError:
            above = reversed(Path(path).parents)
            return str(next((p for p in above if not workspace.exists(p)), "")), ""
        same = self._list_same_names(path)
        if same:  # these are more likely than a file of another name
            return "", os.path.relpath(same[0], folder) if len(same) == 1 else ""
        return "", find_nearest(name, there, 0.75) or ""

    def _list_same_names(self, path: str) -> list[str]:
        """Return the files of a package that have the name of a missing file."""
        own = self._packages.find_owner(Path(path))
        if own is None:
            return []
        found, name = [], os.path.basename(path)
        folders = self._packages.workspace.walk(str(own[1]))
        for where, below, names in islice(folders, _MAX_SEARCHED):
            below[:] = sorted(one for one in below if not one.startswith("."))
            if name in names:
                found.append(os.path.join(where, name))
        return [one for one in found if not self._packages.access.explain_refusal(Path(one))]

    def add_message(self, text: str) -> None:
        """Store a message of the description.

        Raises:
            XacroError: The messages exceed the limit of their size.
        """
        self._length += len(text) + 1
        if self._length > _MAX_MESSAGES:
            raise XacroError(
                f"the messages of the description exceed the limit of {_MAX_MESSAGES} characters",
                rule="endless-expansion",
            )
        self.messages.append(text + "\n")

    def print_messages(self) -> None:
        """Print the messages, with control characters escaped."""
        sys.stderr.write(escape_controls("".join(self.messages), LINES))

    def finish(self, included: list[str]) -> list[str]:
        """Return the paths of the included files that were read, each once."""
        find = self._packages.find_installed
        paths = dict.fromkeys(self._packages.shorten_path(find(path)) for path in included)
        return [path for path in paths if path in self._indices or path in self._read]
