"""Cache of reports with their dependencies.

The key of an entry covers the file, the settings, the arguments and the code of urdftool. An entry
is valid while all recorded queries to the file system (:mod:`urdftool.lint.queries`) have the same
answers: a missing mesh that appears counts like a changed one.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from ..dependencies import Dependencies
from ..source.location import SourceFile
from ..storage import DiskCache, read_regular_file
from .installed_code import hash_code
from .outcome import Report
from .queries import Queries, Row, read_rows
from .report_form import convert_to_bytes, convert_to_text, read_file, read_report, write_report

_FORMAT = 5
"""Version of the entries; it is increased when the same key would have another content."""

_DAYS = 30
"""Days after which an unused entry is removed. Chosen, no source."""

_MOST = 200 * 1024 * 1024
"""Size of the cache [bytes] above which its oldest entries are removed. Chosen, no source."""

_LARGEST_SOURCE = 256 * 1024 * 1024
"""Bytes. Chosen, no source."""


class Cache:
    """Reports by key, for one command; each query is made at most once."""

    def __init__(self, store: DiskCache) -> None:
        """Set the cache on disk."""
        self.store = store
        self.queries = Queries(store)
        self._code = hash_code()

    def get_key(self, path: str | Path, facts: list[Any]) -> str:
        """Return the key of a check: a digest of its inputs."""
        known = [_FORMAT, self._code, os.getcwd(), str(path), *facts]
        return sha256(repr(known).encode("utf-8", "surrogateescape")).hexdigest()

    def read(self, key: str) -> Report | None:
        """Return a report that is still valid; None if there is none."""
        try:
            table = self.queries.load(key)
            if table is None:
                return None
            rows = read_rows(table)
            if not self.queries.has_answers(rows):
                return None
            digests = _list_digests(rows)
            files = [self._get_source(file, digests) for file in table["files"]]
            report = read_report(table, files)
        except (OSError, ValueError, TypeError, KeyError, RecursionError):
            return None  # a damaged entry counts as absent
        if os.path.join(os.getcwd(), report.path) not in digests:
            return None
        report.rows = rows
        return report

    def write(self, key: str, report: Report, read: Dependencies) -> None:
        """Store a report, unless it is incomplete or a dependency changed during the check.

        Its rows are set if it is stored.
        """
        if report.error is not None or report.failed_rules:
            return
        try:
            rows = self.queries.make_rows(read)
            if rows is None:
                return
            table, files = write_report(report)
        except (OSError, ValueError):
            return
        digests = _list_digests(rows)
        table["files"] = [_write_file(file, digests) for file in files]
        self.queries.save(key, {"rows": rows, **table})
        report.rows = rows

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

    def trim(self) -> None:
        """Remove entries that were not used for 30 days, and the oldest above 200 MiB."""
        self.store.trim(days=_DAYS, most=_MOST)


def _list_digests(rows: Iterable[Row]) -> dict[str, str]:
    """Return the digests of the files of queries, by path."""
    return {path: answer for kind, path, answer, _ in rows if kind == "file"}


def _write_file(file: SourceFile, digests: Mapping[str, str]) -> list[Any]:
    """Return a source file as path, encoding, content if it is not that on disk, and digest."""
    digest = sha256(file.data).hexdigest()
    is_on_disk = digests.get(os.path.join(os.getcwd(), file.path)) == digest
    return [file.path, file.encoding, None if is_on_disk else convert_to_text(file.data), digest]
