"""Read files of a run through one object: unsaved contents, recorded dependencies, memo.

A :class:`Workspace` is the only way in which a check looks at the file system and at environment
variables. It answers from an overlay of contents that are not on the disk (standard input, a fix
that is tried, a buffer of an editor), records each question so that a cache knows on what a result
depends, and computes what many ask (the packages below a folder, the outline of a mesh) once.

Nothing of it is global: two workspaces know nothing of each other, and views of one workspace may
be used in several threads.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Hashable, Iterator, Mapping
from fnmatch import fnmatchcase
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple, TypeVar, cast

from .dependencies import Dependencies

if TYPE_CHECKING:
    from typing import Concatenate, ParamSpec

    P = ParamSpec("P")

T = TypeVar("T")

STDIN = "<stdin>"
"""The path under which an overlay has the contents of standard input."""


class Memo:
    """Values that are computed once and live as long as the object they belong to."""

    __slots__ = ("_known",)

    def __init__(self) -> None:
        """Start empty."""
        self._known: dict[Hashable, Any] = {}

    def get(self, key: Hashable, make: Callable[[], T]) -> T:
        """Return the value of a key; compute it if it is not known."""
        try:
            return cast("T", self._known[key])
        except KeyError:
            return cast("T", self._known.setdefault(key, make()))

    def peek(self, key: Hashable) -> Any:
        """Return the value of a key; None where it was not computed."""
        return self._known.get(key)

    def clear(self) -> None:
        """Forget all values, which are freed at once where they refer to the object."""
        self._known.clear()

    def __reduce__(self) -> tuple[Any, ...]:
        """Copy and pickle as an empty one: values are computed again."""
        return Memo, ()


class Entry(NamedTuple):
    """An entry of a folder: its name and path, whether it is a folder and a symbolic link."""

    name: str
    path: str
    is_folder: bool
    is_link: bool


class Workspace:
    """Access to files and environment variables for one run.

    Attributes:
        dependencies: What was read through this view; None where nothing is recorded.
    """

    def __init__(self, overlay: Mapping[str, bytes] | None = None) -> None:
        """Read from the disk.

        Args:
            overlay: Contents by path that are read in place of those on the disk.
        """
        self.dependencies: Dependencies | None = None
        self._overlay = {_key(path): data for path, data in (overlay or {}).items()}
        self._names = frozenset(map(os.path.basename, self._overlay))
        self._folders = frozenset(map(os.path.dirname, self._overlay))
        self._known: dict[Hashable, tuple[Any, Dependencies]] = {}
        self._base: Workspace | None = None
        self._copies = _Copies()

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the overlay alone, for another process."""
        return Workspace, (self._overlay,)

    # Views ---------------------------------------------------------------------------------

    def recorded(self) -> Workspace:
        """Return a view with the same overlay and memo, and a record of its own."""
        view = Workspace.__new__(Workspace)
        view.__dict__.update(self.__dict__)
        view.dependencies = Dependencies()
        return view

    def unread(self) -> Workspace:
        """Return a workspace with the same overlay that has read nothing."""
        return Workspace(self._overlay)

    def with_overlay(self, overlay: Mapping[str, bytes]) -> Workspace:
        """Return a workspace in which some files have other contents.

        It shares with this one all memo entries that do not depend on those files.
        """
        other = Workspace({**self._overlay, **overlay})
        other._base = self
        other._copies = self._copies
        return other

    # Memo ----------------------------------------------------------------------------------

    def memo(self, key: Hashable, make: Callable[[Workspace], T]) -> T:
        """Return a value that depends on files; compute it if it is not known.

        Args:
            key: What the value is of.
            make: Computes it, reading through the workspace that it is given. What that reads is
                a dependency of every view that asks for the value.
        """
        entry = self._known.get(key)
        if entry is None and self._base is not None:
            entry = self._base._known.get(key)
            if entry is not None and self._touches(entry[1]):
                entry = None
            elif entry is not None:
                self._known[key] = entry
        if entry is None:
            entry = self._compute(key, make)
        if self.dependencies is not None:
            self.dependencies.include(entry[1])
        return cast("T", entry[0])

    def _touches(self, read: Dependencies) -> bool:
        """Tell whether the overlay may change what was read."""
        return read.touches(self._overlay.keys(), self._folders)

    def _compute(self, key: Hashable, make: Callable[[Workspace], Any]) -> tuple[Any, Dependencies]:
        inner = self.recorded()
        read = cast("Dependencies", inner.dependencies)
        try:
            entry = make(inner), read
        except BaseException:
            if self.dependencies is not None:
                self.dependencies.include(read)
            raise
        if self._base is not None and not self._touches(read):
            self._base._known.setdefault(key, entry)
        return self._known.setdefault(key, entry)

    # Questions -----------------------------------------------------------------------------

    def record(self, kind: str, path: str | Path) -> None:
        """Record a dependency, such as on a file that a library opens itself.

        Args:
            kind: A kind of question of :mod:`urdftool.dependencies`.
            path: The path.
        """
        if self.dependencies is not None:
            self.dependencies.add(kind, os.fspath(path))

    def overlaid(self, path: str | Path) -> bytes | None:
        """Return the contents that the overlay has for a file; None where the disk counts."""
        if not self._overlay:
            return None
        # the name is that of the overlay, or that of a link: resolving all links takes long
        if os.path.basename(path) not in self._names and not os.path.islink(path):
            return None
        return self._overlay.get(_key(path))

    def read_bytes(self, path: str | Path) -> bytes:
        """Return the contents of a file.

        Raises:
            OSError: It cannot be read.
        """
        with self.open(path) as stream:
            return stream.read()

    def read_text(self, path: str | Path) -> str:
        """Return the contents of a file as UTF-8; what is not UTF-8 is replaced.

        Raises:
            OSError: It cannot be read.
        """
        text = self.read_bytes(path).decode("utf-8", "replace")
        return text.replace("\r\n", "\n").replace("\r", "\n")

    def open(self, path: str | Path) -> BinaryIO:
        """Open a file for reading.

        Raises:
            OSError: It cannot be read.
        """
        self.record("file", path)
        data = self.overlaid(path)
        if data is None:
            return open(path, "rb")
        stream = BytesIO(data)
        stream.name = os.fspath(path)
        return stream

    def local(self, path: str | Path) -> Path:
        """Return a file with these contents, for libraries that open files themselves.

        That is the file itself, or a copy of what the overlay has for it.

        Raises:
            OSError: The copy cannot be written.
        """
        self.record("file", path)
        data = self.overlaid(path)
        return Path(path) if data is None else self._copies.write(Path(path).name, data)

    def size(self, path: str | Path) -> int | None:
        """Return the bytes of a regular file; None where there is none."""
        self.record("file", path)
        data = self.overlaid(path)
        if data is not None:
            return len(data)
        try:
            status = os.stat(path)
        except (OSError, ValueError):
            return None
        return status.st_size if stat.S_ISREG(status.st_mode) else None

    def exists(self, path: str | Path) -> bool:
        """Tell whether a path leads to anything."""
        self.record("is", path)
        return self.overlaid(path) is not None or os.path.exists(path)

    def is_file(self, path: str | Path) -> bool:
        """Tell whether a path leads to a regular file."""
        self.record("is", path)
        return self.overlaid(path) is not None or os.path.isfile(path)

    def is_folder(self, path: str | Path) -> bool:
        """Tell whether a path leads to a folder."""
        self.record("is", path)
        return os.path.isdir(path)

    def exists_or_is_link(self, path: str | Path) -> bool:
        """Tell whether there is anything at a path, be it a link that leads nowhere."""
        self.record("there", path)
        return self.overlaid(path) is not None or os.path.lexists(path)

    def real_path(self, path: str | Path) -> str:
        """Return a path without symbolic links."""
        self.record("real", path)
        return os.path.realpath(path)

    def variable(self, name: str) -> str | None:
        """Return an environment variable; None where it is not set."""
        if self.dependencies is not None:
            self.dependencies.add("env", name)
        return os.environ.get(name)

    # Folders -------------------------------------------------------------------------------

    def list_folder(self, path: str | Path) -> list[Entry]:
        """Return the entries of a folder by name.

        Raises:
            OSError: It cannot be listed.
        """
        self.record("list", path)
        folder = os.fspath(path)
        with os.scandir(folder) as entries:
            found = {e.name: Entry(e.name, e.path, _is_folder(e), e.is_symlink()) for e in entries}
        if self._overlay:
            real = os.path.realpath(folder)
            for key in self._overlay:
                above, name = os.path.split(key)
                if above == real and name not in found:
                    found[name] = Entry(name, os.path.join(folder, name), False, False)
        return [found[name] for name in sorted(found)]

    def walk(self, path: str | Path) -> Iterator[tuple[str, list[str], list[str]]]:
        """Yield each folder from a folder downward, with its folders and files, as ``os.walk``."""
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

    def glob(self, path: str | Path, pattern: str) -> list[Path]:
        """Return the paths below a folder that match a pattern, sorted, as ``Path.glob``.

        Args:
            path: The folder.
            pattern: Names with ``*``, ``?`` and ``[…]``, joined by slashes; ``**`` is any number
                of folders.
        """
        folder = Path(path)
        return self.memo(
            (Workspace.glob, folder, pattern),
            lambda inner: sorted(set(inner._glob(folder, pattern.split("/")))),
        ).copy()

    def match(self, pattern: str) -> list[str]:
        """Return the paths that match a path with ``*``, ``?`` and ``[…]``, as ``glob.glob``."""
        start, *names = pattern.split("/")
        found = [start or "/"]
        for name in names:
            if any(sign in name for sign in "*?["):
                found = [path for above in found for path in self._named(above, name)]
            else:
                found = [os.path.join(above, name) for above in found]
        return sorted(path for path in found if self.exists_or_is_link(path))

    def _named(self, folder: str, name: str) -> list[str]:
        """Return the entries of a folder that match; hidden ones only if the pattern is hidden."""
        try:
            names = [entry.name for entry in self.list_folder(folder)]
        except OSError:
            return []
        return [
            os.path.join(folder, one)
            for one in names
            if fnmatchcase(one, name) and (one[0] != "." or name[0] == ".")
        ]

    def _glob(self, folder: Path, names: list[str]) -> Iterator[Path]:
        name, *rest = names
        if name == "**":
            for where, folders, _ in self.walk(folder):
                folders.sort()
                yield from self._glob(Path(where), rest)
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
                    yield from self._glob(folder / entry.name, rest)


def memoized(
    function: Callable[Concatenate[Workspace, P], T],
) -> Callable[Concatenate[Workspace, P], T]:
    """Compute a function of a workspace and hashable arguments once for a workspace."""
    from functools import wraps

    @wraps(function)
    def known(workspace: Workspace, /, *args: P.args, **kwargs: P.kwargs) -> T:
        key = (function, args, *sorted(kwargs.items()))
        return workspace.memo(key, lambda inner: function(inner, *args, **kwargs))

    return known


class _Copies:
    """Files with contents that are not on the disk, in a folder that is removed with this."""

    def __init__(self) -> None:
        self._folder: str | None = None

    def write(self, name: str, data: bytes) -> Path:
        """Return a file of that name with these contents.

        Raises:
            OSError: It cannot be written.
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


def _key(path: str | Path) -> str:
    """Return what stands for a file in an overlay: its path without links."""
    return STDIN if path == STDIN else os.path.realpath(path)


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:
        return False
