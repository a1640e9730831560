"""Atomic writes of files and folders, and a cache of results on disk.

A file is written next to its destination and renamed. A cache entry carries a digest of its
content; a damaged entry counts as absent, so several processes may share a cache without a lock.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Collection, Iterable, Mapping
from contextlib import suppress
from hashlib import sha256
from pathlib import Path

from . import __version__
from .errors import OutputError

Content = bytes | Path
"""Content of a file to write: its bytes, or the path of a file to copy."""

_HEAD = 65  # bytes: digest in hexadecimal digits and a line feed
_DAY = 24 * 3600.0


def write_files(files: Mapping[Path, Content], *, follow_links: bool = True) -> None:
    """Write files and the folders that they require: all of them, or none.

    All files are written next to their destinations first, then renamed in order. The mode of a
    replaced file is kept.

    Args:
        files: Content by path; the file that refers to the others comes last.
        follow_links: Write to the target of a symbolic link instead of replacing the link.

    Raises:
        OutputError: A file cannot be written; all previous contents are restored.
    """
    staged: list[tuple[Path, Path, Path]] = []
    made: list[Path] = []
    moved: list[tuple[Path, Path]] = []
    path = Path()
    try:
        for path, content in files.items():
            place = Path(os.path.realpath(path)) if follow_links else path
            made += make_folders(place.parent)
            new, old = _make_temporary_path(place, "tmp"), _make_temporary_path(place, "old")
            staged.append((place, new, old))
            _write(new, content)
            if place.exists():
                os.chmod(new, place.stat().st_mode & 0o777)
        for place, new, old in staged:
            path = place
            if len(staged) > 1:
                _keep(place, old)
            moved.append((place, old))
            os.replace(new, place)
    except BaseException as error:
        for place, old in reversed(moved):
            with suppress(OSError):
                _restore(place, old, alone=len(staged) == 1)
        for _, new, _ in staged:
            with suppress(OSError):
                new.unlink(missing_ok=True)
        remove_empty(made)
        if isinstance(error, OSError):
            raise OutputError(f"cannot be written: {_get_reason(error)}", path=path) from None
        raise
    finally:
        for _, _, old in staged:
            with suppress(OSError):
                old.unlink(missing_ok=True)


def write_folder(
    target: str | Path, files: Mapping[str, Content], *, dropped: Collection[str] = ()
) -> None:
    """Write a folder: its new state is created next to it and renamed.

    Args:
        target: The folder; other files in it are kept.
        files: Content by relative path.
        dropped: Relative paths of existing files that are not kept.

    Raises:
        OutputError: The folder cannot be written; its previous state is restored.
    """
    import shutil

    folder = Path(os.path.realpath(target))
    staged = _make_temporary_path(folder, "tmp")
    made: list[Path] = []
    try:
        made = make_folders(folder.parent)
        shutil.rmtree(staged, ignore_errors=True)
        staged.mkdir()
        for name, content in files.items():
            place = staged / name
            place.parent.mkdir(parents=True, exist_ok=True)
            _write(place, content)
        if folder.is_dir():
            _copy_entries(folder, staged, {folder / name for name in dropped})
        _take_place(staged, folder)
    except OSError as error:
        raise OutputError(f"cannot be written: {_get_reason(error)}", path=target) from None
    finally:
        shutil.rmtree(staged, ignore_errors=True)
        remove_empty(made)


def make_folders(folder: Path) -> list[Path]:
    """Create a folder and its missing parents.

    Returns:
        The created folders, outermost first, for ``remove_empty`` after a failure.

    Raises:
        OSError: A folder cannot be created; the folders created before it are removed.
    """
    missing: list[Path] = []
    while not folder.exists():
        missing.insert(0, folder)
        folder = folder.parent
    made: list[Path] = []
    try:
        for place in missing:
            place.mkdir(exist_ok=True)
            made.append(place)
    except OSError:
        remove_empty(made)
        raise
    return made


def remove_empty(folders: Iterable[Path]) -> None:
    """Remove the folders that are empty, innermost first."""
    for folder in reversed(list(folders)):
        with suppress(OSError):
            folder.rmdir()


def _make_temporary_path(place: Path, kind: str) -> Path:
    return place.with_name(f".{place.name}.{os.getpid()}.{kind}")


def _write(path: Path, content: Content) -> None:
    import shutil

    with open(path, "wb") as stream:
        if isinstance(content, bytes):
            stream.write(content)
        else:
            with open(content, "rb") as source:
                shutil.copyfileobj(source, stream, 1 << 20)
        stream.flush()
        os.fsync(stream.fileno())


def _keep(place: Path, old: Path) -> None:
    """Keep an existing file under a second name until all files are renamed."""
    import shutil

    old.unlink(missing_ok=True)
    if not os.path.lexists(place):
        return
    try:
        os.link(place, old, follow_symlinks=False)
    except (OSError, NotImplementedError):  # file system without hard links
        shutil.copy2(place, old, follow_symlinks=False)


def _restore(place: Path, old: Path, *, alone: bool) -> None:
    if os.path.lexists(old):
        os.replace(old, place)
    elif not alone:
        place.unlink(missing_ok=True)


def _copy_entries(folder: Path, staged: Path, dropped: Collection[Path] = ()) -> None:
    """Copy the entries of a folder that its new state does not contain."""
    import shutil

    emptied = {place.parent for place in dropped}
    for place in sorted(folder.rglob("*")):
        copy = staged / place.relative_to(folder)
        if place in dropped or (place in emptied and not _has_others(place, dropped)):
            continue
        if place.is_symlink() or not place.is_dir():
            if not os.path.lexists(copy):
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(place, copy, follow_symlinks=False)
        else:
            copy.mkdir(parents=True, exist_ok=True)


def _has_others(folder: Path, dropped: Collection[Path]) -> bool:
    """Tell whether a folder contains an entry that is not dropped."""
    return any(place not in dropped for place in folder.iterdir())


def _take_place(staged: Path, folder: Path) -> None:
    import shutil

    if not folder.exists():
        os.rename(staged, folder)
        return
    old = _make_temporary_path(folder, "old")
    os.rename(folder, old)
    try:
        os.rename(staged, folder)
    except OSError:
        os.rename(old, folder)
        raise
    shutil.rmtree(old, ignore_errors=True)


def _get_reason(error: OSError) -> str:
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
        """Return an entry; None if it is absent or damaged."""
        if self.folder is None:
            return None
        try:
            with open(self._place(key), "rb") as stream:
                data = stream.read()
        except OSError:
            return None
        if data[: _HEAD - 1] != sha256(data[_HEAD:]).hexdigest().encode():
            return None
        return data[_HEAD:]

    def put(self, key: str, data: bytes) -> None:
        """Store an entry; on failure set ``trouble``."""
        if self.folder is None:
            return
        place = Path(self._place(key))
        new = _make_temporary_path(place, "tmp")
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            with open(new, "wb") as stream:
                stream.write(sha256(data).hexdigest().encode() + b"\n" + data)
            os.replace(new, place)
        except OSError as error:
            self.trouble = _get_reason(error)
        finally:
            try:
                new.unlink(missing_ok=True)
            except OSError as error:
                self.trouble = _get_reason(error)

    def trim(self, *, days: float = 90.0, most: int = 1_000_000_000) -> int:
        """Remove entries that were not used for long, and the least recent of a cache too large.

        At most once a day; further calls do nothing.

        Args:
            days: Maximum time since the last use [days].
            most: Maximum size of all entries [bytes].

        Returns:
            The number of removed entries.
        """
        if self.folder is None:
            return 0
        mark = os.path.join(self.folder, "trimmed")
        now = time.time()
        try:
            if os.path.exists(mark) and now - os.stat(mark).st_mtime < _DAY:
                return 0
            with open(mark, "wb"):
                os.utime(mark)
        except OSError:
            return 0
        return self._remove(now - days * _DAY, most)

    def _remove(self, oldest: float, most: int) -> int:
        entries = []
        assert self.folder is not None
        for where, _, names in os.walk(self.folder):
            for name in names:
                path = os.path.join(where, name)
                try:
                    status = os.stat(path)
                except OSError:
                    continue
                if name != "trimmed":
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


def cache_key(revision: int, facts: object, inputs: Iterable[bytes] = ()) -> str:
    """Return the key of a result: a digest of the version of urdftool and of all inputs.

    Args:
        revision: Revision of the computation, incremented when its result changes.
        facts: Settings, JSON-serializable.
        inputs: Contents of the files read.
    """
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
