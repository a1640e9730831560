"""File access of a run: overlay contents, recorded dependencies, memo.

A :class:`Workspace` is the only way in which a check reads files and environment variables. It
reads from an overlay of contents that are not on disk (standard input, a tentative fix, an editor
buffer), records each query so that a cache knows the dependencies of a result, and computes shared
values (the packages below a folder, the outline of a mesh) once.

No state is global: workspaces are independent of each other, and views of one workspace may be used
in several threads.
"""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Callable, Hashable, Iterator, Mapping
from fnmatch import fnmatchcase
from io import BytesIO
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple, Protocol, TypeVar, cast

from .dependencies import Dependencies, is_folder, list_code
from .file_access import IRREGULAR, AccessRefused, is_irregular, is_stream

if TYPE_CHECKING:
    from typing import Concatenate, ParamSpec

    P = ParamSpec("P")

T = TypeVar("T")

STDIN = "<stdin>"

MAX_BYTES = 256 << 20
"""Maximum size of a file that is read into memory; chosen."""

MAX_MATCHES = 2000
"""Maximum number of paths that a path with wildcards matches; chosen."""

MAX_TEXT_BYTES = 16 << 20
"""Maximum size of a text file, such as a manifest; chosen."""
"""Path of the contents of standard input in an overlay."""


class Entry(NamedTuple):
    """Entry of a folder: name, path, and whether it is a folder and a symbolic link."""

    name: str
    path: str
    is_folder: bool
    is_link: bool


class Access(Protocol):
    """Policy that decides which files a workspace reads."""

    @property
    def key(self) -> Hashable:
        """Identity of the policy: equal for policies that decide equally."""

    def explain_refusal(self, path: str | Path, files: Workspace) -> str:
        """Return why a file may not be read; empty if it may be.

        Args:
            path: The file or folder.
            files: The workspace that asks, without restriction.
        """


class Workspace:
    """Access to files and environment variables for one run.

    Attributes:
        dependencies: Queries made through this view; None if they are not recorded.
        expansion_server: Process that prepares expansions of xacro; None if each starts its own.
    """

    def __init__(self, overlay: Mapping[str, bytes] | None = None) -> None:
        """Create a workspace that records no dependencies."""
        self.dependencies: Dependencies | None = None
        self._overlay = {_get_key(path): data for path, data in (overlay or {}).items()}
        self._names = frozenset(map(os.path.basename, self._overlay))
        added = (path for path in self._overlay if not os.path.lexists(path))
        self._folders = frozenset(map(os.path.dirname, added))  # those listed with other names
        self._memos: dict[Hashable, dict[Hashable, tuple[Any, Dependencies]]] = {}
        self._access: Access | None = None
        self._base: Workspace | None = None
        self._copies = _Copies()
        self.expansion_server: Any = None

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle only the overlay and the restriction, for another process."""
        return _restore, (self._overlay, self._access)

    # Views ---------------------------------------------------------------------------------

    def with_record(self) -> Workspace:
        """Return a view with the same overlay and memo and its own dependency record."""
        view = self.restrict(self._access)
        view.dependencies = Dependencies()
        return view

    def restrict(self, access: Access | None) -> Workspace:
        """Return a view that opens only what a policy allows; it shares overlay and record.

        Values in the memo are shared with the views of equal policies.
        """
        view = Workspace.__new__(Workspace)
        view.__dict__.update(self.__dict__)
        view._access = access
        return view

    def with_empty_memo(self) -> Workspace:
        """Return a workspace with the same overlay and restriction, and an empty memo."""
        return _restore(self._overlay, self._access)

    def get_with_overlay(self, overlay: Mapping[str, bytes]) -> Workspace:
        """Return a workspace in which some files have other contents.

        It shares the memo entries that do not depend on those files.
        """
        other = _restore({**self._overlay, **overlay}, self._access)
        other._base = self
        other._copies = self._copies
        other.expansion_server = self.expansion_server
        return other

    # Memo ----------------------------------------------------------------------------------

    def memoize(self, key: Hashable, make: Callable[[Workspace], T]) -> T:
        """Return a value that depends on files, computing it at the first request.

        Args:
            key: Identity of the value.
            make: Computes the value, reading through the workspace that it receives. Its reads
                become dependencies of every view that requests the value.
        """
        memo = self._get_memo(self._access)
        entry = memo.get(key)
        if entry is None and self._base is not None:
            entry = self._base._get_memo(self._access).get(key)
            if entry is not None and self._is_affected(entry[1]):
                entry = None
            elif entry is not None:
                memo[key] = entry
        if entry is None:
            entry = self._compute(key, make)
        if self.dependencies is not None:
            self.dependencies.include(entry[1])
        return cast("T", entry[0])

    def _get_memo(self, access: Access | None) -> dict[Hashable, tuple[Any, Dependencies]]:
        """Return the memo for a policy."""
        return self._memos.setdefault(None if access is None else access.key, {})

    def _is_affected(self, read: Dependencies) -> bool:
        """Tell whether the overlay may change the queried files or folders."""
        return read.is_affected_by(self._overlay.keys(), self._folders)

    def _compute(self, key: Hashable, make: Callable[[Workspace], Any]) -> tuple[Any, Dependencies]:
        inner = self.with_record()
        read = cast("Dependencies", inner.dependencies)
        try:
            entry = make(inner), read
        except BaseException:
            if self.dependencies is not None:
                self.dependencies.include(read)
            raise
        if self._base is not None and not self._is_affected(read):
            self._base._get_memo(self._access).setdefault(key, entry)
        return self._get_memo(self._access).setdefault(key, entry)

    # Queries -------------------------------------------------------------------------------

    def record(self, kind: str, path: str | Path) -> None:
        """Record a dependency, such as on a file that a library opens itself.

        Args:
            kind: A kind of query of :mod:`urdftool.dependencies`.
            path: The path.
        """
        if self.dependencies is not None:
            self.dependencies.add(kind, os.fspath(path))

    def get_overlay(self, path: str | Path) -> bytes | None:
        """Return the overlay contents of a file; None if it is read from disk."""
        if not self._overlay:
            return None
        # compare the name first, since resolving links is slow
        if os.path.basename(path) not in self._names and not os.path.islink(path):
            return None
        return self._overlay.get(_get_key(path))

    def read_bytes(self, path: str | Path, most: int = MAX_BYTES) -> bytes:
        """Return the contents of a file, of at most ``most`` bytes.

        Raises:
            OSError: The file cannot be read, or is larger.
        """
        with self.open(path) as stream:
            data = stream.read(most + 1)
        if len(data) > most:
            raise OSError(errno.EFBIG, f"is larger than {most >> 20} MiB", os.fspath(path))
        return data

    def read_text(self, path: str | Path) -> str:
        """Return the contents of a file as UTF-8 with LF line ends; invalid bytes are replaced.

        Raises:
            OSError: The file cannot be read, or is larger than ``MAX_TEXT_BYTES``.
        """
        text = self.read_bytes(path, MAX_TEXT_BYTES).decode("utf-8", "replace")
        return text.replace("\r\n", "\n").replace("\r", "\n")

    def open(self, path: str | Path, *, is_named: bool = False) -> BinaryIO:
        """Open a file for reading.

        Args:
            path: The file.
            is_named: Whether the user may have named the file, which may then be a stream of this
                process, such as the output of a command, if the view is not restricted.

        Raises:
            OSError: The file cannot be read, or the view may not read it.
        """
        data = self.get_overlay(path)
        if data is None and not (is_named and self._access is None and is_stream(path)):
            self.check(path)
        self.record("file", path)
        if data is None:
            return open(path, "rb")
        stream = BytesIO(data)
        stream.name = os.fspath(path)
        return stream

    def check(self, path: str | Path) -> None:
        """Check that the view may read a file, if it exists.

        Raises:
            AccessRefused: It may not, or the file is a device or a pipe.
        """
        if self._access is not None and os.path.lexists(path):
            reason = self._access.explain_refusal(path, self.restrict(None))
        else:
            reason = IRREGULAR if is_irregular(path) else ""
        if reason:
            raise AccessRefused(reason, path)

    def materialize(self, path: str | Path) -> Path:
        """Return a path with the contents of a file, for libraries that open files themselves.

        The path is that of the file, or of a temporary copy of its overlay contents.

        Raises:
            OSError: The copy cannot be written, or the view may not read the file.
        """
        data = self.get_overlay(path)
        if data is None:
            self.check(path)
        self.record("file", path)
        return Path(path) if data is None else self._copies.write(Path(path).name, data)

    def get_size(self, path: str | Path) -> int | None:
        """Return the size of a file [bytes]; None if it is not a regular file that may be read."""
        data = self.get_overlay(path)
        try:
            if data is None:
                self.check(path)
            self.record("file", path)
            if data is not None:
                return len(data)
            status = os.stat(path)
        except (OSError, ValueError):
            return None
        return status.st_size if stat.S_ISREG(status.st_mode) else None

    def exists(self, path: str | Path) -> bool:
        """Tell whether a path exists, following symbolic links."""
        self.record("is", path)
        return self.get_overlay(path) is not None or os.path.exists(path)

    def is_file(self, path: str | Path) -> bool:
        """Tell whether a path leads to a regular file."""
        self.record("is", path)
        return self.get_overlay(path) is not None or os.path.isfile(path)

    def is_folder(self, path: str | Path) -> bool:
        """Tell whether a path leads to a folder."""
        self.record("is", path)
        return os.path.isdir(path)

    def exists_or_is_link(self, path: str | Path) -> bool:
        """Tell whether an entry exists at a path; a broken symbolic link counts."""
        self.record("there", path)
        return self.get_overlay(path) is not None or os.path.lexists(path)

    def resolve_links(self, path: str | Path) -> str:
        """Return a path without symbolic links."""
        self.record("real", path)
        return os.path.realpath(path)

    def read_variable(self, name: str) -> str | None:
        """Return an environment variable; None if it is not set."""
        if self.dependencies is not None:
            self.dependencies.add("env", name)
        return os.environ.get(name)

    # Folders -------------------------------------------------------------------------------

    def list_folder(self, path: str | Path) -> list[Entry]:
        """Return the entries of a folder, sorted by name.

        Raises:
            OSError: The folder cannot be listed.
        """
        self.record("list", path)
        folder = os.fspath(path)
        with os.scandir(folder) as entries:
            found = {e.name: Entry(e.name, e.path, is_folder(e), e.is_symlink()) for e in entries}
        if self._overlay:
            real = os.path.realpath(folder)
            for key in self._overlay:
                above, name = os.path.split(key)
                if above == real and name not in found:
                    found[name] = Entry(name, os.path.join(folder, name), False, False)
        return [found[name] for name in sorted(found)]

    def walk(self, path: str | Path) -> Iterator[tuple[str, list[str], list[str]]]:
        """Yield each folder from ``path`` downward with the names of its folders and files.

        As ``os.walk``: symbolic links are not followed; folders that cannot be listed are skipped.
        """
        folder = os.fspath(path)
        try:
            entries = self.list_folder(folder)
        except OSError:
            return
        links = {entry.name for entry in entries if entry.is_link}
        folders = [entry.name for entry in entries if entry.is_folder]
        yield folder, folders, [entry.name for entry in entries if not entry.is_folder]
        for name in folders:
            if name not in links:
                yield from self.walk(os.path.join(folder, name))

    def list_code(self, path: str | Path) -> tuple[list[str], list[str]]:
        """Return the names of the Python files and of the folders in a folder that can hold some.

        As :func:`urdftool.dependencies.list_code`; empty if the folder cannot be listed.
        """
        self.record("code", path)
        try:
            return list_code(os.fspath(path))
        except OSError:
            return [], []

    def list_matches(self, path: str | Path, pattern: str) -> list[Path]:
        """Return the sorted paths below a folder that match a pattern, as ``Path.glob``.

        Args:
            path: The folder.
            pattern: Names with ``*``, ``?`` and ``[…]``, joined by slashes; ``**`` is any number
                of folders.
        """
        folder = Path(path)
        return self.memoize(
            (Workspace.list_matches, folder, pattern),
            lambda inner: sorted(set(inner._walk_matches(folder, pattern.split("/")))),
        ).copy()

    def match(self, pattern: str) -> list[str]:
        """Return the sorted paths that match a path with wildcards, as ``glob.glob``.

        Raises:
            OSError: A part of it matches more than ``MAX_MATCHES`` paths.
        """
        found = ["/" if pattern.startswith("/") else ""]
        for name in pattern.split("/"):
            if any(sign in name for sign in "*?["):
                matches = (path for above in found for path in self._match_entries(above, name))
                found = list(islice(matches, MAX_MATCHES + 1))
            else:
                found = [os.path.join(above, name) for above in found]
            if len(found) > MAX_MATCHES:
                raise OSError(errno.E2BIG, f"matches more than {MAX_MATCHES} paths", pattern)
        return sorted(path for path in found if self.exists_or_is_link(path))

    def _match_entries(self, folder: str, name: str) -> list[str]:
        """Return the entries of a folder that match; hidden ones only if the pattern is hidden."""
        try:
            names = [entry.name for entry in self.list_folder(folder or ".")]
        except OSError:
            return []
        return [
            os.path.join(folder, one)
            for one in names
            if fnmatchcase(one, name) and (one[0] != "." or name[0] == ".")
        ]

    def _walk_matches(self, folder: Path, names: list[str]) -> Iterator[Path]:
        name, *rest = names
        if name == "**":
            for where, folders, _ in self.walk(folder):
                folders.sort()
                yield from self._walk_matches(Path(where), rest)
            return
        try:
            entries = self.list_folder(folder)
        except OSError:
            return
        for entry in entries:
            if fnmatchcase(entry.name, name):
                if not rest:
                    yield folder / entry.name
                elif entry.is_folder:
                    yield from self._walk_matches(folder / entry.name, rest)


def _restore(overlay: Mapping[str, bytes], access: Access | None) -> Workspace:
    """Return a workspace with an overlay, a restriction and an empty memo."""
    return Workspace(overlay).restrict(access)


def memoize_by_workspace(
    function: Callable[Concatenate[Workspace, P], T],
) -> Callable[Concatenate[Workspace, P], T]:
    """Decorate a function of a workspace and hashable arguments: one computation per workspace."""
    from functools import wraps

    @wraps(function)
    def known(workspace: Workspace, /, *args: P.args, **kwargs: P.kwargs) -> T:
        key = (function, args, *sorted(kwargs.items()))
        return workspace.memoize(key, lambda inner: function(inner, *args, **kwargs))

    return known


class _Copies:
    """Temporary files with contents that are not on disk, removed with this object."""

    def __init__(self) -> None:
        self._folder: str | None = None

    def write(self, name: str, data: bytes) -> Path:
        """Return the path of a file with this name and these contents.

        Raises:
            OSError: The file cannot be written.
        """
        import shutil
        import tempfile
        import weakref
        from hashlib import sha256

        if self._folder is None:
            self._folder = tempfile.mkdtemp(prefix="urdftool-")
            weakref.finalize(self, shutil.rmtree, self._folder, ignore_errors=True)
        path = Path(self._folder, sha256(data).hexdigest(), name)
        if not path.exists():
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(data)
        return path


def _get_key(path: str | Path) -> str:
    """Return the overlay key of a file: its path without symbolic links."""
    return STDIN if path == STDIN else os.path.realpath(path)
