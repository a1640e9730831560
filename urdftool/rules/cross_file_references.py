"""Check whether other files refer to a part of a description, which then must not change alone."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterator
from itertools import islice
from pathlib import Path

from ..source.description import Description
from ..source.description_formats import XML_SUFFIXES
from ..source.packages import shorten_path
from ..workspace import Workspace, memoize_by_workspace
from .fix import FixContext, RefusedError

_USES = (".yaml", ".yml", ".json", ".py", ".launch", ".lua", ".rviz", ".cpp", ".hpp", ".h", ".srdf")

_MOST_FILES, _MOST_BYTES = 10_000, 2_000_000
"""Number of files, and bytes of each, that are searched for a name. Chosen, no source."""


def check_alone(context: FixContext, word: str, *, robots: bool, but: Collection[str] = ()) -> None:
    """Make sure that only the description's own files of the package refer to a word.

    Args:
        context: The robot and its description.
        word: The word, as a whole.
        robots: Whether to search other descriptions, which have links of the same names.
        but: Files that are changed too.

    Raises:
        RefusedError: Another file refers to it.
    """
    real_path = context.workspace.resolve_links
    mine = {real_path(file.path) for file in context.description.files}
    mine.update(map(real_path, but))
    for number, file in enumerate(context.list_nearby(_list_files)):
        if number >= _MOST_FILES:
            raise RefusedError(
                f"too many files around the description to search them for references to '{word}'"
            )
        path = file.path
        named = path.endswith(_USES) or (path.endswith(XML_SUFFIXES) and robots)
        if named and file.contains_word(word) and real_path(path) not in mine:
            raise RefusedError(f"{shorten_path(path)} refers to '{word}' too")


_PLAIN = re.compile(rb"[\w-]+")


class _File:
    """A file near the description, and its words, which are read once."""

    __slots__ = ("_found", "path", "workspace")

    def __init__(self, workspace: Workspace, path: str) -> None:
        """Store the path; the file is read later."""
        self.workspace = workspace
        self.path = path
        self._found: frozenset[bytes] | None = None

    def contains_word(self, word: str) -> bool:
        """Tell whether the file contains a word."""
        sought = word.encode()
        try:
            if _PLAIN.fullmatch(sought) is not None:
                if self._found is None:
                    self._found = _read_words(self.workspace, self.path)
                return sought in self._found
            data = self.workspace.read_bytes(self.path)[:_MOST_BYTES]
        except OSError:
            return False
        pattern = rb"(?<![\w-])" + re.escape(sought) + rb"(?![\w-])"
        return sought in data and re.search(pattern, data) is not None


@memoize_by_workspace
def _read_words(workspace: Workspace, path: str) -> frozenset[bytes]:
    """List the words of a file.

    Raises:
        OSError: The file cannot be read.
    """
    return frozenset(_PLAIN.findall(workspace.read_bytes(path)[:_MOST_BYTES]))


_INCLUDE = re.compile(rb"<(?:\w+:)?include\b[^<>]*?filename\s*=\s*[\"']([^\"']*)[\"']")


def check_not_included(context: FixContext) -> None:
    """Make sure that no other robot includes the description, and so would get an added element.

    Raises:
        RefusedError: Another robot includes it.
    """
    user = find_including_file(context.description)
    if user:
        name = context.description.packages.file.name
        raise RefusedError(f"{user} includes {name}, and would get the element too")


def find_including_file(description: Description, *, computed: bool = False) -> str:
    """Find a xacro file that includes a description; empty if none does.

    It searches the packages of the workspace: a gripper that is a robot by itself for tests is
    often part of an arm in another package.

    Args:
        description: The description.
        computed: Whether a file counts that includes one of a computed name which ends like it.
    """
    packages, workspace = description.packages, description.workspace
    file, own = packages.file, packages.own
    for folder in packages.list_neighbors():
        includes = _find_includes(workspace, str(folder))
        for user, reference in includes.get(file.name, ()):
            found = _FIND.match(reference)
            if found is not None:
                is_this = own is not None and found[1] == own[0]
            else:
                there = os.path.join(os.path.dirname(user), reference)
                real_path = workspace.resolve_links
                is_this = "$" in reference or real_path(there) == real_path(file)
            if is_this:
                return shorten_path(user)
        for name, uses in includes.items() if computed else ():
            if "$" in name and file.name.endswith(_AFTER_EXPRESSION.sub("", name)):
                return shorten_path(uses[0][0])
    return ""


_AFTER_EXPRESSION = re.compile(r"^.*[)}]", re.DOTALL)
_FIND = re.compile(r"\$\(find\s+([\w.-]+)\s*\)")


@memoize_by_workspace
def _find_includes(workspace: Workspace, folder: str) -> dict[str, list[tuple[str, str]]]:
    """List the includes of xacro files in a folder, by file name: the including file and words."""
    found: dict[str, list[tuple[str, str]]] = {}
    for number, path in enumerate(_find_files_below(workspace, folder)):
        if number >= _MOST_FILES:
            break
        if not path.endswith((".xacro", ".urdf")):
            continue
        try:
            data = workspace.read_bytes(path)[:_MOST_BYTES]
        except OSError:
            continue
        for match in _INCLUDE.finditer(data):
            reference = match[1].decode("utf-8", "replace").strip()
            found.setdefault(reference.rpartition("/")[2], []).append((path, reference))
    return found


def _list_files(context: FixContext) -> list[_File]:
    """List the files of the description's package, or of its folder, up to a limit."""
    own = context.description.packages.own
    root = own[1] if own is not None else context.description.packages.file.parent
    found = islice(_find_files_below(context.workspace, root), _MOST_FILES + 1)
    return [_File(context.workspace, path) for path in found]


def _find_files_below(workspace: Workspace, root: str | Path) -> Iterator[str]:
    for where, folders, files in workspace.walk(root):
        folders[:] = sorted(folder for folder in folders if not folder.startswith("."))
        for file in sorted(files):
            yield os.path.join(where, file)
