"""Cache of reports with their dependencies.

The key of an entry covers the file, the settings, the arguments and the code of urdftool. An entry
is valid while all recorded queries to the file system (:mod:`urdftool.dependencies`) have the same
answers: a missing mesh that appears counts like a changed one. A file with an unchanged stamp is
not read again, unless its stamp was too recent to be reliable.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from .. import __version__
from ..dependencies import (
    ABSENT,
    KINDS,
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
from ..storage import DiskCache, read_regular_file
from .outcome import Report
from .report_form import convert_to_bytes, convert_to_text, read_file, read_report, write_report

_FORMAT = 4
"""Version of the entries; it is increased when the same key would have another content."""

_DAYS = 30
"""Days after which an unused entry is removed. Chosen, no source."""

_MOST = 200 * 1024 * 1024
"""Size of the cache [bytes] above which its oldest entries are removed. Chosen, no source."""

_LARGEST_SOURCE = 256 * 1024 * 1024
"""Bytes. Chosen, no source."""

_SHARED = "many"
"""Kind of a row that refers to a large set of queries by the digest of its entry."""

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
        self._libraries = [library for library in EXTRA_OF if is_installed(library)]
        self._stamps: dict[Question, Stamp | None] = {}
        self._answers: dict[Question, tuple[str, Stamp | None]] = {}
        self._sets: dict[Dependencies, str] = {}
        self._valid: dict[str, bool] = {}

    def get_key(self, path: str | Path, facts: list[Any]) -> str:
        """Return the key of a check: a digest of its inputs.

        Args:
            path: Path of the description.
            facts: What the report depends on in addition to files.
        """
        known = [_FORMAT, self._code, os.getcwd(), str(path), self._libraries, *facts]
        return sha256(repr(known).encode("utf-8", "surrogateescape")).hexdigest()

    def read(self, key: str) -> Report | None:
        """Return a report that is still valid; None if there is none."""
        try:
            table = self._load(key)
            if table is None:
                return None
            rows = [_read_row(row) for row in table["rows"]]
            if not all(self._holds(row) for row in rows):
                return None
            digests = _list_digests(rows)
            files = [self._get_source(file, digests) for file in table["files"]]
            report = read_report(table, files)
            return report if os.path.join(os.getcwd(), report.path) in digests else None
        except (OSError, ValueError, TypeError, KeyError, RecursionError):
            return None  # a damaged entry counts as absent

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
                rows.append((_SHARED, digest, "", None))
            table, files = write_report(report)
        except (OSError, ValueError):
            return
        digests = _list_digests(rows)
        table["files"] = [_write_file(file, digests) for file in files]
        self._store(key, {"rows": rows, **table})

    def _load(self, key: str) -> Any:
        data = self.store.get(key)
        return None if data is None else json.loads(data)

    def _store(self, key: str, table: dict[str, Any]) -> None:
        self.store.put(key, json.dumps(table, separators=(",", ":")).encode())

    def _get_source(self, entry: Any, digests: Mapping[str, str]) -> SourceFile:
        """Return a source file of an entry.

        Args:
            entry: Path, encoding, content as text or None if it is that on disk, and digest.
            digests: Digests of the files on which the report depends, by path.

        Raises:
            OSError: It cannot be read.
            ValueError: It has changed, or the entry is damaged.
        """
        path, encoding, content, digest = entry
        if content is not None:
            return read_file(path, encoding, convert_to_bytes(content))
        if digests.get(os.path.join(os.getcwd(), path)) != digest:
            raise ValueError(path)
        data = read_regular_file(path, _LARGEST_SOURCE)
        if sha256(data).hexdigest() != digest:
            raise ValueError(path)
        return read_file(path, encoding, data)

    def _get_rows(self, read: Dependencies) -> list[Row] | None:
        """Return the queries with their answers; None if a stamp has changed since the query."""
        rows: list[Row] = []
        for question, stamp in read.stamps.items():
            if question not in self._answers:
                answer = compute_answer(question)
                self._answers[question] = answer, read_stamp(question)
            answer, now = self._answers[question]
            if now != stamp and answer != "folder":
                return None
            rows.append((*question, answer, now if is_settled(now) and now else None))
        return rows

    def _set(self, read: Dependencies) -> str | None:
        """Store the queries of a shared result; return their digest, None if a stamp changed."""
        if read not in self._sets:
            rows = self._get_rows(read)
            if rows is None:
                return None
            self._sets[read] = sha256(json.dumps(rows).encode()).hexdigest()
            self._store(self._sets[read], {"rows": rows})
        return self._sets[read]

    def _holds(self, row: Row) -> bool:
        """Tell whether a query still has the same answer."""
        kind, path, answer, stamp = row
        if kind == _SHARED:
            return self._set_holds(path)
        question = kind, path
        if question not in self._stamps:
            self._stamps[question] = read_stamp(question)
        now = self._stamps[question]
        known = has_stamp(question) and (now is None) == (answer == ABSENT)
        if known and (now is None or now == stamp):
            return True
        if question not in self._answers:
            self._answers[question] = compute_answer(question), now
        return self._answers[question][0] == answer

    def _set_holds(self, digest: str) -> bool:
        if digest not in self._valid:
            self._valid[digest] = False  # an entry that contains itself does not hold
            table = self._load(digest)
            rows = None if table is None else [_read_row(row) for row in table["rows"]]
            self._valid[digest] = rows is not None and all(self._holds(row) for row in rows)
        return self._valid[digest]

    def trim(self) -> None:
        """Remove entries that were not used for 30 days, and the oldest above 200 MiB."""
        self.store.trim(days=_DAYS, most=_MOST)


def _read_row(row: Any) -> Row:
    """Return a query of an entry.

    Raises:
        ValueError: It is damaged.
        TypeError: It is damaged.
    """
    kind, path, answer, stamp = row
    if not (kind == _SHARED or kind in KINDS) or type(path) is not str or type(answer) is not str:
        raise ValueError(row)
    return kind, path, answer, None if stamp is None else tuple(stamp)


def _list_digests(rows: Iterable[Row]) -> dict[str, str]:
    """Return the digests of the files of queries, by path."""
    return {path: answer for kind, path, answer, _ in rows if kind == "file"}


def _write_file(file: SourceFile, digests: Mapping[str, str]) -> list[Any]:
    """Return a source file as path, encoding, content if it is not that on disk, and digest."""
    digest = sha256(file.data).hexdigest()
    is_on_disk = digests.get(os.path.join(os.getcwd(), file.path)) == digest
    return [file.path, file.encoding, None if is_on_disk else convert_to_text(file.data), digest]


def _hash_code() -> str:
    """Return a digest of the code that runs: files of urdftool, Python, installed libraries."""
    root = Path(__file__).parents[1]
    facts = [
        *(__version__, sys.version),
        # an installer that changes an installation also changes the folder of libraries
        [] if root.parent.name in _OF_LIBRARIES else _list_code(str(root)),
        list(_list_library_folders(sys.path)),
    ]
    return sha256(repr(facts).encode("utf-8", "surrogateescape")).hexdigest()


def _list_code(root: str) -> list[tuple[str, int, int]]:
    """Return the files of code below a folder with their sizes [bytes] and times [ns], sorted."""
    folders = [root]
    files: list[tuple[str, int, int]] = []
    for folder in folders:
        with os.scandir(folder) as entries:
            for entry in entries:
                if entry.name.endswith((".py", ".html")):
                    status = entry.stat()
                    files.append((entry.path, status.st_size, status.st_mtime_ns))
                elif "." not in entry.name and entry.name != "__pycache__" and entry.is_dir():
                    folders.append(entry.path)
    return sorted(files)


_OF_LIBRARIES = ("site-packages", "dist-packages")
"""Names of the folders into which libraries are installed."""


def _list_library_folders(path: Iterable[str]) -> Iterable[tuple[str, int]]:
    """Yield the library folders with their modification times [ns]."""
    for folder in path:
        if os.path.basename(folder) in _OF_LIBRARIES:
            try:
                yield folder, os.stat(folder).st_mtime_ns
            except OSError:
                continue
