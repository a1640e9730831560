"""Atomic writes of files and folders, and a cache of results on disk.

A file is written next to its destination and renamed. A cache entry carries a digest of its
content; a damaged entry counts as absent, so several processes may share a cache without a lock.
"""

from __future__ import annotations

import errno
import json
import os
import re
import stat
import sys
import time
from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from hashlib import sha256
from itertools import accumulate
from pathlib import Path
from typing import Any, NamedTuple

from . import __version__
from .errors import OutputError
from .exchange import exchange_names
from .leftovers import ensure, make_temporary_path, remove, remove_leftovers

Content = bytes | Path
"""Content of a file to write: its bytes, or the path of a file to copy."""

_HEAD = 65  # bytes: digest in hexadecimal digits and a line feed
_LARGEST = 256 * 1024 * 1024  # bytes of an entry that is read; chosen
_ENTRY = re.compile(r"[0-9a-f]{64}|\.[0-9a-f]{64}\.\d+\.tmp")  # names of files in a cache
_DAY = 24 * 3600.0
"""Seconds of a day, by definition."""


class _Step(NamedTuple):
    """File to write, with the names of its new and of its previous content."""

    place: Path
    new: Path
    old: Path


def write_files(files: Mapping[Path, Content], *, follow_links: bool = True) -> None:
    """Write files and the folders that they require: all of them, or none.

    All files are written next to their destinations first, then renamed in order. The mode of a
    replaced file is kept. After a kill between two renames each file is complete, the last one is
    the previous one, and a repetition of the command replaces all of them.

    Args:
        files: Content by path; the file that refers to the others comes last.
        follow_links: Write to the target of a symbolic link instead of replacing the link.

    Raises:
        OutputError: A file cannot be written; all previous contents are restored.
    """
    steps: list[_Step] = []
    made: list[Path] = []
    kept: set[_Step] = set()
    replaced: list[_Step] = []
    path = Path()
    try:
        for path, content in files.items():
            place = Path(os.path.realpath(path)) if follow_links else path
            new, old = make_temporary_path(place, "tmp"), make_temporary_path(place, "old")
            steps.append(_Step(place, new, old))
            make_folders(place.parent, made)
            _write(new, content)
            if place.exists():
                os.chmod(new, place.stat().st_mode & 0o777)
        for step in steps if len(steps) > 1 else ():
            path = step.place
            if _keep(path, step.old):
                kept.add(step)
        for step in steps:
            path = step.place
            replaced.append(step)
            os.replace(step.new, path)
    except BaseException as error:
        ensure(partial(_undo, steps, replaced, kept, made))
        if isinstance(error, OSError):
            raise OutputError(f"cannot be written: {_get_reason(error)}", path=path) from None
        raise
    ensure(partial(_remove_temporary, steps))
    places = [step.place for step in steps]
    _sync_folders({place.parent for place in places})
    remove_leftovers(places)


def write_folder(
    target: str | Path, files: Mapping[str, Content], *, dropped: Collection[str] = ()
) -> None:
    """Write a folder: its new state is created next to it and takes its name in one step.

    Args:
        target: The folder; other files in it are kept.
        files: Content by relative path.
        dropped: Relative paths of existing files that are not kept.

    Raises:
        OutputError: The folder cannot be written; its previous state is restored.
    """
    folder = Path(os.path.realpath(target))
    staged, old = make_temporary_path(folder, "tmp"), make_temporary_path(folder, "old")
    made: list[Path] = []
    try:
        make_folders(folder.parent, made)
        remove(staged)
        remove(old)
        os.mkdir(staged)
        for name, content in files.items():
            place = staged / name
            make_folders(place.parent, [])
            _write(place, content)
        if folder.is_dir():
            _link_entries(folder, staged, {folder / name for name in dropped})
            os.chmod(staged, folder.stat().st_mode & 0o777)
        _sync_folders(Path(place) for place, _, _ in os.walk(staged))
        _take_place(staged, folder, old)
    except OSError as error:
        raise OutputError(f"cannot be written: {_get_reason(error)}", path=target) from None
    finally:  # after an exchange, the previous state has the temporary name
        ensure(partial(_discard, staged, made))
    _sync_folders([folder.parent])
    remove_leftovers([folder])


def make_folders(folder: Path, made: list[Path]) -> None:
    """Create a folder and its missing parents.

    Args:
        folder: The folder.
        made: List to which the created folders are added, outermost first, for ``remove_empty``
            after a failure.

    Raises:
        OSError: A folder cannot be created.
    """
    missing: list[Path] = []
    while not folder.exists():
        missing.insert(0, folder)
        folder = folder.parent
    for place in missing:
        made.append(place)
        try:
            os.mkdir(place)
        except FileExistsError:
            if not place.is_dir():
                raise


def remove_empty(folders: Iterable[Path]) -> None:
    """Remove the folders that are empty, innermost first."""
    for folder in reversed(list(folders)):
        with suppress(OSError):
            os.rmdir(folder)


def _write(path: Path, content: Content) -> None:
    """Write a new file under a temporary name; a link that has the name is not followed."""
    remove(path)
    with open(path, "xb") as stream:
        if isinstance(content, bytes):
            stream.write(content)
        else:
            import shutil

            with open(content, "rb") as source:
                shutil.copyfileobj(source, stream, 1 << 20)
        stream.flush()
        os.fsync(stream.fileno())


def _sync_folders(folders: Iterable[Path]) -> None:
    """Write the names in folders to the disk, where the system can do that."""
    for folder in folders if os.name == "posix" else ():
        with suppress(OSError):
            number = os.open(folder, os.O_RDONLY)
            try:
                os.fsync(number)
            finally:
                os.close(number)


def _keep(place: Path, old: Path) -> bool:
    """Keep an existing file under a second name until all files are renamed.

    Returns:
        Whether there is a file.
    """
    remove(old)
    if not os.path.lexists(place):
        return False
    _link(place, old)
    return True


def _link(source: Path, target: Path) -> None:
    """Give a file a second name, or copy it where the file system has no hard links."""
    try:
        os.link(source, target, follow_symlinks=False)
    except (OSError, NotImplementedError):
        import shutil

        shutil.copy2(source, target, follow_symlinks=False)


def _undo(
    steps: Sequence[_Step], replaced: Iterable[_Step], kept: Collection[_Step], made: list[Path]
) -> None:
    """Restore the previous contents of files, of which the last may be unchanged.

    Raises:
        OSError: A file cannot be restored; its previous content keeps its temporary name.
    """
    failure: OSError | None = None
    for step in reversed(list(replaced)) if len(steps) > 1 else ():
        try:
            if step in kept:
                if not _is_same_file(step.old, step.place):
                    os.replace(step.old, step.place)
            elif not os.path.lexists(step.new):
                remove(step.place)
        except OSError as error:
            failure = error
    if failure is not None:
        raise failure
    _remove_temporary(steps)
    remove_empty(made)


def _is_same_file(old: Path, place: Path) -> bool:
    """Tell whether a file was not replaced yet, or its second name is gone."""
    if not os.path.lexists(old):
        return True
    return os.path.lexists(place) and os.path.samestat(os.lstat(old), os.lstat(place))


def _remove_temporary(steps: Iterable[_Step]) -> None:
    for step in steps:
        remove(step.new)
        remove(step.old)


def _discard(staged: Path, made: list[Path]) -> None:
    remove(staged)
    remove_empty(made)


def _link_entries(folder: Path, staged: Path, dropped: Collection[Path] = ()) -> None:
    """Add the entries of a folder that its new state does not contain."""
    emptied = {place.parent for place in dropped}
    for place in sorted(folder.rglob("*")):
        copy = staged / place.relative_to(folder)
        if place in dropped or (place in emptied and not _has_others(place, dropped)):
            continue
        if place.is_symlink() or not place.is_dir():
            if not os.path.lexists(copy):
                make_folders(copy.parent, [])
                _link(place, copy)
        else:
            make_folders(copy, [])


def _has_others(folder: Path, dropped: Collection[Path]) -> bool:
    """Tell whether a folder contains an entry that is not dropped."""
    return any(place not in dropped for place in folder.iterdir())


def _take_place(staged: Path, folder: Path, old: Path) -> None:
    """Rename a folder to a name that may exist; where possible, the two names are exchanged.

    Where the system cannot exchange names, the previous state is ``old`` for a short time.
    """
    if not folder.exists():
        os.rename(staged, folder)
    elif not exchange_names(staged, folder):
        try:
            os.rename(folder, old)
            os.rename(staged, folder)
        finally:
            ensure(partial(_settle, folder, old))


def _settle(folder: Path, old: Path) -> None:
    """Restore the previous state of a folder that is missing, else remove it."""
    if os.path.lexists(folder):
        remove(old)
    elif os.path.lexists(old):
        os.rename(old, folder)


def read_regular_file(path: str | Path, most: int) -> bytes:
    """Read a regular file, or the one a link leads to, of at most ``most`` bytes.

    Raises:
        OSError: It is larger, cannot be read, or is a folder, pipe or device.
    """
    status = os.stat(path)
    if not stat.S_ISREG(status.st_mode):
        raise OSError(errno.EINVAL, "Not a regular file", str(path))
    if status.st_size > most:
        raise OSError(errno.EFBIG, os.strerror(errno.EFBIG), str(path))
    with open(path, "rb") as stream:
        return stream.read(status.st_size)


def _get_reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)


class DiskCache:
    """Cache of results on disk, shared by all processes of a user.

    Attributes:
        folder: Folder of the cache; None disables it.
        trouble: Reason why the last entry was not stored; empty if it was.
    """

    def __init__(self, folder: str | Path | None) -> None:
        """Set the folder, which need not exist."""
        self.folder = None if folder is None else str(folder)
        self.trouble = ""

    def get(self, key: str) -> bytes | None:
        """Return an entry; None if it is absent, damaged or not a file."""
        if self.folder is None:
            return None
        try:
            data = read_regular_file(self._place(key), _LARGEST)
        except OSError:
            return None
        body = memoryview(data)[_HEAD:]
        if data[: _HEAD - 1] != sha256(body).hexdigest().encode():
            return None
        return bytes(body)

    def put(self, key: str, data: bytes) -> None:
        """Store an entry; on failure set ``trouble``."""
        if self.folder is not None:
            entry = sha256(data).hexdigest().encode() + b"\n" + data
            self.trouble = self._write(Path(self._place(key)), entry) or self.trouble

    def _write(self, place: Path, data: bytes) -> str:
        """Write a file; return the reason why it could not be written, empty if it was."""
        new = make_temporary_path(place, "tmp")
        try:
            os.makedirs(place.parent, exist_ok=True)
            remove(new)
            with open(new, "xb") as stream:
                stream.write(data)
            os.replace(new, place)
        except (OSError, ValueError) as error:
            return _get_reason(error)
        finally:
            ensure(partial(remove, new))
        remove_leftovers([place])
        return ""

    def trim(self, *, days: float = 90.0, most: int = 1_000_000_000) -> int:
        """Remove entries that were not used for long, and the least recent of a cache too large.

        At most once a day; further calls do nothing. Other files in the folder are kept.

        Args:
            days: Maximum time since the last use [days].
            most: Maximum size of all entries [bytes].

        Returns:
            The number of removed entries.
        """
        if self.folder is None or not os.path.isdir(self.folder):
            return 0
        mark = Path(self.folder, "trimmed")
        now = time.time()
        with suppress(OSError):
            if now - os.lstat(mark).st_mtime < _DAY:
                return 0
        if self._write(mark, b""):
            return 0
        return self._remove(now - days * _DAY, most)

    def _remove(self, oldest: float, most: int) -> int:
        entries = []
        assert self.folder is not None
        for where, _, names in os.walk(self.folder):
            for name in filter(_ENTRY.fullmatch, names):
                path = os.path.join(where, name)
                try:
                    status = os.lstat(path)
                except OSError:
                    continue
                entries.append((max(status.st_mtime, status.st_atime), status.st_size, path))
        removed = size = 0
        for used, length, path in sorted(entries, reverse=True):
            size += length
            if used < oldest or size > most:
                try:
                    os.unlink(path)
                    removed += 1
                except OSError:
                    continue
        return removed

    def _place(self, key: str) -> str:
        assert self.folder is not None
        return os.path.join(self.folder, key[:2], key)


def join_parts(head: object, parts: Sequence[bytes]) -> bytes:
    """Return the plain form of an entry that has binary parts."""
    line = json.dumps([head, [len(part) for part in parts]]).encode()
    return b"".join([line, b"\n", *parts])


def split_parts(data: bytes) -> tuple[Any, list[bytes]]:
    """Return head and parts of an entry of :func:`join_parts`.

    Raises:
        ValueError: The entry is damaged.
    """
    line, _, body = data.partition(b"\n")
    try:
        head, sizes = json.loads(line)
        if any(type(size) is not int or size < 0 for size in sizes) or sum(sizes) != len(body):
            raise ValueError(str(sizes)[:80])
    except (TypeError, RecursionError) as error:
        raise ValueError(str(error)) from None
    ends = list(accumulate(sizes))
    return head, [body[end - size : end] for size, end in zip(sizes, ends, strict=True)]


def cache_key(revision: int, facts: object, inputs: Iterable[bytes] = ()) -> str:
    """Return the key of a result: a digest of the version of urdftool and of all inputs."""
    digest = sha256(json.dumps([__version__, revision, facts], sort_keys=True).encode())
    for data in inputs:
        digest.update(b"\0%d\0" % len(data))
        digest.update(data)
    return digest.hexdigest()


def cache_folder(name: str) -> Path:
    """Return the default folder of a cache on this platform.

    ``XDG_CACHE_HOME`` has priority on all platforms; the default is ``~/.cache``, on macOS
    ``~/Library/Caches``, on Windows ``%LOCALAPPDATA%``.
    """
    base = os.environ.get("XDG_CACHE_HOME")
    if not base and sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA")
    if not base:
        base = os.path.expanduser("~/Library/Caches" if sys.platform == "darwin" else "~/.cache")
    return Path(base, "urdftool", name)
