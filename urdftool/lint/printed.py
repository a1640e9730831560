"""What runs of ``lint`` printed, in the cache: a run of which nothing changed is printed again.

The entry of a run has the rows of all its reports, and of the queries that the run made itself. A
run without these rows, such as one with a robot that cannot be read, is not stored.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from hashlib import sha256
from typing import TYPE_CHECKING, Any

from .queries import Queries, read_rows

if TYPE_CHECKING:
    from ..dependencies import Dependencies
    from .outcome import Report

_FORMAT = 1
"""Version of the entries; it is increased when the same key would have another content."""

_CODES = (0, 1, 2)
"""Exit codes of runs without a bug of urdftool."""


class Transcript:
    """Texts that a run prints, and the queries on which they depend.

    Attributes:
        texts: Stream and text of each output, in order: ``stdout``, or a line of ``stderr``.
    """

    def __init__(self) -> None:
        """Create a transcript of a run that has not printed anything."""
        self.texts: list[tuple[str, str]] = []
        self._reports: Sequence[Report] = ()
        self._own: Dependencies | None = None

    def add(self, stream: str, text: str) -> None:
        """Add an output."""
        self.texts.append((stream, text))

    def set_dependencies(self, reports: Sequence[Report], own: Dependencies | None) -> None:
        """Set the reports of the run, and the queries that it made in addition to those of checks.

        Args:
            reports: The reports.
            own: The queries; None if they were not recorded.
        """
        self._reports, self._own = reports, own

    def make_rows(self, queries: Queries) -> list[Any] | None:
        """Return the rows of the run; None if it depends on something that was not recorded."""
        own = None if self._own is None else queries.make_rows(self._own)
        if own is None or not self._reports:
            return None
        rows = dict.fromkeys(own)
        for report in self._reports:
            if report.rows is None:
                return None
            rows.update(dict.fromkeys(report.rows))
        return list(rows)


def get_key(code: str, facts: Iterable[object]) -> str:
    """Return the key of a run: a digest of its inputs that are not files."""
    known = ["printed", _FORMAT, code, os.getcwd(), *facts]
    return sha256(repr(known).encode("utf-8", "surrogateescape")).hexdigest()


def read_printed(
    queries: Queries, key: str, paths: Iterable[str]
) -> tuple[int, list[tuple[str, str]]] | None:
    """Return the exit code and the texts of a run; None if it is absent or not valid any more."""
    try:
        table = queries.load(key)
        if table is None:
            return None
        rows = read_rows(table)
        read = {path for kind, path, _, _ in rows if kind == "file"}
        if not all(os.path.join(os.getcwd(), path) in read for path in paths):
            return None
        if not queries.has_answers(rows):
            return None
        return _read_code(table["code"]), [_read_text(pair) for pair in table["texts"]]
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        return None  # a damaged entry counts as absent


def _read_code(code: Any) -> int:
    if type(code) is not int or code not in _CODES:
        raise ValueError(code)
    return code


def _read_text(pair: Any) -> tuple[str, str]:
    stream, text = pair
    if type(stream) is not str or type(text) is not str:
        raise ValueError(pair)
    if stream == "stdout":
        text.encode("utf-8")
    return stream, text


def write_printed(queries: Queries, key: str, code: int, transcript: Transcript) -> None:
    """Store a run, unless it is incomplete or a file changed during it."""
    if code not in _CODES:
        return
    try:
        rows = transcript.make_rows(queries)
        if rows is not None:
            queries.save(key, {"rows": rows, "code": code, "texts": transcript.texts})
    except (OSError, ValueError):
        return
