"""Present answers to recorded queries: whether a result that depends on them is still valid.

A row has a query, its answer, and the stamp that proves it unchanged. A file with an unchanged
stamp is not read again, unless its stamp was too recent to be reliable.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from hashlib import sha256
from typing import Any

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
    resolve_all,
)
from ..storage import DiskCache

_SHARED = "many"
"""Kind of a row that refers to a large set of queries by the digest of its entry."""

Row = tuple[str, str, str, "Stamp | None"]
"""Query, its answer, and the stamp that proves it unchanged; None if it must be repeated."""


class Queries:
    """Answers to queries, each computed at most once.

    Attributes:
        store: Cache on disk, which has the large sets of queries.
    """

    def __init__(self, store: DiskCache) -> None:
        """Set the cache on disk."""
        self.store = store
        self._stamps: dict[Question, Stamp | None] = {}
        self._answers: dict[Question, tuple[str, Stamp | None]] = {}
        self._sets: dict[Dependencies, str] = {}
        self._valid: dict[str, bool] = {}

    def load(self, key: str) -> Any:
        """Return an entry of the cache; None if it is absent.

        Raises:
            ValueError: It is damaged.
        """
        data = self.store.get(key)
        return None if data is None else json.loads(data)

    def save(self, key: str, table: dict[str, Any]) -> None:
        """Store an entry in the cache."""
        self.store.put(key, json.dumps(table, separators=(",", ":")).encode())

    def make_rows(self, read: Dependencies) -> list[Row] | None:
        """Return the queries with their answers; None if a stamp has changed since the query."""
        rows = self._make_own_rows(read)
        if rows is None:
            return None
        for shared in read.shared:
            digest = self._save_set(shared)
            if digest is None:
                return None
            rows.append((_SHARED, digest, "", None))
        return rows

    def has_answers(self, rows: Sequence[Row]) -> bool:
        """Tell whether all queries still have the same answers."""
        self._resolve(rows)
        return all(self._has_answer(row) for row in rows)

    def _make_own_rows(self, read: Dependencies) -> list[Row] | None:
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

    def _save_set(self, read: Dependencies) -> str | None:
        """Store the queries of a shared result; return their digest, None if a stamp changed."""
        if read not in self._sets:
            rows = self._make_own_rows(read)
            if rows is None:
                return None
            self._sets[read] = sha256(json.dumps(rows).encode()).hexdigest()
            self.save(self._sets[read], {"rows": rows})
        return self._sets[read]

    def _resolve(self, rows: Iterable[Row]) -> None:
        """Resolve the links of all paths of rows together, which is faster."""
        paths = [path for kind, path, _, _ in rows if kind == "real"]
        new = (path for path in paths if ("real", path) not in self._answers)
        for path, real in resolve_all(new).items():
            self._answers["real", path] = real, None

    def _has_answer(self, row: Row) -> bool:
        kind, path, answer, stamp = row
        if kind == _SHARED:
            return self._has_set(path)
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

    def _has_set(self, digest: str) -> bool:
        if digest not in self._valid:
            self._valid[digest] = False  # an entry that contains itself is not valid
            table = self.load(digest)
            self._valid[digest] = table is not None and self.has_answers(read_rows(table))
        return self._valid[digest]


def read_rows(table: Any) -> list[Row]:
    """Return the queries of an entry.

    Raises:
        ValueError: It is damaged.
        TypeError: It is damaged.
        KeyError: It is damaged.
    """
    return [_read_row(row) for row in table["rows"]]


def _read_row(row: Any) -> Row:
    kind, path, answer, stamp = row
    if not (kind == _SHARED or kind in KINDS) or type(path) is not str or type(answer) is not str:
        raise ValueError(row)
    return kind, path, answer, None if stamp is None else tuple(stamp)
