"""Cache of reports with their dependencies.

The key of an entry covers the file, the settings, the arguments and the code of urdftool. An entry
is valid while all recorded queries to the file system (:mod:`urdftool.dependencies`) have the same
answers: a missing mesh that appears counts like a changed one. A file with an unchanged stamp is
not read again, unless its stamp was too recent to be reliable.
"""

from __future__ import annotations

import io
import os
import pickle
import sys
from collections.abc import Iterable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from .. import __version__
from ..configuration import Configuration
from ..dependencies import (
    ABSENT,
    Dependencies,
    Question,
    Stamp,
    compute_answer,
    has_stamp,
    is_settled,
    read_stamp,
)
from ..extras import EXTRA_OF, is_installed
from ..source.location import SourceFile
from ..storage import DiskCache
from .outcome import Options, Report
from .settings import Settings

_FORMAT = 2
_DAYS = 30
_MOST = 200 * 1024 * 1024

Row = tuple[str, str, str, "Stamp | None"]
"""Query, its answer, and the stamp that proves it unchanged; None if it must be repeated."""


class Cache:
    """Reports by key, for one command; each query is made at most once.

    Attributes:
        store: Cache on disk.
    """

    def __init__(self, store: DiskCache) -> None:
        """Set the cache on disk."""
        self.store = store
        self._code = _hash_code()
        self._stamps: dict[Question, Stamp | None] = {}
        self._answers: dict[Question, tuple[str, Stamp | None]] = {}
        self._sets: dict[Dependencies, str] = {}
        self._valid: dict[str, bool] = {}

    def get_key(
        self,
        path: str | Path,
        options: Options,
        configuration: Configuration,
        settings: Settings,
    ) -> str:
        """Return the key of a check: a digest of its inputs."""
        facts = [
            *(_FORMAT, self._code, os.getcwd(), str(path), sorted(options.arguments.items())),
            *(_collect_folders(options.packages), [str(path) for path in options.package_paths]),
            *(
                configuration.path,
                _collect_folders(configuration.packages),
                _list_settings(settings),
            ),
            options.fixes,
            [library for library in EXTRA_OF if is_installed(library)],
            options.gltf_up or configuration.gltf_up,
        ]
        return sha256(repr(facts).encode("utf-8", "surrogateescape")).hexdigest()

    def read(self, key: str) -> Report | None:
        """Return a report that is still valid; None if there is none."""
        data = self.store.get(key)
        if data is None:
            return None
        try:
            rows, report = _Reader(io.BytesIO(data)).load()
            if not all(self._holds(row) for row in rows):
                return None
            found = _Reader(io.BytesIO(report), self).load()
        except _NOT_WHOLE:
            return None
        return found if isinstance(found, Report) else None

    def write(self, key: str, report: Report, read: Dependencies) -> None:
        """Store a report, unless it is incomplete or a dependency changed during the check."""
        if report.error is not None or report.failed_rules:
            return
        try:
            rows = self._get_rows(read)
            if rows is None:
                return
            for shared in read.shared:
                digest = self._set(shared)
                if digest is None:
                    return
                rows.append(("many", digest, "", None))
            stream = io.BytesIO()
            _Writer(stream, {row[1]: row[2] for row in rows if row[0] == "file"}).dump(report)
        except (OSError, ValueError, pickle.PicklingError):
            return
        self.store.put(key, pickle.dumps((rows, stream.getvalue()), 5))

    def get_source(self, path: str, encoding: str, digest: str) -> SourceFile:
        """Return a file that is unchanged since the check.

        Raises:
            OSError: It cannot be read.
            ValueError: It has changed.
        """
        with open(path, "rb") as stream:
            data = stream.read()
        if sha256(data).hexdigest() != digest:
            raise ValueError(path)
        return SourceFile(path, data, encoding)

    def _get_rows(self, read: Dependencies) -> list[Row] | None:
        """Return the queries with their answers; None if a stamp has changed since the query."""
        rows: list[Row] = []
        for question, stamp in read.asked.items():
            if question not in self._answers:
                said = compute_answer(question)
                self._answers[question] = said, read_stamp(question)
            said, now = self._answers[question]
            if now != stamp and said != "folder":
                return None
            rows.append((*question, said, now if is_settled(now) and now else None))
        return rows

    def _set(self, read: Dependencies) -> str | None:
        """Store the queries of a shared result; return their digest, None if a stamp changed."""
        if read not in self._sets:
            rows = self._get_rows(read)
            if rows is None:
                return None
            data = pickle.dumps(rows, 5)
            self._sets[read] = sha256(data).hexdigest()
            self.store.put(self._sets[read], data)
        return self._sets[read]

    def _holds(self, row: Row) -> bool:
        """Tell whether a query still has the same answer."""
        kind, path, said, stamp = row
        if kind == "many":
            return self._set_holds(path)
        question = kind, path
        if question not in self._stamps:
            self._stamps[question] = read_stamp(question)
        now = self._stamps[question]
        known = has_stamp(question) and (now is None) == (said == ABSENT)
        if known and (now is None or now == stamp):
            return True
        if question not in self._answers:
            self._answers[question] = compute_answer(question), now
        return self._answers[question][0] == said

    def _set_holds(self, digest: str) -> bool:
        if digest not in self._valid:
            data = self.store.get(digest)
            rows = [] if data is None else _Reader(io.BytesIO(data)).load()
            self._valid[digest] = data is not None and all(self._holds(row) for row in rows)
        return self._valid[digest]

    def trim(self) -> None:
        """Remove entries that were not used for 30 days, and the oldest above 200 MiB."""
        self.store.trim(days=_DAYS, most=_MOST)


_NOT_WHOLE = (
    *(OSError, ValueError, TypeError, AttributeError, KeyError, IndexError, EOFError),
    *(ImportError, pickle.UnpicklingError),
)


class _Writer(pickle.Pickler):
    """Pickler that replaces source files unchanged on disk by path and digest."""

    def __init__(self, stream: io.BytesIO, digests: Mapping[str, str]) -> None:
        super().__init__(stream, 5)
        self.digests = digests
        self.names: dict[int, tuple[str, str, str | bytes]] = {}

    def persistent_id(self, value: Any) -> Any:
        if not isinstance(value, SourceFile):
            return None
        if id(value) not in self.names:
            digest = sha256(value.data).hexdigest()
            whole = self.digests.get(os.path.join(os.getcwd(), value.path)) == digest
            self.names[id(value)] = value.path, value.encoding, digest if whole else value.data
        return self.names[id(value)]


class _Reader(pickle.Unpickler):
    """Unpickler that accepts only classes of urdftool and a few built-in types."""

    def __init__(self, stream: io.BytesIO, cache: Cache | None = None) -> None:
        super().__init__(stream)
        self.cache = cache
        self.files: dict[Any, SourceFile] = {}

    def find_class(self, module: str, name: str) -> Any:
        if module.startswith("urdftool.") or (module, name) in _BUILTINS:
            found = super().find_class(module, name)
            if isinstance(found, type):
                return found
        raise pickle.UnpicklingError(f"{module}.{name}")

    def persistent_load(self, pid: Any) -> SourceFile:
        path, encoding, content = pid
        if pid not in self.files:
            if isinstance(content, bytes):
                self.files[pid] = SourceFile(path, content, encoding)
            else:
                assert self.cache is not None
                self.files[pid] = self.cache.get_source(path, encoding, content)
        return self.files[pid]


_BUILTINS = {("builtins", "frozenset"), ("builtins", "set")}


def _hash_code() -> str:
    """Return a digest of the code that runs: files of urdftool, Python, installed libraries."""
    root = Path(__file__).parents[1]
    folders = [str(root)]
    files: list[tuple[str, int, int]] = []
    for folder in folders:
        with os.scandir(folder) as entries:
            for entry in entries:
                if entry.name.endswith((".py", ".html")):
                    status = entry.stat()
                    files.append((entry.path, status.st_size, status.st_mtime_ns))
                elif "." not in entry.name and entry.name != "__pycache__" and entry.is_dir():
                    folders.append(entry.path)
    facts = [__version__, sys.version, sorted(files), list(_list_library_folders(sys.path))]
    return sha256(repr(facts).encode("utf-8", "surrogateescape")).hexdigest()


def _list_library_folders(path: Iterable[str]) -> Iterable[tuple[str, int]]:
    """Yield the library folders with their modification times [ns]."""
    for folder in path:
        if os.path.basename(folder) in ("site-packages", "dist-packages"):
            try:
                yield folder, os.stat(folder).st_mtime_ns
            except OSError:
                continue


def _collect_folders(packages: Mapping[str, str | Path]) -> list[tuple[str, str]]:
    return sorted((name, str(folder)) for name, folder in packages.items())


def _list_settings(settings: Settings) -> list[Any]:
    """Return the settings as a list, sorted where order is irrelevant."""
    return [
        *(settings.select, settings.extend_select, settings.ignore),
        None if settings.targets is None else sorted(settings.targets),
        sorted((name, level and level.label) for name, level in settings.severity.items()),
        sorted((name, sorted(table.items())) for name, table in settings.thresholds.items()),
    ]
